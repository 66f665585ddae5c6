#include "pirouette/metrics/statistics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

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

Vec2 centroid(std::span<const Vec2> points) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : points) sum += p;
  return points.empty() ? sum : Vec2(sum / static_cast<double>(points.size()));
}

std::vector<double> distances(std::span<const Vec2> points, const Vec2& centre) {
  std::vector<double> out;
  out.reserve(points.size());
  for (const Vec2& p : points) out.push_back((p - centre).norm());
  return out;
}

std::optional<CircleFit> fit_circle(std::span<const Vec2> points) {
  if (points.size() < 3) return std::nullopt;
  // About the mean point the constant decouples: 2 S c = sum x |x|^2, k = mean |x|^2.
  const Vec2 origin = centroid(points);
  const auto count = static_cast<double>(points.size());
  Mat2 scatter = Mat2::Zero();
  Vec2 moment = Vec2::Zero();
  for (const Vec2& p : points) {
    const Vec2 x = p - origin;
    scatter += x * x.transpose();
    moment += x * x.squaredNorm();
  }
  constexpr double kCollinear = 1e-12;  // of the scatter's eigenvalues: rounding of doubles
  const double trace = scatter.trace();
  if (!(scatter.determinant() > kCollinear * trace * trace)) return std::nullopt;

  const Vec2 centre = scatter.ldlt().solve(0.5 * moment);
  CircleFit fit;
  fit.centre = origin + centre;
  fit.radius = std::sqrt(trace / count + centre.squaredNorm());
  const std::vector<double> rho = distances(points, fit.centre);
  fit.mean_radius = *mean(rho);
  fit.radius_variance = *variance(rho);
  return fit;
}

std::vector<Vec2> resample(std::span<const double> time, std::span<const Vec2> points,
                           double rate) {
  std::vector<Vec2> out;
  if (time.empty()) return out;
  constexpr double kSlack = 1e-6;  // s; the last sample may fall short by rounding
  std::size_t next = 0;
  for (std::size_t k = 0;; ++k) {
    const double t = time.front() + static_cast<double>(k) / rate;
    if (t > time.back() + kSlack) return out;
    while (next + 1 < time.size() && time[next] < t) ++next;
    if (next == 0) {
      out.push_back(points[0]);
      continue;
    }
    const double share = (t - time[next - 1]) / (time[next] - time[next - 1]);
    out.push_back(points[next - 1] + std::min(share, 1.0) * (points[next] - points[next - 1]));
  }
}

std::vector<double> central_difference(std::span<const double> x, double rate) {
  if (x.size() < 3) return {};
  const std::size_t last = x.size() - 1;
  std::vector<double> out(x.size());
  out[0] = (x[1] - x[0]) * rate;
  for (std::size_t i = 1; i < last; ++i) out[i] = (x[i + 1] - x[i - 1]) * rate / 2.0;
  out[last] = (x[last] - x[last - 1]) * rate;
  return out;
}

namespace {

/// A second-order section in direct form II transposed.
struct Biquad {
  double b0, b1, b2, a1, a2;

  /// Filters `x` in place, starting in the steady state of its first value.
  void run(std::vector<double>& x) const {
    double s2 = (b2 - a2) * x.front();
    double s1 = (b1 - a1) * x.front() + s2;
    for (double& value : x) {
      const double input = value;
      value = b0 * input + s1;
      s1 = b1 * input - a1 * value + s2;
      s2 = b2 * input - a2 * value;
    }
  }
};

Biquad butterworth(double rate, double cutoff) {
  const double k = std::tan(kPi * cutoff / rate);
  const double damping = std::sqrt(2.0) * k;
  const double norm = 1.0 + damping + k * k;
  const double b = k * k / norm;
  return {b, 2.0 * b, b, 2.0 * (k * k - 1.0) / norm, (1.0 - damping + k * k) / norm};
}

}  // namespace

std::vector<double> zero_phase_lowpass(std::span<const double> x, double rate, double cutoff) {
  constexpr std::size_t kPad = 9;  // 3 times the number of coefficients
  if (x.size() <= kPad || cutoff >= rate / 2.0) return {};
  const std::size_t n = x.size();
  std::vector<double> padded;
  padded.reserve(n + 2 * kPad);
  for (std::size_t i = kPad; i > 0; --i) padded.push_back(2.0 * x[0] - x[i]);
  padded.insert(padded.end(), x.begin(), x.end());
  for (std::size_t i = 1; i <= kPad; ++i) padded.push_back(2.0 * x[n - 1] - x[n - 1 - i]);

  const Biquad filter = butterworth(rate, cutoff);
  filter.run(padded);
  std::reverse(padded.begin(), padded.end());
  filter.run(padded);
  std::reverse(padded.begin(), padded.end());
  return {padded.begin() + kPad, padded.end() - kPad};
}

}  // namespace pirouette
