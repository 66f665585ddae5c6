// One simulated run: plant and controller in a closed loop, judged by the true state.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/controller/controller_config.hpp"
#include "pirouette/metrics/metrics.hpp"
#include "pirouette/path/path.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/runtime/control_loop.hpp"
#include "pirouette/trial/trace_file.hpp"
#include "pirouette/trial/trial_config.hpp"
#include "pirouette/types/motion_command.hpp"

namespace pirouette {

/// Everything that a trial needs. study/configured_trial.hpp makes it from a Config.
struct TrialSetup {
  ControllerConfig controller;  ///< parameters of the controller
  WorldConfig world;            ///< parameters of the world
  PlantSetup plant;             ///< robot, seed and start of the plant
  TrialConfig trial;            ///< parameters of the trial
  MotionCommand motion;         ///< in force after gait.stand_time
  std::optional<Path> path;     ///< to follow, in its own frame
  /// Context in metrics.json; the trial adds point and duration.
  RunContext context;
};

/// Progress of a running trial.
struct TrialProgress {
  double time = 0.0;               ///< s, simulated
  double duration = 0.0;           ///< s, to be simulated
  double real_time_factor = 0.0;   ///< simulated over wall-clock time so far
  double turns = 0.0;              ///< true turns since the command, positive in its direction
  double distance_to_point = 0.0;  ///< m, of the CoM now, horizontal
};

/// Outputs and timing of a trial.
struct TrialOptions {
  Pacer* pacer = nullptr;  ///< nullptr: as fast as it can
  /// Called about every 0.1 s of simulated time; false ends the trial. May be empty.
  std::function<bool(const TrialProgress&)> progress;
  /// Receives run.trace_rate rows per second; nullptr: no trace. The caller calls finish().
  NpyRowsFile* trace = nullptr;
  /// Folder for recording.npy and recording.start (runtime/recording.hpp); empty: none.
  std::filesystem::path recording_folder;
  /// True: records the whole run; false: only the last FlightRecorder::kKept seconds, and only when
  /// the robot falls or the controller stands down.
  bool records_whole_run = false;
};

/// Outcome of a trial.
struct TrialResult {
  Metrics metrics;           ///< of the recorded part
  bool interrupted = false;  ///< progress returned false; metrics are of the part until then
  bool recorded = false;     ///< a recording was written
  std::string stood_down;    ///< why the controller stood down, in words; empty: it did not
  /// At least kDoneShare of the commanded motion was done before run.time_limit.
  bool completed = false;
};

/// Errors with which run_trial() would not start: the robot's file, its leg names, the terrain, a
/// length of more than 10^6 s. Empty: none.
Errors check_trial(const TrialSetup& setup);

/// Simulated time (s) from standing to the end, without a fall or delay.
double expected_duration(const TrialSetup& setup);

/// Share of the commanded motion from which on it is completed.
inline constexpr double kDoneShare = 0.98;

/// Stands for gait.stand_time, then commands the motion; records after settle_time for as long as
/// the turns take at the commanded rate (10 s each without a rate), or the laps of a path, which is
/// followed once when open; longer, until kDoneShare of them are done, but no longer than
/// run.time_limit. With run.angle_deg it turns by that angle, stands and records it all.
/// Interrupted, it returns what was measured until then. Ends early when the robot falls: the trunk
/// leans more than 1 rad from the terrain's normal, the CoM is lower than 0.1 m (small robots: 0.4
/// of its height when standing) above the ground, the true state is not finite, or the controller
/// has stood down for 1 s. The same setup gives the same rows bit for bit. The errors are those of
/// check_trial() and of the output files.
Result<TrialResult> run_trial(const TrialSetup& setup, const TrialOptions& options = {});

}  // namespace pirouette
