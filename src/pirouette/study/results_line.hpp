// A finished trial as a line of results.jsonl, with a checksum.
#pragma once

#include <string>
#include <string_view>

#include "pirouette/base/result.hpp"
#include "pirouette/metrics/metric_values.hpp"

namespace pirouette {

/// Result of one trial, as a line of results.jsonl.
struct ResultsLine {
  std::string experiment;  ///< name of the experiment that ran the trial
  std::string row;         ///< label of its row there
  std::string key;         ///< trial_key()
  MetricValues values;     ///< of the trial
};

/// JSON without a newline. Its last member, "check", is the FNV-1a fingerprint of the text without
/// that member.
std::string to_text(const ResultsLine& line);

/// Reads what to_text() wrote. An error, without file and line, when the checksum does not fit,
/// when the metrics are not those of metric_names(), or when a value is none of its metric_range().
Result<ResultsLine> parse_results_line(std::string_view text);

}  // namespace pirouette
