// Results of an experiment as tables and text: for people, spreadsheets and plots.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/study/sweep.hpp"

namespace pirouette {

/// Mean and deviation over the seeds that have a value.
struct Spread {
  double mean = 0.0;       ///< of the values
  double deviation = 0.0;  ///< standard deviation, unbiased; 0 for one seed
  std::size_t count = 0;   ///< number of values
};

/// One row of the experiment at one value of each axis, over all seeds.
struct ReportEntry {
  const ExperimentRow* row = nullptr;      ///< of the entry
  const ExperimentTrial* first = nullptr;  ///< of its trials, for levels and configuration
  const PrintedResult* printed = nullptr;  ///< nullptr: none
  std::size_t trials = 0;                  ///< number of trials
  std::size_t falls = 0;                   ///< number of trials with a fall
  std::map<std::string, Spread> metrics;   ///< of the trials without a fall, but is_of_falls()
  std::string trace;                       ///< path within the sweep's folder; empty: none
};

/// Check of an acceptance bound at one entry.
struct BoundCheck {
  const ExperimentBound* bound = nullptr;  ///< what was checked
  const ReportEntry* entry = nullptr;      ///< where it was checked
  std::optional<double> max;               ///< of the bound, with its share of the other row
  std::string missed;                      ///< reason when the bound is missed; empty: it holds
};

/// Report of an experiment. `experiment` and `result` must outlive it.
struct Report {
  /// Computes the entries.
  explicit Report(const Experiment& experiment, const SweepResult& result);

  const Experiment* experiment;      ///< argument of the constructor
  const SweepResult* result;         ///< argument of the constructor
  std::vector<ReportEntry> entries;  ///< by row and level

  /// Markdown tables beside the printed results, with conclusions.
  std::string markdown() const;
  /// JSON of all metrics of all entries, for plots.
  std::string json() const;
  /// CSV, one line for each entry.
  std::string csv() const;
  /// Every acceptance bound at every entry where it applies, in the order of the file. A bound is
  /// also missed by a fall.
  std::vector<BoundCheck> check_bounds() const;
  /// One sentence for each missed bound.
  std::vector<std::string> missed_bounds() const;
};

}  // namespace pirouette
