// Report of a random experiment: how many trials survive, how well, and the worst of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pirouette/study/sweep.hpp"

namespace pirouette {

/// The trials of one row, or of all rows.
struct SurvivalGroup {
  std::string label;                        ///< of the row
  std::size_t trials = 0;                   ///< number of trials
  std::size_t falls = 0;                    ///< number of trials with a fall
  std::vector<double> stand_down_delays{};  ///< s, of the falls that ended in the stand-down
  std::map<std::string, std::vector<double>>
      samples{};  ///< by metric; of the trials without a fall
};

/// Report of a random experiment. `experiment` and `result` must outlive it.
struct SurvivalReport {
  /// Computes groups and worst trials.
  SurvivalReport(const Experiment& experiment, const SweepResult& result);

  const Experiment* experiment;           ///< argument of the constructor
  const SweepResult* result;              ///< argument of the constructor
  std::vector<ExperimentColumn> columns;  ///< the experiment's, else distance and radius
  std::vector<SurvivalGroup> groups;      ///< all, then each row where there are several
  /// Numbers (from 0) of up to ten trials: those that fell, the earliest first, then those with the
  /// largest value in the first column.
  std::vector<std::size_t> worst;

  /// Markdown tables: what was drawn, survival with 95 % intervals, quantiles, the worst trials
  /// with the command line that repeats each.
  std::string markdown() const;
  /// JSON of the same numbers.
  std::string json() const;
  /// A sentence when more trials fell than the experiment allows, and one when a fall did not end
  /// in the stand-down. Empty: none.
  std::vector<std::string> missed_bounds() const;
};

}  // namespace pirouette
