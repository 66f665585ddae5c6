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
  unsigned jobs = 0;             ///< threads; 0: one for each hardware thread
  std::filesystem::path folder;  ///< where the results and kTracesFolder are
  /// Names of other experiments whose results may be in `folder`: they then share trials. Results
  /// of any other are refused.
  std::vector<std::string> beside;
  std::optional<Shard> shard;                          ///< absent: all trials
  bool fresh = false;                                  ///< delete earlier results; not for a shard
  std::function<void(const SweepProgress&)> progress;  ///< one call at a time; may be empty
  /// Told once, before anything runs, which lines of results are not used, and why: damaged, edited
  /// or old ones, and, without `beside`, those of no trial of the experiment. May be empty.
  std::function<void(const Errors&)> unused_lines;
  std::function<bool()> stop;  ///< asked from all threads; true ends the sweep; may be empty
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

/// Runs what `folder` does not hold yet, appending each trial as it finishes. Refused, before
/// anything runs, when `folder` holds results of an experiment other than this one and those of
/// `beside`. The result does not depend on `jobs`, nor on how often the sweep was interrupted, nor
/// on how it was sharded.
Result<SweepResult> run_sweep(const Experiment& experiment, const SweepOptions& options);

/// How much of the experiment `options.folder` holds. Uses folder, beside and unused_lines.
Result<SweepProgress> survey_sweep(const Experiment& experiment, const SweepOptions& options);

/// The result from what `options.folder` holds, without running anything; the error when trials are
/// missing says how many, and of which shards. Uses folder, beside and unused_lines.
Result<SweepResult> merge_sweep(const Experiment& experiment, const SweepOptions& options);

/// Path of the trace of a trial with keep_trace.
std::filesystem::path trace_path(const std::filesystem::path& folder, const std::string& key);

/// Replaces the content of `path` by `text` at once: a reader sees the old or the new text. Returns
/// the error when it cannot be written; absent: done.
std::optional<Error> write_atomically(const std::filesystem::path& path, const std::string& text);

}  // namespace pirouette
