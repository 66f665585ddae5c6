#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <optional>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/data_folders.hpp"
#include "simulation.hpp"

namespace pirouette::python {
namespace {

using namespace nanobind::literals;

/// Columns of a trace as a dict of numbers and arrays.
template <class Row>
nb::dict columns(const Row& row) {
  nb::dict out;
  Row::columns(row, [&](const char* name, const char*, const char*, const auto& value) {
    out[name] = to_python(value);
  });
  return out;
}

/// Raises an error of `name` unless `value` is within the range of the parameter `key`.
void check_within(const char* name, double value, const char* key, const char* unit = "") {
  const Range range = parameter_range(key).value();
  if (range.min <= value && value <= range.max) return;
  raise({{"", 0, name,
          "given " + toml_literal(value) + "; allowed: " + toml_literal(range.min) + " to " +
              toml_literal(range.max) + unit}});
}

SpinController create_controller(const Config& config) {
  return value_or_raise(SpinController::create(config, value_or_raise(resolve_robot(config))));
}

/// Spline through waypoints, shape (n, 2).
Path path_through(const nb::object& given, bool closed) {
  const auto array = nb::cast<InputArray>(
      nb::module_::import_("numpy").attr("ascontiguousarray")(given, "dtype"_a = "float64"));
  std::vector<Vec2> points;
  if (array.ndim() == 2 && array.shape(1) == 2) {
    for (std::size_t i = 0; i < array.shape(0); ++i) {
      points.emplace_back(array.data()[2 * i], array.data()[2 * i + 1]);
    }
  }
  const std::optional<Path> path = Path::spline(points, closed);
  if (!path) {
    raise({{"", 0, "points",
            "allowed: at least two finite waypoints (three when closed) that do not coincide with "
            "their neighbours, of a path that does not turn back on itself, shape (n, 2)"}});
  }
  return *path;
}

void define_controller(nb::module_& module) {
  nb::class_<SpinController>(
      module, "Controller",
      "The whole controller: sensor readings and a motion command in, joint commands out. One "
      "thread at a time; different controllers may run in different threads.")
      .def(
          "__init__",
          [](SpinController* self, const Config& config) {
            new (self) SpinController(create_controller(config));
          },
          "config"_a)
      .def(
          "reset",
          [](SpinController& self, const nb::object& p_WB, const nb::object& R_WB) {
            using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
            BasePose start;
            start.p_WB = Eigen::Map<const Vec3>(as_array(p_WB, "p_WB", {3}).data());
            start.R_WB = Eigen::Map<const RowMajor>(as_array(R_WB, "R_WB", {3, 3}).data());
            self.reset(start);
          },
          "p_WB"_a, "R_WB"_a,
          "Forgets everything but the path; the estimator starts from the trunk's position (m, "
          "shape (3,)) and rotation to world axes (shape (3, 3)).")
      .def(
          "follow",
          [](SpinController& self, const nb::object& points, bool closed) {
            self.follow(points.is_none() ? std::nullopt
                                         : std::optional(path_through(points, closed)));
          },
          nb::arg("points").none(), "closed"_a = false,
          "From now on commands are followed along the spline through these waypoints (m, shape "
          "(n, 2)), which begins where walking begins. None: no path.")
      .def(
          "tick",
          [](SpinController& self, const SensorReading& sensors, const MotionCommand& command) {
            const nb::gil_scoped_release released;
            return self.tick(sensors, command);
          },
          "sensors"_a, "command"_a,
          "One control period, 1 / control.rate. After a failure that latches, every further "
          "command is the damped stand-down until reset().")
      .def_prop_ro("status", &SpinController::status)
      .def_prop_ro(
          "stood_down", [](const SpinController& self) { return is_stood_down(self.status()); },
          "The controller gave up and only damps the joints, until reset().")
      .def_prop_ro(
          "trace", [](const SpinController& self) { return columns(self.trace()); },
          "What the last tick computed: a dict with the controller's columns of trace.npy.");
}

nb::object heights(const Simulation& self, const nb::object& x, const nb::object& y) {
  const auto numpy = nb::module_::import_("numpy");
  const auto as_list = [&](const nb::object& given) {
    return nb::cast<InputArray>(
        numpy.attr("atleast_1d")(numpy.attr("ascontiguousarray")(given, "dtype"_a = "float64")));
  };
  const InputArray columns = as_list(x), rows = as_list(y);
  std::vector<double> out;
  out.reserve(rows.size() * columns.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t column = 0; column < columns.size(); ++column) {
      out.push_back(self.height(Vec2(columns.data()[column], rows.data()[row])));
    }
  }
  return copied(out.data(), {rows.size(), columns.size()});
}

void define_simulation(nb::module_& module) {
  nb::class_<Simulation>(
      module, "Simulation",
      "The simulated robot and its controller, tick by tick: stands for gait.stand_time, then does "
      "what `command` says. run.turns, run.path and run.point have no say. One thread at a time.")
      .def(
          "__init__",
          [](Simulation* self, const Config& config) {
            new (self) Simulation(value_or_raise(Simulation::create(config)));
          },
          "config"_a)
      .def(
          "reset",
          [](Simulation& self) {
            if (const Errors errors = self.reset(); !errors.empty()) raise(errors);
          },
          "Back to the start; `command` stays.")
      .def(
          "step",
          [](Simulation& self, std::int64_t ticks) {
            if (ticks < 0) {
              raise({{"", 0, "ticks", "given " + std::to_string(ticks) + "; allowed: 0 and more"}});
            }
            const nb::gil_scoped_release released;
            self.step(ticks);
          },
          "ticks"_a = 1, "Simulates this many control periods, 1 / control.rate each.")
      .def(
          "push",
          [](Simulation& self, const nb::object& dv_W) {
            const Vec3 change = Eigen::Map<const Vec3>(as_array(dv_W, "dv_W", {3}).data());
            check_within("dv_W", change.norm(), "plant.faults.push_speed", " m/s, its length");
            self.plant().push(change);
          },
          "dv_W"_a,
          "Adds to the trunk's velocity at once: m/s, shape (3,), world axes. Raises Error unless "
          "its length is within the range of plant.faults.push_speed.")
      .def(
          "set_friction",
          [](Simulation& self, double friction) {
            check_within("friction", friction, "plant.friction");
            self.plant().set_friction(friction);
          },
          "friction"_a,
          "Sliding friction of feet and ground from now on, where the terrain has none of its own; "
          "reset() returns to plant.friction. Raises Error outside that parameter's range.")
      .def("ground", &heights, "x"_a, "y"_a,
           nb::sig("def ground(self, x: object, y: object) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Heights of the ground, m, shape (len(y), len(x)), at the world's x and y (m).")
      .def_rw("command", &Simulation::command, "MotionCommand in force from the next tick on")
      .def_prop_ro("time", &Simulation::time, "s, simulated since the start")
      .def_prop_ro("status", [](const Simulation& self) { return self.controller().status(); })
      .def_prop_ro(
          "stood_down",
          [](const Simulation& self) { return is_stood_down(self.controller().status()); },
          "The controller gave up and only damps the joints, until reset().")
      .def_prop_ro(
          "state", [](const Simulation& self) { return columns(self.row()); },
          "The present moment: a dict with the columns of trace.npy.");
}

}  // namespace

void define_loops(nb::module_& module) {
  define_controller(module);
  define_simulation(module);
}

}  // namespace pirouette::python
