// What an experiment's trials say, as tables and text: for people, for spreadsheets, for plots.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/study/sweep.hpp"

namespace pirouette {

/// Over the seeds that gave a value.
struct Spread {
  double mean = 0.0;
  double deviation = 0.0;  ///< standard deviation, unbiased; 0 for one seed
  std::size_t count = 0;
};

/// One row of the experiment at one value of each axis, over all seeds.
struct ReportEntry {
  const ExperimentRow* row = nullptr;
  const ExperimentTrial* first = nullptr;  ///< of its trials; carries levels and configuration
  const PrintedResult* printed = nullptr;  ///< nullptr: nothing printed for it
  std::size_t trials = 0;
  std::size_t falls = 0;
  std::map<std::string, Spread> metrics;  ///< of the trials without a fall, but is_of_falls()
  std::string trace;                      ///< path within the sweep's folder; empty: none
};

/// An acceptance bound at one entry.
struct BoundCheck {
  const ExperimentBound* bound = nullptr;
  const ReportEntry* entry = nullptr;
  std::optional<double> max;  ///< of the bound, with its share of the other row
  std::string missed;         ///< why; empty: it holds
};

/// Points into `experiment`, which must outlive it.
struct Report {
  explicit Report(const Experiment& experiment, const SweepResult& result);

  const Experiment* experiment;
  const SweepResult* result;
  std::vector<ReportEntry> entries;

  /// Tables beside the printed figures, and what follows from the numbers.
  std::string markdown() const;
  /// All metrics of all entries, for plots.
  std::string json() const;
  /// One line for each entry.
  std::string csv() const;
  /// Each acceptance bound wherever it applies, in the order of the file. A fall misses it too.
  std::vector<BoundCheck> check_bounds() const;
  /// A sentence for each that is missed.
  std::vector<std::string> missed_bounds() const;
};

}  // namespace pirouette
