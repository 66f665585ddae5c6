#include "pirouette/metrics/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "pirouette/base/rotation.hpp"
#include "pirouette/metrics/statistics.hpp"

namespace pirouette {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kMillimetres2 = 1e6;

Number scaled(const Number& value, double factor) {
  if (!value) return std::nullopt;
  return *value * factor;
}

std::vector<double> component(std::span<const Vec2> points, int axis) {
  std::vector<double> out;
  out.reserve(points.size());
  for (const Vec2& p : points) out.push_back(p[axis]);
  return out;
}

/// Radius of a steady turn at the speed `bias`; absent without a turn.
Number bias_circle(double bias, const MotionRecord& record) {
  const double angle = record.yaw.back() - record.yaw.front();
  const double duration = record.time.back() - record.time.front();
  if (angle == 0.0) return std::nullopt;
  return bias * duration / std::abs(angle);
}

ComMetrics evaluate_com(const MotionRecord& record, const CommandedMotion& commanded) {
  const std::vector<Vec2> path = resample(record.time, record.p_WG, kComRate);
  ComMetrics com;
  if (commanded.v_H.isZero(0.0)) {
    const std::vector<double> distance = distances(path, commanded.point);
    com.distance_to_point_mean_mm = scaled(mean(distance), kMillimetres);
    com.distance_to_point_max_mm = scaled(maximum(distance), kMillimetres);
    com.distance_to_point_p95_mm = scaled(quantile(distance, 0.95), kMillimetres);
  }
  const std::vector<double> radius = distances(path, centroid(path));
  com.radius_mean_mm = scaled(mean(radius), kMillimetres);
  com.radius_max_mm = scaled(maximum(radius), kMillimetres);
  com.radius_variance_mm2 = scaled(variance(radius), kMillimetres2);
  if (const auto circle = fit_circle(path)) {
    com.circle_radius_mm = circle->mean_radius * kMillimetres;
    com.circle_variance_mm2 = circle->radius_variance * kMillimetres2;
    com.circle_centre_x_mm = (circle->centre.x() - commanded.point.x()) * kMillimetres;
    com.circle_centre_y_mm = (circle->centre.y() - commanded.point.y()) * kMillimetres;
  }
  const auto window = static_cast<std::size_t>(kRecordLength * kComRate);
  com.peak_to_peak_x_mm = scaled(peak_to_peak(component(path, 0), window), kMillimetres);
  com.peak_to_peak_y_mm = scaled(peak_to_peak(component(path, 1), window), kMillimetres);
  com.drift_per_turn_mm = scaled(drift_per_turn(record.yaw, record.p_WG), kMillimetres);
  com.distance_to_average_mean_mm =
      scaled(mean(distances_to_turn_average(record.yaw, record.p_WG)), kMillimetres);
  const auto bias = body_bias(record.yaw, record.v_WG_W, commanded.v_H);
  if (bias && !commanded.hold_heading) {
    com.body_bias_mm_s = bias->norm() * kMillimetres;
    com.body_bias_x_mm_s = bias->x() * kMillimetres;
    com.body_bias_y_mm_s = bias->y() * kMillimetres;
    com.bias_circle_mm = bias_circle(*com.body_bias_mm_s, record);
  }
  const std::vector<Vec2> velocity = resample(record.time, record.v_WG_W, kComRate);
  com.velocity_range_x_mm_s = scaled(peak_to_peak(component(velocity, 0), window), kMillimetres);
  com.velocity_range_y_mm_s = scaled(peak_to_peak(component(velocity, 1), window), kMillimetres);
  return com;
}

PathMetrics evaluate_path(const MotionRecord& record, const CommandedMotion& commanded) {
  constexpr double kWindow = 0.3;  // m, about the last nearest point: stays on its branch
  if (!commanded.path || record.p_WG.empty()) return {};
  std::vector<double> cross_track, along_track;
  double s = record.arc_length.front();
  for (std::size_t i = 0; i < record.p_WG.size(); ++i) {
    s = commanded.path->nearest(record.p_WG[i], s, kWindow);
    cross_track.push_back((record.p_WG[i] - commanded.path->at(s).p).norm());
    along_track.push_back(std::abs(s - record.arc_length[i]));
  }
  return {scaled(mean(cross_track), kMillimetres), scaled(maximum(cross_track), kMillimetres),
          scaled(mean(along_track), kMillimetres)};
}

AccelerationMetrics evaluate_acceleration(const MotionRecord& record, double rate) {
  const auto filtered_variance = [&](const std::vector<double>& x) {
    return variance(zero_phase_lowpass(x, rate, kAccelerationCutoff));
  };
  AccelerationMetrics out;
  out.x_variance = filtered_variance(component(record.a_WB_W, 0));
  out.y_variance = filtered_variance(component(record.a_WB_W, 1));
  out.roll_variance = filtered_variance(central_difference(record.roll_rate, rate));
  out.pitch_variance = filtered_variance(central_difference(record.pitch_rate, rate));
  return out;
}

/// Roll and pitch of the trunk as seen from a plane with unit normal `n_W`, in its own heading:
/// those of the world's horizontal plane are the usual ones.
RollPitchYaw attitude_from_plane(const Mat3& R_WB, const Vec3& n_W) {
  const Vec3 n_B = R_WB.transpose() * n_W;
  return {std::atan2(n_B.y(), n_B.z()), std::atan2(-n_B.x(), std::hypot(n_B.y(), n_B.z())), 0.0};
}

AttitudeMetrics evaluate_attitude(const MotionRecord& record, double rate) {
  const auto window = static_cast<std::size_t>(kRecordLength * rate);
  AttitudeMetrics out;
  out.roll_mean = mean(record.roll);
  out.roll_variance = variance(record.roll);
  out.pitch_mean = mean(record.pitch);
  out.pitch_variance = variance(record.pitch);
  out.roll_range = peak_to_peak(record.roll, window);
  out.pitch_range = peak_to_peak(record.pitch, window);
  out.relative_roll_mean = mean(record.relative_roll);
  out.relative_roll_variance = variance(record.relative_roll);
  out.relative_pitch_mean = mean(record.relative_pitch);
  out.relative_pitch_variance = variance(record.relative_pitch);
  return out;
}

EstimatorMetrics evaluate_estimator(const MotionRecord& record) {
  EstimatorMetrics out;
  if (record.position_error.empty()) return out;
  out.position_error_mm =
      scaled(mean(distances(record.position_error, Vec2::Zero())), kMillimetres);
  out.yaw_error_rad = mean(record.yaw_error);
  out.position_drift_per_turn_mm =
      scaled(drift_per_turn(record.yaw, record.position_error), kMillimetres);
  return out;
}

}  // namespace

void MotionRecord::add(const PlantTruth& truth, double true_yaw, const RobotState& estimate,
                       double reference_arc_length) {
  const RollPitchYaw rpy = rpy_from_rotation(truth.base.R_WB);
  time.push_back(truth.time);
  p_WG.emplace_back(truth.p_WG.head<2>());
  v_WG_W.emplace_back(truth.v_WG_W.head<2>());
  roll.push_back(rpy.roll);
  pitch.push_back(rpy.pitch);
  yaw.push_back(true_yaw);
  a_WB_W.emplace_back(truth.a_WB_W.head<2>());
  roll_rate.push_back(truth.base.w_WB_B.x());
  pitch_rate.push_back(truth.base.w_WB_B.y());
  const RollPitchYaw relative = attitude_from_plane(truth.base.R_WB, truth.ground_normal_W);
  relative_roll.push_back(relative.roll);
  relative_pitch.push_back(relative.pitch);
  position_error.emplace_back((estimate.p_WB - truth.base.p_WB).head<2>());
  yaw_error.push_back(std::abs(wrap_angle(estimate.rpy.yaw - true_yaw)));
  arc_length.push_back(reference_arc_length);
  for (const Leg leg : kLegs) {
    if (truth.contact[leg]) slip.push_back(truth.v_slip_W[leg].norm());
  }
}

Number peak_to_peak(std::span<const double> x, std::size_t length) {
  if (x.empty()) return std::nullopt;
  const std::size_t window = std::min(length, x.size());
  double sum = 0.0;
  std::size_t count = 0;
  for (; (count + 1) * window <= x.size(); ++count) {
    const auto part = x.subspan(count * window, window);
    const auto [low, high] = std::minmax_element(part.begin(), part.end());
    sum += *high - *low;
  }
  return sum / static_cast<double>(count);
}

Number drift_per_turn(std::span<const double> yaw, std::span<const Vec2> p_WG) {
  constexpr double kTurn = 2.0 * kPi;
  if (yaw.empty()) return std::nullopt;
  const double turns = std::abs(yaw.back() - yaw.front()) / kTurn;
  if (turns < 2.0) return std::nullopt;
  std::size_t first = 0;
  while (std::abs(yaw[first] - yaw.front()) < kTurn) ++first;
  std::size_t last = yaw.size();
  while (std::abs(yaw.back() - yaw[last - 1]) < kTurn) --last;
  return (centroid(p_WG.subspan(last)) - centroid(p_WG.first(first))).norm() / (turns - 1.0);
}

std::vector<double> distances_to_turn_average(std::span<const double> yaw,
                                              std::span<const Vec2> p_WG) {
  std::vector<double> out;
  if (yaw.empty()) return out;
  const double direction = yaw.back() < yaw.front() ? -1.0 : 1.0;
  const auto turned = [&](std::size_t i) { return direction * (yaw[i] - yaw.front()); };
  const double end = turned(yaw.size() - 1);
  Vec2 sum = Vec2::Zero();  // of the points in [first, last)
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < yaw.size(); ++i) {
    for (; last < yaw.size() && turned(last) < turned(i) + kPi; ++last) sum += p_WG[last];
    for (; first < last && turned(first) < turned(i) - kPi; ++first) sum -= p_WG[first];
    if (turned(i) < kPi || turned(i) > end - kPi) continue;
    out.push_back((p_WG[i] - sum / static_cast<double>(last - first)).norm());
  }
  return out;
}

std::optional<Vec2> body_bias(std::span<const double> yaw, std::span<const Vec2> v_WG_W,
                              const Vec2& commanded_v_H) {
  if (yaw.empty()) return std::nullopt;
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < yaw.size(); ++i) sum += rot2(-yaw[i]) * v_WG_W[i];
  return Vec2(sum / static_cast<double>(yaw.size()) - commanded_v_H);
}

TimingMetrics summarise_times(std::span<const double> tick_us, std::span<const double> mpc_us,
                              std::span<const double> wbc_us) {
  TimingMetrics timing;
  timing.tick_us_median = quantile(tick_us, 0.5);
  timing.tick_us_p99 = quantile(tick_us, 0.99);
  timing.tick_us_max = maximum(tick_us);
  timing.mpc_us_median = quantile(mpc_us, 0.5);
  timing.wbc_us_median = quantile(wbc_us, 0.5);
  return timing;
}

Metrics evaluate(const MotionRecord& record, const CommandedMotion& commanded, double rate) {
  Metrics m;
  if (record.time.size() > 1) {
    const double angle = record.yaw.back() - record.yaw.front();
    m.turns_done = angle / (2.0 * kPi) * (commanded.yaw_rate < 0.0 ? -1.0 : 1.0);
    m.yaw_rate_mean = angle / (record.time.back() - record.time.front());
    if (commanded.yaw_rate != 0.0) m.yaw_rate_error = *m.yaw_rate_mean / commanded.yaw_rate - 1.0;
  }
  m.com = evaluate_com(record, commanded);
  m.path = evaluate_path(record, commanded);
  m.attitude = evaluate_attitude(record, rate);
  m.acceleration = evaluate_acceleration(record, rate);
  m.contact.slip_mean_mm_s = scaled(mean(record.slip), kMillimetres);
  m.estimator = evaluate_estimator(record);
  return m;
}

namespace {

struct JsonWriter {
  nlohmann::ordered_json root;

  template <class T>
  void operator()(const T& value, const char* key, const char* /*unit*/, const char* /*meaning*/) {
    const std::string_view path = key;
    const auto dot = path.find('.');
    auto& entry = dot == path.npos
                      ? root[std::string(path)]
                      : root[std::string(path.substr(0, dot))][std::string(path.substr(dot + 1))];
    entry = convert(value);
  }

 private:
  template <class T>
  static nlohmann::ordered_json convert(const T& value) {
    return value;
  }
  static nlohmann::ordered_json convert(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
  }
  static nlohmann::ordered_json convert(const Number& value) {
    return value ? convert(*value) : nullptr;
  }
};

}  // namespace

std::string to_json(const Metrics& metrics) {
  JsonWriter writer;
  Metrics::fields(metrics, writer);
  constexpr int kIndent = 2;
  using Json = nlohmann::ordered_json;
  // A path that is not UTF-8 must not throw away the run.
  return writer.root.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string metrics_markdown() {
  std::string out = "| key | unit | meaning |\n|---|---|---|\n";
  const Metrics metrics;
  Metrics::fields(metrics,
                  [&](const auto&, const char* key, const char* unit, const char* meaning) {
                    out += std::string("| `") + key + "` | " + unit + " | " + meaning + " |\n";
                  });
  return out;
}

}  // namespace pirouette
