// What the trials of a random experiment say: how many survive, how well, and the worst of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pirouette/study/sweep.hpp"

namespace pirouette {

/// The trials of a row, or all of them.
struct SurvivalGroup {
  std::string label;
  std::size_t trials = 0;
  std::size_t falls = 0;
  std::vector<double> stand_down_delays{};  ///< s, of the falls that ended in the stand-down
  std::map<std::string, std::vector<double>>
      samples{};  ///< by metric; of the trials without a fall
};

/// Points into what it is made of, which must outlive it.
struct SurvivalReport {
  SurvivalReport(const Experiment& experiment, const SweepResult& result);

  const Experiment* experiment;
  const SweepResult* result;
  std::vector<ExperimentColumn> columns;  ///< the experiment's, else distance and radius
  std::vector<SurvivalGroup> groups;      ///< all, then each row where there are several
  /// Numbers of up to ten trials: those that fell, the earliest first, then the largest of the
  /// first column.
  std::vector<std::size_t> worst;

  /// Tables for people: what was drawn, survival with 95 % intervals, quantiles, the worst trials
  /// with the command line that repeats each.
  std::string markdown() const;
  /// The same numbers for programs.
  std::string json() const;
  /// Not empty when more trials fell than the experiment allows, or one fell and did not end in the
  /// stand-down.
  std::vector<std::string> missed_bounds() const;
};

}  // namespace pirouette
