#include "pirouette/metrics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "pirouette/base/math.hpp"

namespace pirouette {

std::optional<double> mean(std::span<const double> x) {
  if (x.empty()) return std::nullopt;
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

std::optional<double> variance(std::span<const double> x) {
  if (x.size() < 2) return std::nullopt;
  const double centre = *mean(x);
  double sum = 0.0;
  for (const double value : x) sum += square(value - centre);
  return sum / static_cast<double>(x.size() - 1);
}

std::optional<double> quantile(std::span<const double> x, double share) {
  if (x.empty()) return std::nullopt;
  std::vector<double> sorted(x.begin(), x.end());
  std::sort(sorted.begin(), sorted.end());
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], position - static_cast<double>(below));
}

std::optional<double> maximum(std::span<const double> x) {
  if (x.empty()) return std::nullopt;
  return *std::max_element(x.begin(), x.end());
}

std::optional<Interval> wilson_interval(std::size_t count, std::size_t trials) {
  if (trials == 0) return std::nullopt;
  constexpr double kNormal95 = 1.959963984540054;  // 97.5 % quantile of the normal distribution
  const auto n = static_cast<double>(trials);
  const double share = static_cast<double>(count) / n;
  const double pull = square(kNormal95) / n;
  const double centre = (share + pull / 2.0) / (1.0 + pull);
  const double half =
      kNormal95 / (1.0 + pull) * std::sqrt(share * (1.0 - share) / n + pull / (4.0 * n));
  return Interval{std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

}  // namespace pirouette
