// Finished trials of a folder: one line of JSON each, in one file per writing process.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/metrics/metric_values.hpp"

namespace pirouette {

/// Every count-th trial from the index-th on, counted from 1; {1, 1}: all trials.
struct Shard {
  unsigned index = 1;  ///< in [1, count]
  unsigned count = 1;  ///< number of shards

  /// True when the trial at `position` (from 0) is in this shard.
  bool holds(std::size_t position) const { return position % count == index - 1; }
  /// "2of4".
  std::string name() const;
};

/// results.jsonl, or results-2of4.jsonl for a shard: no two processes append to the same file, so
/// the folder may lie on a network file system.
std::string results_file(const std::optional<Shard>& shard);

/// Results by trial_key().
class ResultsLog {
 public:
  /// Reads all results of `folder` and opens the file of `shard` for appending; `fresh`, without a
  /// shard, deletes them all. An error while another process writes the same file or, with
  /// `fresh`, any of them.
  static Result<ResultsLog> open(const std::filesystem::path& folder,
                                 const std::optional<Shard>& shard, bool fresh);
  /// Reads all results of `folder` and changes nothing. append() is not allowed.
  static ResultsLog read(const std::filesystem::path& folder);

  ResultsLog(ResultsLog&& other) noexcept;  ///< moves
  ResultsLog& operator=(ResultsLog&&) = delete;
  ~ResultsLog();

  /// Result of the trial `key`; nullptr: not finished.
  const MetricValues* find(const std::string& key) const;
  /// Appends a result in one write: a process that is killed leaves the whole line or a part of it
  /// at the end, which open() removes. Returns the error when it cannot be written; absent: done.
  std::optional<Error> append(const std::string& key, const MetricValues& values);

 private:
  ResultsLog() = default;

  void read_lines(const std::filesystem::path& path);

  std::filesystem::path path_;
  int file_ = -1;
  std::map<std::string, MetricValues> finished_;
};

/// Numbers N of the shards i/N that have written to `folder`, ascending.
std::vector<unsigned> shard_counts(const std::filesystem::path& folder);

}  // namespace pirouette
