// The metrics from whole lists, as plainly as they are defined: the oracle of MotionMetrics.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "pirouette/metrics/motion_metrics.hpp"
#include "pirouette/metrics/statistics.hpp"

namespace pirouette::test {

using Numbers = std::vector<double>;
using Points = std::vector<Vec2>;

template <class Of>
auto list_of(const std::vector<MotionSample>& motion, Of&& of) {
  std::vector<std::decay_t<decltype(of(motion.front()))>> out;
  out.reserve(motion.size());
  for (const MotionSample& sample : motion) out.push_back(of(sample));
  return out;
}

inline Vec2 centroid(const Points& points) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

inline Numbers distances(const Points& points, const Vec2& centre) {
  Numbers out;
  for (const Vec2& p : points) out.push_back((p - centre).norm());
  return out;
}

/// Centre of Kasa's circle, from its normal equations about the mean point.
inline Vec2 circle_centre(const Points& points) {
  const Vec2 origin = centroid(points);
  Mat2 scatter = Mat2::Zero();
  Vec2 moment = Vec2::Zero();
  for (const Vec2& p : points) {
    const Vec2 x = p - origin;
    scatter += x * x.transpose();
    moment += x * x.squaredNorm();
  }
  return origin + Vec2(scatter.ldlt().solve(0.5 * moment));
}

/// Linear interpolation at time.front() + k / rate.
inline Points resample(const Numbers& time, const Points& points, double rate) {
  Points out;
  std::size_t next = 0;
  for (std::size_t k = 0;; ++k) {
    const double t = time.front() + static_cast<double>(k) / rate;
    if (t > time.back() + 1e-6) return out;
    while (next + 1 < time.size() && time[next] < t) ++next;
    const std::size_t before = next == 0 ? 0 : next - 1;
    const double share = next == 0 ? 0.0 : (t - time[before]) / (time[next] - time[before]);
    out.push_back(points[before] + std::min(share, 1.0) * (points[next] - points[before]));
  }
}

inline Numbers central_difference(const Numbers& x, double rate) {
  Numbers out(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t below = i == 0 ? 0 : i - 1, above = std::min(i + 1, x.size() - 1);
    out[i] = (x[above] - x[below]) * rate / static_cast<double>(above - below);
  }
  return out;
}

/// scipy.signal.filtfilt(*scipy.signal.butter(2, cutoff, fs=rate), x).
inline Numbers filtfilt(const Numbers& x, double rate, double cutoff) {
  constexpr std::size_t kPad = 9;
  const std::size_t n = x.size();
  Numbers padded;
  for (std::size_t i = kPad; i > 0; --i) padded.push_back(2.0 * x[0] - x[i]);
  padded.insert(padded.end(), x.begin(), x.end());
  for (std::size_t i = 1; i <= kPad; ++i) padded.push_back(2.0 * x[n - 1] - x[n - 1 - i]);
  for (int way = 0; way < 2; ++way) {
    Biquad filter = butterworth(rate, cutoff);
    filter.settle(padded.front());
    for (double& value : padded) value = filter.step(value);
    std::reverse(padded.begin(), padded.end());
  }
  return {padded.begin() + kPad, padded.end() - kPad};
}

inline double peak_to_peak(const Numbers& x, std::size_t length) {
  const std::size_t window = std::min(length, x.size());
  double sum = 0.0;
  std::size_t count = 0;
  for (; (count + 1) * window <= x.size(); ++count) {
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(count * window);
    const auto [low, high] =
        std::minmax_element(begin, begin + static_cast<std::ptrdiff_t>(window));
    sum += *high - *low;
  }
  return sum / static_cast<double>(count);
}

inline double drift_per_turn(const Numbers& yaw, const Points& points) {
  constexpr double kTurn = 2.0 * kPi;
  std::size_t first = 0, last = yaw.size();
  while (std::abs(yaw[first] - yaw.front()) < kTurn) ++first;
  while (std::abs(yaw.back() - yaw[last - 1]) < kTurn) --last;
  const Points begin(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(first));
  const Points end(points.begin() + static_cast<std::ptrdiff_t>(last), points.end());
  const double turns = std::abs(yaw.back() - yaw.front()) / kTurn;
  return (centroid(end) - centroid(begin)).norm() / (turns - 1.0);
}

inline Numbers distances_to_turn_average(const Numbers& yaw, const Points& points) {
  Numbers out;
  const double direction = yaw.back() < yaw.front() ? -1.0 : 1.0;
  const auto turned = [&](std::size_t i) { return direction * (yaw[i] - yaw.front()); };
  const double end = turned(yaw.size() - 1);
  Vec2 sum = Vec2::Zero();  // of the points in [first, last)
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < yaw.size(); ++i) {
    for (; last < yaw.size() && turned(last) < turned(i) + kPi; ++last) sum += points[last];
    for (; first < last && turned(first) < turned(i) - kPi; ++first) sum -= points[first];
    if (turned(i) < kPi || turned(i) > end - kPi) continue;
    out.push_back((points[i] - sum / static_cast<double>(last - first)).norm());
  }
  return out;
}

/// Of a motion of two turns or more in which everything is known.
inline Metrics two_pass_metrics(const std::vector<MotionSample>& motion,
                                const CommandedMotion& commanded, double rate) {
  const auto time = list_of(motion, [](const auto& s) { return s.time; });
  const auto yaw = list_of(motion, [](const auto& s) { return s.yaw; });
  const auto place = list_of(motion, [](const auto& s) { return s.p_WG; });
  const Points com = resample(time, place, kComRate);
  Metrics m;
  const Numbers distance = distances(com, commanded.point);
  m.com.distance_to_point_mean_mm = 1e3 * *mean(distance);
  m.com.distance_to_point_max_mm = 1e3 * *maximum(distance);
  m.com.distance_to_point_p95_mm = 1e3 * *quantile(distance, 0.95);
  const Numbers radius = distances(com, centroid(com));
  m.com.radius_mean_mm = 1e3 * *mean(radius);
  m.com.radius_max_mm = 1e3 * *maximum(radius);
  m.com.radius_variance_mm2 = 1e6 * *variance(radius);
  const Vec2 centre = circle_centre(com);
  const Numbers rho = distances(com, centre);
  m.com.circle_radius_mm = 1e3 * *mean(rho);
  m.com.circle_variance_mm2 = 1e6 * *variance(rho);
  m.com.circle_centre_x_mm = 1e3 * (centre - commanded.point).x();
  m.com.circle_centre_y_mm = 1e3 * (centre - commanded.point).y();
  const auto com_window = static_cast<std::size_t>(kRecordLength * kComRate);
  const auto axis = [](const Points& points, int k) {
    Numbers out;
    for (const Vec2& p : points) out.push_back(p[k]);
    return out;
  };
  m.com.peak_to_peak_x_mm = 1e3 * peak_to_peak(axis(com, 0), com_window);
  m.com.peak_to_peak_y_mm = 1e3 * peak_to_peak(axis(com, 1), com_window);
  const Points v =
      resample(time, list_of(motion, [](const auto& s) { return s.v_WG_W; }), kComRate);
  m.com.velocity_range_x_mm_s = 1e3 * peak_to_peak(axis(v, 0), com_window);
  m.com.velocity_range_y_mm_s = 1e3 * peak_to_peak(axis(v, 1), com_window);
  m.com.drift_per_turn_mm = 1e3 * drift_per_turn(yaw, place);
  m.com.distance_to_average_mean_mm = 1e3 * *mean(distances_to_turn_average(yaw, place));
  const auto v_H = list_of(motion, [](const auto& s) { return Vec2(rot2(-s.yaw) * s.v_WG_W); });
  const Vec2 bias = centroid(v_H) - commanded.v_H;
  m.com.body_bias_mm_s = 1e3 * bias.norm();
  m.com.body_bias_x_mm_s = 1e3 * bias.x();
  m.com.body_bias_y_mm_s = 1e3 * bias.y();

  const auto window = static_cast<std::size_t>(kRecordLength * rate);
  const auto roll = list_of(motion, [](const auto& s) { return *s.roll; });
  const auto pitch = list_of(motion, [](const auto& s) { return *s.pitch; });
  m.attitude.roll_mean = mean(roll);
  m.attitude.roll_variance = variance(roll);
  m.attitude.pitch_mean = mean(pitch);
  m.attitude.pitch_variance = variance(pitch);
  m.attitude.roll_range = peak_to_peak(roll, window);
  m.attitude.pitch_range = peak_to_peak(pitch, window);
  const auto filtered = [&](const Numbers& x) {
    return variance(filtfilt(x, rate, kAccelerationCutoff));
  };
  const auto slope = [&](const Numbers& x) { return filtered(central_difference(x, rate)); };
  m.acceleration.x_variance =
      filtered(list_of(motion, [](const auto& s) { return s.a_WB_W->x(); }));
  m.acceleration.y_variance =
      filtered(list_of(motion, [](const auto& s) { return s.a_WB_W->y(); }));
  m.acceleration.roll_variance = slope(list_of(motion, [](const auto& s) { return *s.roll_rate; }));
  m.acceleration.pitch_variance =
      slope(list_of(motion, [](const auto& s) { return *s.pitch_rate; }));
  const auto error = list_of(motion, [](const auto& s) { return *s.position_error; });
  m.estimator.position_error_mm = 1e3 * *mean(distances(error, Vec2::Zero()));
  m.estimator.position_drift_per_turn_mm = 1e3 * drift_per_turn(yaw, error);
  m.estimator.yaw_error_rad = mean(list_of(motion, [](const auto& s) { return *s.yaw_error; }));
  return m;
}

}  // namespace pirouette::test
