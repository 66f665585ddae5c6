// Texts and numbers shared by the parts of a report; for this folder only.
#pragma once

#include <span>
#include <string>

#include "pirouette/report/report.hpp"

namespace pirouette {

inline constexpr const char* kFallTime = "fall_time_s";  ///< key of the time of the fall
/// Key of the time from the fall to the stand-down.
inline constexpr const char* kStandDownDelay = "stand_down_delay_s";

/// True for a metric that only trials with a fall have.
inline bool is_of_falls(const std::string& metric) {
  return metric == kFallTime || metric == kStandDownDelay;
}

/// A parameter that a reader needs to compare numbers; one for every table.
struct ReportContext {
  const char* title;                   ///< in the report
  const char* key;                     ///< of the parameter
  std::string (*text)(const Config&);  ///< its value in a Config
};
/// All of them, in the order of the report.
std::span<const ReportContext> report_contexts();

/// A CSV cell, quoted if needed.
std::string csv_cell(const std::string& text);
/// A CSV cell: the shortest text that reads back as the same number.
std::string csv_cell(double value);

/// `text`, of one line, as Markdown that shows it as it is: no mark-up, no HTML, no end of a
/// table's cell.
std::string markdown(const std::string& text);
/// `text` of Markdown without HTML.
std::string without_html(const std::string& text);

/// Three significant digits.
std::string short_number(double value);
/// "1.23 ± 0.04"; without the deviation for a single seed.
std::string with_spread(const Spread& spread);

/// Spread of `metric`; nullptr: no trial has a value.
const Spread* find_metric(const ReportEntry& entry, const std::string& metric);
/// Printed value of `metric`; nullptr: none.
const double* find_printed(const ReportEntry& entry, const std::string& metric);

/// "plant.friction 0.4, com.planner psp": the axes' values, without the profile; plain text.
std::string axes_text(const Experiment& experiment, const ExperimentTrial& trial);
/// The row's label and axes_text().
std::string place_text(const Experiment& experiment, const ReportEntry& entry);

}  // namespace pirouette
