// One simulated run: plant and controller in a closed loop, watched by the truth.
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

/// Everything that a trial needs, from wherever it comes. study/configured_trial.hpp makes one of a
/// Config.
struct TrialSetup {
  ControllerConfig controller;
  WorldConfig world;
  PlantSetup plant;
  TrialConfig trial;
  MotionCommand motion;      ///< in force after gait.stand_time
  std::optional<Path> path;  ///< to walk along, in a frame of its own
  /// What metrics.json says about the run; point and duration are added by the trial.
  RunContext context;
};

/// How far a running trial is.
struct TrialProgress {
  double time = 0.0;               ///< s, simulated
  double duration = 0.0;           ///< s, to be simulated
  double real_time_factor = 0.0;   ///< simulated over wall-clock time so far
  double turns = 0.0;              ///< true turns since the command, positive in its direction
  double distance_to_point = 0.0;  ///< m, of the CoM now, horizontal
};

struct TrialOptions {
  Pacer* pacer = nullptr;  ///< nullptr: as fast as it can
  /// Called about every 0.1 s of simulated time; false ends the trial. May be empty.
  std::function<bool(const TrialProgress&)> progress;
  /// Takes run.trace_rate rows a second; nullptr: no trace. The caller finishes it.
  NpyRowsFile* trace = nullptr;
  /// Folder for recording.npy and recording.start (runtime/recording.hpp); empty: none.
  std::filesystem::path recording_folder;
  /// False: only the last FlightRecorder::kKept seconds, and only when the robot falls or the
  /// controller stands down.
  bool records_whole_run = false;
};

struct TrialResult {
  Metrics metrics;
  bool interrupted = false;  ///< progress returned false; metrics are of the part until then
  bool recorded = false;     ///< a recording was written
  std::string stood_down;    ///< why the controller gave up, in words; empty: it did not
  /// What was commanded was done before run.time_limit, by kDoneShare of it at least.
  bool completed = false;
};

/// What would keep run_trial() from starting: the robot's file, its leg names, the terrain, a
/// length of more than 10^6 s.
Errors check_trial(const TrialSetup& setup);

/// s, simulated, from standing to the end when all goes well.
double expected_duration(const TrialSetup& setup);

/// Share of what was commanded that counts as done.
inline constexpr double kDoneShare = 0.98;

/// Stands for gait.stand_time, then commands the motion; records after settle_time for as long as
/// the turns take at the commanded rate (without one 10 s each), or the laps of a path, which is
/// walked once when open; longer, until kDoneShare of them are done, but no longer than
/// run.time_limit. With run.angle_deg it turns by that angle, stands and records it all.
/// Interrupted, it returns what was measured until then. Ends early when the robot falls: the trunk
/// leans more than 1 rad from the terrain's normal, the CoM is lower than 0.1 m (small robots: 0.4
/// of its height when standing) above ground, the truth is not finite, or the controller has stood
/// down for 1 s. The same setup gives the same rows bit for bit.
Result<TrialResult> run_trial(const TrialSetup& setup, const TrialOptions& options = {});

}  // namespace pirouette
