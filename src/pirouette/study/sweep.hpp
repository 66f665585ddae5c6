// Parallel run of the trials of an experiment. Finished trials are kept when it is interrupted.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/metrics/metric_values.hpp"
#include "pirouette/study/experiment_file.hpp"
#include "pirouette/study/results_log.hpp"

namespace pirouette {

/// Folder of the traces in that of the sweep.
inline constexpr const char* kTracesFolder = "traces";

/// 16 hexadecimal digits that identify the trial: hash of its configuration, the files of robot and
/// path, and the versions of this program and of the physics.
std::string trial_key(const Config& config);

/// Progress of a sweep.
struct SweepProgress {
  std::size_t done = 0;       ///< finished trials, including those of earlier sweeps
  std::size_t resumed = 0;    ///< finished in earlier sweeps
  std::size_t total = 0;      ///< different trials of the experiment, or of the shard
  double seconds_left = 0.0;  ///< s, wall clock; 0 until the first trial of this sweep is done
};

/// How to run a sweep.
struct SweepOptions {
  unsigned jobs = 0;  ///< threads; 0: one for each hardware thread
  /// Folder of the results and of kTracesFolder; experiments in one folder share their trials.
  std::filesystem::path folder;
  std::optional<Shard> shard;                          ///< absent: all trials
  bool fresh = false;                                  ///< delete earlier results; not for a shard
  std::function<void(const SweepProgress&)> progress;  ///< one call at a time; may be empty
  std::function<bool()> stop;  ///< called from all threads; true ends the sweep; may be empty
};

/// Results of the trials of an experiment.
struct SweepResult {
  std::vector<std::string> keys;     ///< trial_key() of each trial, in the experiment's order
  std::vector<MetricValues> values;  ///< of each trial; empty maps for trials without a result
  bool interrupted = false;          ///< some trials have not run
};

/// Errors with which run_sweep() would not start: a robot's file, a terrain, an unknown metric.
/// Empty: none.
Errors check_sweep(const Experiment& experiment);

/// Runs the trials without a result in the folder, appending each trial as it finishes. The result
/// does not depend on `jobs`, nor on how often the sweep was interrupted, nor on how it was
/// sharded.
Result<SweepResult> run_sweep(const Experiment& experiment, const SweepOptions& options);

/// Number of trials of the experiment, and of those with a result in `folder`.
SweepProgress survey_sweep(const Experiment& experiment, const std::filesystem::path& folder);

/// The results in `folder`, without running anything. The error when trials are missing says how
/// many, and of which shards.
Result<SweepResult> merge_sweep(const Experiment& experiment, const std::filesystem::path& folder);

/// Path of the trace of a trial with keep_trace.
std::filesystem::path trace_path(const std::filesystem::path& folder, const std::string& key);

/// Replaces the content of `path` by `text` at once: a reader sees the old or the new text. Returns
/// the error when it cannot be written; absent: done.
std::optional<Error> write_atomically(const std::filesystem::path& path, const std::string& text);

}  // namespace pirouette
