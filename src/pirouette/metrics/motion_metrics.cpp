#include "pirouette/metrics/motion_metrics.hpp"

#include <algorithm>
#include <cmath>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kMillimetres2 = 1e6;
constexpr double kLeastSamples = 10.0;  // of a variance or circle: fewer say nothing

Number scaled(const Number& value, double factor) {
  if (!value) return std::nullopt;
  return *value * factor;
}

Number variance_of(const RunningMoments& moments) {
  return moments.count() < kLeastSamples ? std::nullopt : moments.variance();
}

void add_known(RunningMoments& moments, const Number& value) {
  if (value) moments.add(*value);
}

std::size_t record_samples(double rate) {
  return static_cast<std::size_t>(std::max(1.0, kRecordLength * rate));
}

/// Roll and pitch of the trunk as seen from a plane with unit normal `n_W`, in its own heading:
/// those of the world's horizontal plane are the usual ones.
RollPitchYaw attitude_from_plane(const Mat3& R_WB, const Vec3& n_W) {
  const Vec3 n_B = R_WB.transpose() * n_W;
  return {std::atan2(n_B.y(), n_B.z()), std::atan2(-n_B.x(), std::hypot(n_B.y(), n_B.z())), 0.0};
}

/// Whether points about `mean` go at least half around their circle: those of half a circle have
/// their mean 2 / pi of the radius off the centre.
bool goes_around(const Circle& circle, const Vec2& mean) {
  return (circle.centre - mean).norm() <= 2.0 / kPi * circle.radius;
}

}  // namespace

MotionSample motion_sample(const PlantTruth& truth, double yaw, const RobotState& estimate,
                           double reference_arc_length) {
  const RollPitchYaw rpy = rpy_from_rotation(truth.base.R_WB);
  const RollPitchYaw relative = attitude_from_plane(truth.base.R_WB, truth.ground_normal_W);
  MotionSample sample;
  sample.time = truth.time;
  sample.p_WG = truth.p_WG.head<2>();
  sample.v_WG_W = truth.v_WG_W.head<2>();
  sample.yaw = yaw;
  sample.roll = rpy.roll;
  sample.pitch = rpy.pitch;
  sample.relative_roll = relative.roll;
  sample.relative_pitch = relative.pitch;
  sample.a_WB_W = truth.a_WB_W.head<2>();
  sample.roll_rate = truth.base.w_WB_B.x();
  sample.pitch_rate = truth.base.w_WB_B.y();
  sample.position_error = (estimate.p_WB - truth.base.p_WB).head<2>();
  sample.yaw_error = std::abs(wrap_angle(estimate.rpy.yaw - yaw));
  sample.arc_length = reference_arc_length;
  for (const Leg leg : kLegs) {
    if (truth.contact[leg]) sample.slip[leg] = truth.v_slip_W[leg].norm();
  }
  return sample;
}

MotionMetrics::MotionMetrics(const CommandedMotion& commanded, double rate)
    : commanded_(commanded),
      com_range_{WindowRange(record_samples(kComRate)), WindowRange(record_samples(kComRate)),
                 WindowRange(record_samples(kComRate)), WindowRange(record_samples(kComRate))},
      roll_range_(record_samples(rate)),
      pitch_range_(record_samples(rate)),
      x_acceleration_(rate, kAccelerationCutoff),
      y_acceleration_(rate, kAccelerationCutoff),
      roll_acceleration_(rate, kAccelerationCutoff),
      pitch_acceleration_(rate, kAccelerationCutoff) {}

void MotionMetrics::Largest::add(double x) {
  moments.add(x);
  largest = std::max(largest, x);
}

void MotionMetrics::add(const MotionSample& s) {
  if (count_++ == 0) {
    first_time_ = s.time;
    nearest_ = s.arc_length;
  }
  last_time_ = s.time;
  Vec4 com;
  com << s.p_WG, s.v_WG_W;
  com_resampler_.add(s.time, com, [&](const Vec4& x) { add_com(x.head<2>(), x.tail<2>()); });
  turns_.add(s.yaw, s.p_WG, s.position_error.value_or(Vec2::Zero()));
  v_H_sum_ += rot2(-s.yaw) * s.v_WG_W;
  add_path(s.p_WG, s.arc_length);

  add_known(roll_, s.roll);
  add_known(pitch_, s.pitch);
  add_known(relative_roll_, s.relative_roll);
  add_known(relative_pitch_, s.relative_pitch);
  if (s.roll) roll_range_.add(*s.roll);
  if (s.pitch) pitch_range_.add(*s.pitch);
  if (s.a_WB_W) x_acceleration_.add(s.a_WB_W->x());
  if (s.a_WB_W) y_acceleration_.add(s.a_WB_W->y());
  if (s.roll_rate) roll_acceleration_.add(*s.roll_rate);
  if (s.pitch_rate) pitch_acceleration_.add(*s.pitch_rate);
  for (const Leg leg : kLegs) add_known(slip_, s.slip[leg]);
  if (s.position_error) position_error_.add(s.position_error->norm());
  add_known(yaw_error_, s.yaw_error);
}

void MotionMetrics::add_com(const Vec2& p, const Vec2& v) {
  const double distance = (p - commanded_.point).norm();
  distance_.add(distance);
  distance_quantiles_.add(distance);
  circle_.add(p);
  cloud_.add(p);
  com_range_[0].add(p.x());
  com_range_[1].add(p.y());
  com_range_[2].add(v.x());
  com_range_[3].add(v.y());
}

void MotionMetrics::add_path(const Vec2& p, double reference_arc_length) {
  constexpr double kWindow = 0.3;  // m, about the last nearest point: stays on its branch
  if (!commanded_.path) return;
  nearest_ = commanded_.path->nearest(p, nearest_, kWindow);
  cross_track_.add((p - commanded_.path->at(nearest_).p).norm());
  along_track_.add(std::abs(nearest_ - reference_arc_length));
}

ComMetrics MotionMetrics::com() const {
  ComMetrics com;
  if (count_ == 0) return com;
  if (commanded_.v_H.isZero(0.0)) {
    com.distance_to_point_mean_mm = scaled(distance_.mean(), kMillimetres);
    com.distance_to_point_max_mm = scaled(distance_quantiles_.largest(), kMillimetres);
    com.distance_to_point_p95_mm = scaled(distance_quantiles_.quantile(0.95), kMillimetres);
  }
  const bool varies = distance_.count() >= kLeastSamples;
  if (const auto radius = cloud_.distances(circle_.mean())) {
    com.radius_mean_mm = radius->mean * kMillimetres;
    com.radius_max_mm = radius->largest * kMillimetres;
    if (varies) com.radius_variance_mm2 = scaled(radius->variance, kMillimetres2);
  }
  const std::optional<Circle> circle = circle_.circle();
  if (circle && varies && goes_around(*circle, circle_.mean())) {
    if (const auto radius = cloud_.distances(circle->centre)) {
      com.circle_radius_mm = radius->mean * kMillimetres;
      com.circle_variance_mm2 = scaled(radius->variance, kMillimetres2);
    }
    com.circle_centre_x_mm = (circle->centre.x() - commanded_.point.x()) * kMillimetres;
    com.circle_centre_y_mm = (circle->centre.y() - commanded_.point.y()) * kMillimetres;
  }
  com.peak_to_peak_x_mm = scaled(com_range_[0].mean(), kMillimetres);
  com.peak_to_peak_y_mm = scaled(com_range_[1].mean(), kMillimetres);
  com.velocity_range_x_mm_s = scaled(com_range_[2].mean(), kMillimetres);
  com.velocity_range_y_mm_s = scaled(com_range_[3].mean(), kMillimetres);
  if (const auto drift = turns_.drift_per_turn()) com.drift_per_turn_mm = drift->p * kMillimetres;
  com.distance_to_average_mean_mm = scaled(turns_.distance_to_average().mean(), kMillimetres);
  if (commanded_.hold_heading) return com;
  const Vec2 bias = v_H_sum_ / static_cast<double>(count_) - commanded_.v_H;
  com.body_bias_mm_s = bias.norm() * kMillimetres;
  com.body_bias_x_mm_s = bias.x() * kMillimetres;
  com.body_bias_y_mm_s = bias.y() * kMillimetres;
  const double angle = std::abs(turns_.turned());
  if (angle >= kPi) com.bias_circle_mm = *com.body_bias_mm_s * duration() / angle;
  return com;
}

PathMetrics MotionMetrics::path() const {
  PathMetrics path;
  path.cross_track_mean_mm = scaled(cross_track_.moments.mean(), kMillimetres);
  if (path.cross_track_mean_mm) path.cross_track_max_mm = cross_track_.largest * kMillimetres;
  path.along_track_mean_mm = scaled(along_track_.mean(), kMillimetres);
  return path;
}

AttitudeMetrics MotionMetrics::attitude() const {
  AttitudeMetrics out;
  out.roll_mean = roll_.mean();
  out.roll_variance = variance_of(roll_);
  out.pitch_mean = pitch_.mean();
  out.pitch_variance = variance_of(pitch_);
  out.roll_range = roll_range_.mean();
  out.pitch_range = pitch_range_.mean();
  out.relative_roll_mean = relative_roll_.mean();
  out.relative_roll_variance = variance_of(relative_roll_);
  out.relative_pitch_mean = relative_pitch_.mean();
  out.relative_pitch_variance = variance_of(relative_pitch_);
  return out;
}

EstimatorMetrics MotionMetrics::estimator() const {
  EstimatorMetrics out;
  out.position_error_mm = scaled(position_error_.mean(), kMillimetres);
  out.yaw_error_rad = yaw_error_.mean();
  const auto drift = turns_.drift_per_turn();
  if (drift && out.position_error_mm) out.position_drift_per_turn_mm = drift->error * kMillimetres;
  return out;
}

Metrics MotionMetrics::result() const {
  constexpr double kLeastAngle = 0.1;  // rad; the trunk's sway in yaw is some percent of it
  Metrics m;
  if (count_ > 1) {
    const double angle = turns_.turned();
    m.turns_done = angle / (2.0 * kPi) * (commanded_.yaw_rate < 0.0 ? -1.0 : 1.0);
    m.yaw_rate_mean = angle / duration();
    if (std::abs(commanded_.yaw_rate) * duration() >= kLeastAngle) {
      m.yaw_rate_error = *m.yaw_rate_mean / commanded_.yaw_rate - 1.0;
    }
  }
  m.com = com();
  m.path = path();
  m.attitude = attitude();
  m.acceleration = {variance_of(x_acceleration_.moments()), variance_of(y_acceleration_.moments()),
                    variance_of(roll_acceleration_.moments()),
                    variance_of(pitch_acceleration_.moments())};
  m.contact.slip_mean_mm_s = scaled(slip_.mean(), kMillimetres);
  m.estimator = estimator();
  return m;
}

void TickTimes::add(double tick_us, double mpc_us, double wbc_us) {
  tick_.add(tick_us);
  if (mpc_us > 0.0) mpc_.add(mpc_us);
  if (wbc_us > 0.0) wbc_.add(wbc_us);
}

TimingMetrics TickTimes::result() const {
  TimingMetrics timing;
  timing.tick_us_median = tick_.quantile(0.5);
  timing.tick_us_p99 = tick_.quantile(0.99);
  timing.tick_us_max = tick_.largest();
  timing.mpc_us_median = mpc_.quantile(0.5);
  timing.wbc_us_median = wbc_.quantile(0.5);
  return timing;
}

}  // namespace pirouette
