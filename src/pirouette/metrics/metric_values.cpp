#include "pirouette/metrics/metric_values.hpp"

#include <cmath>
#include <string_view>
#include <type_traits>

namespace pirouette {

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
