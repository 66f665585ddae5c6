// Statistics of a list of samples. "Absent" is nullopt.
#pragma once

#include <optional>
#include <span>

namespace pirouette {

/// Mean; absent without samples.
std::optional<double> mean(std::span<const double> x);
/// Unbiased variance (divided by n - 1); absent for fewer than two samples.
std::optional<double> variance(std::span<const double> x);
/// Value below which the share in [0, 1] of the samples lies; linear between order statistics.
/// Absent without samples.
std::optional<double> quantile(std::span<const double> x, double share);
/// Largest sample; absent without samples.
std::optional<double> maximum(std::span<const double> x);

/// Closed interval.
struct Interval {
  double low = 0.0;   ///< lower end
  double high = 0.0;  ///< upper end
};

/// 95 % confidence interval of the probability of an event that occurred in `count` of `trials`;
/// absent without trials. [Wilson27]: (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n),
/// p = count/n, z = 1.96.
std::optional<Interval> wilson_interval(std::size_t count, std::size_t trials);

}  // namespace pirouette
