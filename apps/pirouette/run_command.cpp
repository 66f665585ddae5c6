#include "run_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "exit_code.hpp"
#include "interrupt.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/runtime/recording.hpp"
#include "pirouette/study/configured_trial.hpp"
#include "pirouette/trial/run_folder.hpp"
#include "progress_bar.hpp"
#include "realtime.hpp"
#include "summary.hpp"

namespace pirouette::app {
namespace {

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

Result<TrialResult> simulate(const Config& config, TrialOptions options, bool show_progress) {
  const bool about_a_point = config.run.path.empty() && config.run.velocity == std::array{0.0, 0.0};
  std::optional<ProgressBar> bar;
  if (show_progress) bar.emplace(about_a_point);
  options.progress = [&](const TrialProgress& progress) {
    if (bar) bar->update(progress);
    return interrupt_signal() == 0;
  };
  return run_trial(config, options);
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
  command_->add_option("--out", out_, "Run folder; an earlier run there is replaced [runs/...]")
      ->type_name("DIR");
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
  name += "-seed" + std::to_string(config.run.seed);
  std::erase(name, ':');
  std::replace(name.begin(), name.end(), '/', '_');
  return "runs/" + name;
}

int RunCommand::run() const {
  const Result<Config> loaded = config_options_.load();
  if (!loaded) return report(loaded.errors());
  const Config& config = loaded.value();

  Result<RunFolder> folder = RunFolder::open(out_.value_or(default_folder(config)));
  if (!folder) {
    Errors errors = folder.errors();
    for (Error& error : errors) error = {"--out", 0, "", error.to_string()};
    return report(errors);
  }
  Result<NpyRowsFile> trace = create_trace_file(folder.value().file(kTraceFile));
  if (!trace) return report(trace.errors());

  watch_interrupts();
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
  if (trial.value().interrupted) {
    std::cerr << "interrupted: no run folder was written\n";
    return kSignal + interrupt_signal();
  }
  if (realtime_) std::cerr << pacer.summary(refused) << "\n";
  const Metrics& metrics = trial.value().metrics;
  if (const auto error = save(folder.value(), trace.value(), config, metrics, command_line_)) {
    return report({*error});
  }
  if (json_) {
    std::cout << to_json(metrics);
  } else if (!quiet_) {
    std::cout << summary(metrics) << "\nRun folder: " << shown_path(folder.value().path()) << "\n";
  }
  if (!metrics.fell) return kDone;
  std::cerr << "the robot fell: what went in and out before is in "
            << shown_path(folder.value().path() / kRecordingFile) << "; pirouette replay "
            << shown_path(folder.value().path()) << "\n";
  return kFell;
}

}  // namespace pirouette::app
