// One simulated run: plant and controller in a closed loop, watched by the truth.
#pragma once

#include <cstdint>
#include <functional>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/metrics/metrics.hpp"
#include "pirouette/trial/trace_file.hpp"

namespace pirouette {

/// How far a running trial is.
struct TrialProgress {
  double time = 0.0;               ///< s, simulated
  double duration = 0.0;           ///< s, to be simulated
  double real_time_factor = 0.0;   ///< simulated over wall-clock time so far
  double turns = 0.0;              ///< true turns since the command, positive in its direction
  double distance_to_point = 0.0;  ///< m, of the CoM now, horizontal
};

struct TrialOptions {
  /// Called with the number of each control tick before it; may wait. May be empty.
  std::function<void(std::int64_t)> before_tick;
  /// Called about every 0.1 s of simulated time; false ends the trial. May be empty.
  std::function<bool(const TrialProgress&)> progress;
  /// Takes run.trace_rate rows a second; nullptr: no trace. The caller finishes it.
  TraceFile* trace = nullptr;
};

struct TrialResult {
  Metrics metrics;
  bool interrupted = false;  ///< progress returned false
};

/// Version of this library and the commit it was built from; "unknown" outside a git checkout.
const char* version();
const char* commit();

/// What would keep run_trial() from starting: the robot's file, its leg names, the terrain, the
/// path, a length of more than 10^6 s.
Errors check_trial(const Config& config);

/// Stands for gait.stand_time, then commands run.velocity and run.rate, or run.path; records after
/// run.settle_time until run.turns are due; without a yaw rate each turn counts 10 s, and run.path
/// is walked run.laps times, once when open. Ends early when the robot falls: the trunk leans more
/// than 1 rad from the terrain's normal, the CoM is lower than 0.1 m (small robots: 0.4
/// body.height) above ground, the truth is not finite, or the controller has stood down for 1 s.
/// The same config gives the same rows bit for bit.
Result<TrialResult> run_trial(const Config& config, const TrialOptions& options = {});

}  // namespace pirouette
