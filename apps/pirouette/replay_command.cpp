#include "replay_command.hpp"

#include <cstdio>
#include <filesystem>

#include "exit_code.hpp"
#include "pirouette/config/toml.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/runtime/recording.hpp"
#include "pirouette/study/configured_trial.hpp"
#include "pirouette/trial/run_folder.hpp"

namespace pirouette::app {
namespace {

namespace fs = std::filesystem;

/// The controller that ran in `folder`.
Result<SpinController> controller_of(const fs::path& folder) {
  const fs::path file = folder / kRunFile;
  ConfigSources sources;
  sources.file = file;
  const Result<Config> config = load_config(sources);
  if (!config) return config.errors();
  const Result<TrialSetup> setup = set_up(config.value());
  if (!setup) return setup.errors();
  Result<SpinController> controller =
      SpinController::create(setup.value().controller, setup.value().plant.robot);
  if (controller) controller.value().follow(setup.value().path);
  return controller;
}

std::string ending(ControllerStatus status) {
  return (is_stood_down(status) ? "stood down: " : "") + std::string(words(status));
}

}  // namespace

ReplayCommand::ReplayCommand(CLI::App& app)
    : command_(app.add_subcommand(
          "replay", "Give a recorded run to the controller again and compare, bit by bit")) {
  command_
      ->add_option("FOLDER", folder_,
                   "Run folder with recording.npy: of a run with --record, or of one that fell")
      ->required();
}

int ReplayCommand::run() const {
  const fs::path folder = folder_;
  const Result<Recording> recording = read_recording(folder);
  if (!recording) return report(recording.errors());
  Result<SpinController> controller = controller_of(folder);
  if (!controller) return report(controller.errors());
  const Result<Replay> result = replay(recording.value(), controller.value());
  if (!result) {
    Errors errors = result.errors();
    for (Error& error : errors) error.file = (folder / error.file).string();
    return report(errors);
  }
  const Replay& replayed = result.value();
  const std::vector<RecordedTick>& ticks = recording.value().ticks;
  if (replayed.difference) {
    const ReplayDifference& d = *replayed.difference;
    std::printf("Replayed %lld ticks, then a difference at tick %lld, %.3f s:\n",
                static_cast<long long>(replayed.ticks), static_cast<long long>(d.tick), d.time);
    std::printf("  %s  recorded %.17g, replayed %.17g\n", d.column.c_str(), d.recorded, d.replayed);
    return kFell;
  }
  std::printf("Replayed %lld ticks", static_cast<long long>(replayed.ticks));
  if (!ticks.empty()) {
    std::printf(" from %.3f to %.3f s: equal bit by bit; at the end %s", ticks.front().time,
                ticks.back().time, ending(replayed.status).c_str());
  }
  std::printf("\n");
  return kDone;
}

}  // namespace pirouette::app
