// Statistics of samples, for the metrics. "Absent" is nullopt.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pirouette/base/math.hpp"

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

/// Mean of points; zero for none.
Vec2 centroid(std::span<const Vec2> points);
/// Distance of each point to `centre`.
std::vector<double> distances(std::span<const Vec2> points, const Vec2& centre);

/// Result of fit_circle(), in the unit of the points.
struct CircleFit {
  Vec2 centre = Vec2::Zero();    ///< of the fitted circle
  double radius = 0.0;           ///< of the fitted circle
  double mean_radius = 0.0;      ///< mean distance of the points to the centre
  double radius_variance = 0.0;  ///< unbiased, of that distance
};

/// Least-squares circle (Kasa): solves 2 c.x + k = |x|^2 for the centre c, radius^2 = k + |c|^2.
/// Absent for fewer than three points or collinear ones. docs/equations.md#metrics
std::optional<CircleFit> fit_circle(std::span<const Vec2> points);

/// Samples (`time`, `points`), time increasing, linearly interpolated at time.front() + k / rate.
std::vector<Vec2> resample(std::span<const double> time, std::span<const Vec2> points, double rate);

/// Central difference of uniform samples; one-sided at the two ends. Empty for fewer than three.
std::vector<double> central_difference(std::span<const double> x, double rate);

/// Second-order Butterworth low-pass (bilinear, cut-off prewarped) run forwards and backwards:
/// no phase, amplitude gain 1 / (1 + (tan(pi f / rate) / tan(pi cutoff / rate))^4).
/// Ends as scipy.signal.filtfilt: odd extension by 9 samples, steady start. Records of 9 samples or
/// fewer, and a cut-off at or above rate / 2, give an empty result.
std::vector<double> zero_phase_lowpass(std::span<const double> x, double rate, double cutoff);

}  // namespace pirouette
