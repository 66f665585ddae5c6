// Finished trials of a folder: one line of JSON each, in one file per writing process.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/study/results_line.hpp"

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

/// Lines of a file by their numbers, from 1 on.
using NumberedLines = std::map<int, std::string>;

/// The results of a folder, read and checked, and the file to append new ones to.
class ResultsLog {
 public:
  /// Where a result stands.
  struct Entry {
    ResultsLine line;            ///< the result
    std::filesystem::path file;  ///< file that holds it
    int number = 0;              ///< of the line, from 1 on
  };

  /// Reads all results of `folder` and opens the file of `shard` for appending; `fresh`, without a
  /// shard, deletes them all. Lines that are rejected() are taken out of every file to which no
  /// other process writes. Fails while another process writes the same file, or, with `fresh`, any
  /// of them.
  static Result<ResultsLog> open(const std::filesystem::path& folder,
                                 const std::optional<Shard>& shard, bool fresh);
  /// Reads all results of `folder` and changes nothing. append() is not allowed.
  static ResultsLog read(const std::filesystem::path& folder);

  ResultsLog(ResultsLog&& other) noexcept;  ///< moves
  ResultsLog& operator=(ResultsLog&&) = delete;
  ~ResultsLog();

  /// Result of the trial `key`; nullptr: not finished.
  const MetricValues* find(const std::string& key) const;
  /// By trial_key().
  const std::map<std::string, Entry>& entries() const { return entries_; }
  /// Lines that were no result, with file, line and why; they are not among the entries. Of two
  /// lines with different values for one trial neither is.
  const Errors& rejected() const { return rejected_; }

  /// In one write: a process that is killed leaves the whole line or a part of it at the end, which
  /// open() rejects.
  std::optional<Error> append(ResultsLine line);

 private:
  ResultsLog() = default;

  void read_lines(const std::filesystem::path& path);
  void add(ResultsLine line, const std::filesystem::path& path, int number);
  void reject(const std::filesystem::path& path, int number, const std::string& text, Error why);
  void reject_contradiction(const ResultsLine& line, const std::filesystem::path& path, int number);
  std::optional<Error> remove_rejected();

  std::filesystem::path path_;
  int file_ = -1;
  std::map<std::string, Entry> entries_;
  std::set<std::string> contradicted_;  ///< keys of trials with lines that differ
  Errors rejected_;
  std::map<std::filesystem::path, NumberedLines> rejected_lines_;
};

/// Numbers N of the shards i/N that have written to `folder`, ascending.
std::vector<unsigned> shard_counts(const std::filesystem::path& folder);

}  // namespace pirouette
