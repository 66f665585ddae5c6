#include "pirouette/metrics/metric_values.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <type_traits>

namespace pirouette {
namespace {

/// Parts of the names of lengths, times, sizes and variances, which are never negative.
constexpr std::string_view kSizes[] = {
    "_time_s",      "_delay_s",    "distance", "radius",         "variance",
    "peak_to_peak", "drift",       "_range",   "body_bias_mm_s", "bias_circle",
    "cross_track",  "along_track", "slip",     "position_error", "yaw_error_",
};

}  // namespace

bool MetricRange::holds(double value) const {
  if (is_bool) return value == 0.0 || value == 1.0;
  return std::isfinite(value) && (!is_size || value >= 0.0);
}

MetricRange metric_range(const std::string& name) {
  const bool is_size =
      std::any_of(std::begin(kSizes), std::end(kSizes),
                  [&](std::string_view part) { return name.find(part) != name.npos; });
  return {.is_bool = name == "fell" || name == "interrupted", .is_size = is_size};
}

MetricValues metric_values(const Metrics& metrics) {
  MetricValues values;
  Metrics::fields(metrics, [&](const auto& value, const char* key, const char*, const char*) {
    const std::string_view name = key;
    if (name.starts_with("timing.") || name.starts_with("context.")) return;
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, bool>) {
      values[key] = value ? 1.0 : 0.0;
    } else if constexpr (std::is_same_v<T, Number>) {
      values[key] = value && std::isfinite(*value) ? value : std::nullopt;
    } else if constexpr (std::is_same_v<T, double>) {
      values[key] = std::isfinite(value) ? Number(value) : std::nullopt;
    }
  });
  return values;
}

std::vector<std::string> metric_names() {
  const Metrics metrics;
  const MetricValues values = metric_values(metrics);
  std::vector<std::string> names;
  Metrics::fields(metrics, [&](const auto&, const char* key, const char*, const char*) {
    if (values.contains(key)) names.emplace_back(key);
  });
  return names;
}

}  // namespace pirouette
