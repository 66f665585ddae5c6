// Runs the trials of an experiment in parallel. What is finished survives an interruption.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/config/experiment_file.hpp"
#include "pirouette/experiment/metrics.hpp"

namespace pirouette {

inline constexpr const char* kResultsFile = "results.jsonl";
inline constexpr const char* kTracesFolder = "traces";

/// The numbers of metrics.json by key; a bool is 0 or 1. Without context and wall-clock times, so
/// equal configurations give equal numbers.
using MetricValues = std::map<std::string, Number>;

MetricValues metric_values(const Metrics& metrics);

/// Keys of MetricValues in the order of metrics.json.
std::vector<std::string> metric_names();

/// 16 hexadecimal digits that stand for the trial: of its configuration, the files of robot and
/// path, and the versions of this program and of the physics.
std::string trial_key(const Config& config);

struct SweepProgress {
  std::size_t done = 0;     ///< of `total`, with those that were finished before
  std::size_t resumed = 0;  ///< finished before
  std::size_t total = 0;
  double seconds_left = 0.0;  ///< wall clock; 0 until the first trial of this time is done
};

struct SweepOptions {
  unsigned jobs = 0;  ///< threads; 0: one for each hardware thread
  /// Where kResultsFile and kTracesFolder are; shared by experiments, which then share trials.
  std::filesystem::path folder;
  bool fresh = false;                                  ///< forget what is there
  std::function<void(const SweepProgress&)> progress;  ///< one call at a time; may be empty
  std::function<bool()> stop;  ///< asked from all threads; true ends the sweep; may be empty
};

struct SweepResult {
  std::vector<std::string> keys;     ///< of the experiment's trials, in their order
  std::vector<MetricValues> values;  ///< likewise; empty maps for trials that did not run
  bool interrupted = false;
};

/// What would keep run_sweep() from starting: a robot's file, a terrain, a metric that there is
/// not.
Errors check_sweep(const Experiment& experiment);

/// Runs what `folder` does not hold yet, appending each trial as it finishes. The result does not
/// depend on `jobs`, nor on how often the sweep was interrupted.
Result<SweepResult> run_sweep(const Experiment& experiment, const SweepOptions& options);

/// Path of the trace of a trial with keep_trace.
std::filesystem::path trace_path(const std::filesystem::path& folder, const std::string& key);

/// Replaces `path` by `text` at once: a reader sees the old text or the new one.
std::optional<Error> write_atomically(const std::filesystem::path& path, const std::string& text);

}  // namespace pirouette
