#include "run_command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "exit_code.hpp"
#include "interrupt.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/runtime/recording.hpp"
#include "pirouette/study/configured_trial.hpp"
#include "pirouette/study/robot_check.hpp"
#include "pirouette/trial/run_folder.hpp"
#include "progress_line.hpp"
#include "realtime.hpp"
#include "summary.hpp"

namespace pirouette::app {
namespace {

constexpr double kLeastAngleError = 1.0;  // deg, that is allowed of any angle
constexpr double kPercent = 100.0;
constexpr double kMillimetres = 1e3;  // in a metre

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

/// The resolved configuration with a head that says where it comes from.
std::string run_toml(const Config& config, const RunContext& context,
                     const std::string& command_line) {
  return "# pirouette " + context.version + ", commit " + context.commit + ", MuJoCo " +
         context.mujoco + "\n# " + command_line + "\n\n" + dump_toml(config);
}

std::optional<Error> save(RunFolder& folder, NpyRowsFile& trace, const Config& config,
                          const Metrics& metrics, const std::string& command_line) {
  if (auto error = trace.finish()) return error;
  if (auto error = folder.write(kRunFile, run_toml(config, metrics.context, command_line))) {
    return error;
  }
  if (auto error = folder.write(kMetricsFile, to_json(metrics))) return error;
  const Result<std::string> robot = read_robot_mjcf(config.robot);
  if (!robot) return robot.errors().front();
  if (auto error = folder.write(kRobotFile, robot.value())) return error;
  if (auto error =
          write_terrain(folder, config.plant.terrain, static_cast<std::uint64_t>(config.run.seed)))
    return error;
  return folder.commit();
}

/// As short as it can be typed: relative when below the working folder.
std::string shown_path(const std::filesystem::path& path) {
  const std::string relative = path.lexically_proximate(std::filesystem::current_path()).string();
  return relative.starts_with("..") ? path.string() : relative;
}

double share_done(const TrialProgress& p) { return p.duration > 0.0 ? p.time / p.duration : 1.0; }

/// `about_a_point`: the distance to the point means something.
std::string progress_text(const TrialProgress& p, bool about_a_point) {
  char text[128];
  std::snprintf(text, sizeof text, "%3d %%  %5.1f s  %5.1f x real time  %6.2f turns",
                static_cast<int>(kPercent * share_done(p)), p.time, p.real_time_factor, p.turns);
  std::string line = text;
  if (about_a_point) {
    std::snprintf(text, sizeof text, "  %5.1f mm off", p.distance_to_point * kMillimetres);
    line += text;
  }
  return line;
}

Result<TrialResult> simulate(const Config& config, TrialOptions options, bool show_progress) {
  const bool about_a_point = config.run.path.empty() && config.run.velocity == std::array{0.0, 0.0};
  std::optional<ProgressLine> line;
  if (show_progress) line.emplace();
  options.progress = [&](const TrialProgress& progress) {
    if (line) line->update(share_done(progress), progress_text(progress, about_a_point));
    return interrupt_signal() == 0;
  };
  return run_trial(config, options);
}

/// Bytes that the run folder is going to take, about.
std::uintmax_t expected_size(const Config& config, bool records_whole_run) {
  const Result<TrialSetup> setup = set_up(config);
  if (!setup) return 0;  // told when it starts
  std::vector<char> trace_row, recorded_row;
  const TickTrace tick;
  const PlantTruth truth;
  append_row(trace_row, TraceRow{tick, truth});
  append_row(recorded_row, RecordedTick{});
  constexpr double kTerrainPoints = 2.0 * kTerrainHalfExtent / kTerrainPitch + 1.0;
  double bytes = sizeof(float) * kTerrainPoints * kTerrainPoints;
  bytes += expected_duration(setup.value()) * config.run.trace_rate *
           static_cast<double>(trace_row.size());
  const double recorded_time =
      records_whole_run ? expected_duration(setup.value()) : 2.0 * FlightRecorder::kKept;
  bytes += recorded_time * config.control.rate * static_cast<double>(recorded_row.size());
  return static_cast<std::uintmax_t>(bytes);
}

/// One line on stderr when what was asked for was not done, and the exit code.
int verdict(const Config& config, const TrialResult& trial, const std::string& folder) {
  const Metrics& m = trial.metrics;
  if (m.interrupted) {
    std::cerr << "interrupted: what was measured until then is in " << folder << "\n";
    return kSignal + interrupt_signal();
  }
  if (m.fell) {
    if (!trial.stood_down.empty()) {
      std::cerr << "the controller stood down: " << trial.stood_down << "\n";
    }
    std::cerr << "the robot fell: what went in and out before is in " << folder << "/"
              << kRecordingFile << "; pirouette replay " << folder << "\n";
    return kFell;
  }
  if (m.angle_error_deg) {
    const double allowed =
        std::max(kLeastAngleError, (1.0 - kDoneShare) * std::abs(config.run.angle_deg));
    if (std::abs(*m.angle_error_deg) <= allowed && trial.completed) return kDone;
    std::cerr << "not done: " << short_number(*m.angle_error_deg) << " deg off "
              << short_number(config.run.angle_deg) << " deg"
              << (trial.completed ? "" : " when the time limit (run.time_limit) came")
              << "; allowed: " << short_number(allowed) << " deg\n";
    return kNotDone;
  }
  if (trial.completed) return kDone;
  std::cerr << "not done: " << short_number(kPercent * m.done.value_or(0.0)) << " % of the "
            << (!config.run.path.empty() ? "laps"
                : config.run.rate != 0.0 ? "turns"
                                         : "distance")
            << " when the time limit (run.time_limit) came\n";
  return kNotDone;
}

}  // namespace

RunCommand::RunCommand(CLI::App& app, Kind kind, std::string command_line)
    : kind_(kind), command_line_(std::move(command_line)) {
  command_ =
      kind == Kind::kSpin
          ? app.add_subcommand("spin", "Simulate a spin on the spot and measure it")
          : app.add_subcommand("turn", "Simulate a turn of any radius, or a path, and measure it");
  config_options_.add_run(*command_);
  if (kind == Kind::kTurn) config_options_.add_turn(*command_);
  config_options_.add_common(*command_);
  command_->add_option("--out", out_, "Run folder, new or empty [the next free one in runs/]")
      ->type_name("DIR");
  command_->add_flag("--force", force_, "Replace the files of an earlier run in the run folder");
  command_->add_flag("--json", json_, "Print metrics.json instead of the table");
  command_->add_flag("--record", record_,
                     "Record every tick's readings and commands; without it only the last 10 s "
                     "before a fall");
  command_->add_flag("--realtime", realtime_,
                     "Run against the wall clock, under SCHED_FIFO with locked memory where that "
                     "is permitted, and tell how many deadlines were missed");
  command_->add_flag("--quiet", quiet_, "Print no progress and no table");
}

std::string RunCommand::default_folder(const Config& config) const {
  const Config standard;
  std::string name = kind_ == Kind::kSpin ? "spin" : "turn";
  if (config.robot != standard.robot) {
    name += "-" + std::filesystem::path(config.robot).stem().string();
  }
  if (config.controller != standard.controller) name += "-" + config.controller;
  name += "-" + config.plant.terrain + "-";
  name += config.run.path.empty() ? short_number(config.run.rate)
                                  : std::filesystem::path(config.run.path).stem().string();
  if (config.run.angle_deg != 0.0) name += "-angle" + short_number(config.run.angle_deg);
  if (config.run.path.empty() && config.run.velocity != standard.run.velocity) {
    name += "-" + short_number(config.run.velocity[0]) + "," + short_number(config.run.velocity[1]);
  }
  name += "-seed" + std::to_string(config.run.seed);
  std::erase(name, ':');
  std::replace(name.begin(), name.end(), '/', '_');
  return "runs/" + name;
}

Result<RunFolder> RunCommand::open_folder(const Config& config) const {
  const RunFolderOptions options{force_, expected_size(config, record_)};
  Result<RunFolder> folder = out_     ? RunFolder::open(*out_, options)
                             : force_ ? RunFolder::open(default_folder(config), options)
                                      : RunFolder::open_next(default_folder(config), options);
  if (folder) return folder;
  Errors errors = folder.errors();
  for (Error& error : errors) error = {"--out", 0, "", error.to_string()};
  return errors;
}

int RunCommand::run() const {
  const Result<Config> loaded = config_options_.load();
  if (!loaded) return report(loaded.errors());
  const Config& config = loaded.value();
  if (const Errors errors = check_trial(config); !errors.empty()) {
    return report(config_options_.in_typed_words(errors));
  }

  for (const std::string& text : robot_assumptions(config)) std::cerr << "note: " << text << "\n";

  watch_interrupts();
  Result<RunFolder> folder = open_folder(config);
  if (!folder) return report(folder.errors());
  Result<NpyRowsFile> trace = create_trace_file(folder.value().file(kTraceFile));
  if (!trace) return report(trace.errors());

  RealTimePacer pacer(1.0 / config.control.rate);
  const std::vector<std::string> refused =
      realtime_ ? request_real_time() : std::vector<std::string>{};
  TrialOptions options;
  options.trace = &trace.value();
  options.pacer = realtime_ ? &pacer : nullptr;
  options.recording_folder = folder.value().file("");
  options.records_whole_run = record_;
  const Result<TrialResult> trial = simulate(config, options, !quiet_);
  if (!trial) return report(config_options_.in_typed_words(trial.errors()));
  if (realtime_) std::cerr << pacer.summary(refused) << "\n";
  const Metrics& metrics = trial.value().metrics;
  if (const auto error = save(folder.value(), trace.value(), config, metrics, command_line_)) {
    return report({*error});
  }
  const std::string place = shown_path(folder.value().path());
  if (json_) {
    std::cout << to_json(metrics);
  } else if (!quiet_) {
    std::cout << summary(metrics) << "\nRun folder: " << place << "\n";
  }
  return verdict(config, trial.value(), place);
}

}  // namespace pirouette::app
