// Runs an experiment as the program does: progress on stderr, tables into a folder and on stdout.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "pirouette/study/experiment_file.hpp"
#include "pirouette/study/sweep.hpp"

namespace pirouette::app {

/// Options of `sweep`, `montecarlo` and `reproduce`. Bound to a subcommand; must outlive the
/// parsing.
class SweepRunner {
 public:
  void add_options(CLI::App& command, const std::string& default_folder);
  /// --seeds.
  void add_seed_options(CLI::App& command);
  /// --trials and --seed.
  void add_draw_options(CLI::App& command);
  /// --shard, --merge and --dry-run, for a folder that belongs to one experiment. After
  /// add_options.
  void add_shard_options(CLI::App& command);

  /// --turns, --seeds, --trials and --seed.
  const ExperimentChanges& changes() const { return changes_; }
  /// --jobs and --shard. Empty: all is well.
  Errors check() const;
  /// --out, else `fallback`.
  std::string folder(const std::string& fallback) const { return out_.value_or(fallback); }
  bool fresh() const { return fresh_; }

  /// Runs what `folder` does not hold yet, writes NAME.md, NAME.json, NAME.csv and the table of all
  /// trials there and prints the tables; a shard leaves its results only. The program's exit code.
  int run(const Experiment& experiment, const std::string& folder, bool fresh) const;

 private:
  /// --shard; absent when not given or wrong.
  std::optional<Shard> shard() const;
  SweepOptions options(const std::string& folder, bool fresh) const;
  Result<SweepResult> results(const Experiment& experiment, const std::string& folder,
                              bool fresh) const;
  /// Prints how much of the experiment `folder` holds.
  int survey(const Experiment& experiment, const std::string& folder) const;
  int write_tables(const Experiment& experiment, const SweepResult& result,
                   const std::string& folder) const;

  std::optional<std::string> out_, shard_;
  ExperimentChanges changes_;
  int jobs_ = 0;
  bool fresh_ = false;
  bool resume_ = false;  ///< what happens anyway; --fresh excludes it
  bool merge_ = false;
  bool dry_run_ = false;
  bool own_folder_ = false;  ///< it belongs to one experiment
};

}  // namespace pirouette::app
