// The compiled part of the Python package. python/pirouette/api.py is what users see of it.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "pirouette/base/version.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/toml.hpp"
#include "pirouette/metrics/motion_metrics.hpp"
#include "pirouette/study/configured_trial.hpp"
#include "pirouette/study/robot_check.hpp"

namespace pirouette::python {

using namespace nanobind::literals;

void raise(const Errors& errors) {
  std::string text;
  for (Error error : errors) {
    if (error.file.starts_with("--")) error.file.clear();  // options of the program
    text += (text.empty() ? "" : "\n") + error.to_string();
  }
  const nb::object type = nb::module_::import_("pirouette.errors").attr("Error");
  PyErr_SetString(type.ptr(), text.c_str());
  throw nb::python_error();
}

InputArray as_array(nb::handle given, const char* name, std::initializer_list<std::size_t> shape) {
  const nb::object array =
      nb::module_::import_("numpy").attr("ascontiguousarray")(given, "dtype"_a = "float64");
  nb::list wanted;
  for (const std::size_t n : shape) wanted.append(n);
  const nb::object allowed = nb::tuple(wanted);
  const nb::object actual = array.attr("shape");
  if (!actual.equal(allowed)) {
    raise({{"", 0, name,
            std::string("given shape ") + nb::str(actual).c_str() +
                "; allowed: " + nb::str(allowed).c_str()}});
  }
  return nb::cast<InputArray>(array);
}

namespace {

Config load(const std::optional<std::string>& robot, const std::optional<std::string>& controller,
            const std::optional<std::string>& profile, const std::optional<std::string>& file,
            const std::vector<std::string>& overrides) {
  ConfigSources sources{robot, controller, profile, std::nullopt, overrides};
  if (file) sources.file = *file;
  return value_or_raise(load_config(sources));
}

/// Runs a trial with the interpreter unlocked; its trace goes to the file `trace`. The text of
/// metrics.json. Ctrl-C ends it.
std::string run(const Config& config, const std::string& trace) {
  NpyRowsFile file = value_or_raise(create_trace_file(trace));
  TrialOptions options;
  options.trace = &file;
  options.progress = [](const TrialProgress&) {
    const nb::gil_scoped_acquire held;
    return PyErr_CheckSignals() == 0;
  };
  const Result<TrialResult> trial = [&] {
    const nb::gil_scoped_release released;
    return run_trial(config, options);
  }();
  if (!trial) raise(trial.errors());
  if (trial.value().interrupted) throw nb::python_error();
  if (const auto error = file.finish()) raise({*error});
  return to_json(trial.value().metrics);
}

/// The text of metrics.json of somebody else's run, sampled at `rate` (Hz).
std::string metrics(double rate, const nb::object& time, const nb::object& com,
                    const nb::object& com_velocity, const nb::object& yaw, const nb::object& roll,
                    const nb::object& pitch, const nb::object& point, const nb::object& velocity,
                    double yaw_rate) {
  const std::size_t n = nb::len(time);
  const auto list = [n](const nb::object& given, const char* name) {
    return given.is_none() ? std::optional<InputArray>{} : as_array(given, name, {n});
  };
  const InputArray times = as_array(time, "time", {n}), yaws = as_array(yaw, "yaw", {n});
  const InputArray places = as_array(com, "com", {n, 2});
  const InputArray velocities = as_array(com_velocity, "com_velocity", {n, 2});
  const std::optional<InputArray> rolls = list(roll, "roll"), pitches = list(pitch, "pitch");
  CommandedMotion commanded;
  commanded.point = Eigen::Map<const Vec2>(as_array(point, "point", {2}).data());
  commanded.v_H = Eigen::Map<const Vec2>(as_array(velocity, "velocity", {2}).data());
  commanded.yaw_rate = yaw_rate;
  MotionMetrics metrics(commanded, rate);
  for (std::size_t i = 0; i < n; ++i) {
    MotionSample sample;
    sample.time = times.data()[i];
    sample.p_WG = Eigen::Map<const Vec2>(places.data() + 2 * i);
    sample.v_WG_W = Eigen::Map<const Vec2>(velocities.data() + 2 * i);
    sample.yaw = yaws.data()[i];
    if (rolls) sample.roll = rolls->data()[i];
    if (pitches) sample.pitch = pitches->data()[i];
    metrics.add(sample);
  }
  return to_json(metrics.result());
}

}  // namespace
}  // namespace pirouette::python

NB_MODULE(_core, module) {
  using namespace nanobind::literals;
  using namespace pirouette;
  namespace nb = nanobind;

  module.doc() = "The compiled part of pirouette; import pirouette instead.";
  module.attr("__version__") = version();
  nb::class_<Config>(module, "Config", "A checked configuration: every parameter has its value.")
      .def_prop_ro("toml", &dump_toml, "The whole of it as TOML; loading it gives the same.");
  module.def("load_config", &python::load, nb::arg("robot").none() = nb::none(),
             nb::arg("controller").none() = nb::none(), nb::arg("profile").none() = nb::none(),
             nb::arg("file").none() = nb::none(), "overrides"_a = std::vector<std::string>{},
             "Defaults, robot, controller and plant profile, a TOML file, and key=value overrides, "
             "each above those before it.");
  module.def(
      "parameter_range",
      [](const std::string& key) -> std::optional<std::pair<double, double>> {
        const std::optional<Range> range = parameter_range(key);
        if (!range) return std::nullopt;
        return std::pair{range->min, range->max};
      },
      "key"_a, "Smallest and largest value of a numeric parameter; None for any other key.");
  module.def("known_robots", &known_robots, "Names of the robots in the box.");
  module.def(
      "robot_check",
      [](const std::string& robot) {
        return robot_check_json(python::value_or_raise(check_robot(robot)));
      },
      "robot"_a, "What was found of a robot, as JSON.");
  module.def(
      "robot_mjcf",
      [](const std::string& robot) { return python::value_or_raise(read_robot_mjcf(robot)); },
      "robot"_a, "The robot as it was read, as the text of an MJCF file.");
  module.def("known_controllers", &known_controllers, "Names of the controller bundles.");
  module.def("run_trial", &python::run, "config"_a, "trace"_a,
             "Simulates one run; writes the trace to a file, returns metrics.json.");
  module.def("metrics", &python::metrics, "rate"_a, "time"_a, "com"_a, "com_velocity"_a, "yaw"_a,
             nb::arg("roll").none(), nb::arg("pitch").none(), "point"_a, "velocity"_a, "yaw_rate"_a,
             "metrics.json of a motion that was recorded elsewhere.");
  python::define_values(module);
  python::define_loops(module);
}
