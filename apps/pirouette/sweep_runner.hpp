// Runs an experiment as the program does: progress on stderr, tables into a folder and on stdout.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "pirouette/config/experiment_file.hpp"

namespace pirouette::app {

/// Options of `sweep` and `reproduce`. Bound to a subcommand; must outlive the parsing.
class SweepRunner {
 public:
  void add_options(CLI::App& command, const std::string& default_folder);

  /// --seeds and --turns.
  const ExperimentChanges& changes() const { return changes_; }
  /// --jobs. Empty: all is well.
  Errors check() const;
  /// --out, else `fallback`.
  std::string folder(const std::string& fallback) const { return out_.value_or(fallback); }
  bool fresh() const { return fresh_; }

  /// Runs what `folder` does not hold yet, writes NAME.md, NAME.json, NAME.csv and NAME-trials.csv
  /// there and prints the tables. The program's exit code.
  int run(const Experiment& experiment, const std::string& folder, bool fresh) const;

 private:
  std::optional<std::string> out_;
  ExperimentChanges changes_;
  int jobs_ = 0;
  bool fresh_ = false;
};

}  // namespace pirouette::app
