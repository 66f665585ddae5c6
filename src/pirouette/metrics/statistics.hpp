// Statistics of a list of samples. Pure functions; "absent" is nullopt.
#pragma once

#include <optional>
#include <span>

namespace pirouette {

std::optional<double> mean(std::span<const double> x);
/// Unbiased (divided by n - 1); absent for fewer than two samples.
std::optional<double> variance(std::span<const double> x);
/// Share in [0, 1] of the samples lies below the result; linear between order statistics.
std::optional<double> quantile(std::span<const double> x, double share);
std::optional<double> maximum(std::span<const double> x);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// 95 % confidence interval of a probability of which `count` of `trials` came true; absent without
/// trials. [Wilson27]: (p + z^2/2n +- z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n), p = count/n,
/// z = 1.96.
std::optional<Interval> wilson_interval(std::size_t count, std::size_t trials);

}  // namespace pirouette
