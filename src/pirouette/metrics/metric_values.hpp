// The metrics of a trial as plain numbers by name.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pirouette/metrics/metrics.hpp"

namespace pirouette {

/// The numbers of metrics.json by key; a bool is 0 or 1. Without context and wall-clock times, so
/// that equal configurations give equal numbers.
using MetricValues = std::map<std::string, Number>;

/// The numbers of `metrics`; nullopt where absent or not finite.
MetricValues metric_values(const Metrics& metrics);

/// What a metric may be.
struct MetricRange {
  bool is_bool = false;  ///< 0 or 1
  bool is_size = false;  ///< from 0 on

  /// Whether `value` is finite and may be.
  bool holds(double value) const;
};

/// Of an entry of metric_names().
MetricRange metric_range(const std::string& name);

/// Keys of MetricValues in the order of metrics.json.
std::vector<std::string> metric_names();

}  // namespace pirouette
