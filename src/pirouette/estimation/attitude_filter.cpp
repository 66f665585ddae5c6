#include "pirouette/estimation/attitude_filter.hpp"

#include <Eigen/Cholesky>

#include "pirouette/base/rotation.hpp"

namespace pirouette {

namespace {
constexpr double kMaxSpecificForce =
    3.0;  // g, above which a reading is an impact and not taken at its size
// Of a rest that tells the gyro's bias:
constexpr double kSettleTime = 0.1;      // s, in which a robot that was put down comes to rest
constexpr double kMinRest = 0.5;         // s, for which it has to last
constexpr double kManyDeviations = 6.0;  // from the prior, by which it does
constexpr double kMaxGyroBias = 0.1;     // rad/s, a turn above
constexpr double kMaxTurnScatter =
    2e-3;  // rad, about the line; encoders with 1e-3 rad of noise: 1.1e-3
constexpr double kMaxGravityTurn = 0.03;  // rad/s, many times what noise makes of 0.5 s
}  // namespace

Vec3 turn_over_feet(const PerLeg<Vec3>& before, const PerLeg<Vec3>& now) {
  Vec3 centre = Vec3::Zero(), shift = Vec3::Zero();
  for (const Leg leg : kLegs) {
    centre += before[leg] / kLegCount;
    shift += (now[leg] - before[leg]) / kLegCount;
  }
  Mat3 spread = Mat3::Zero();
  Vec3 moment = Vec3::Zero();
  for (const Leg leg : kLegs) {
    const Vec3 arm = before[leg] - centre;
    spread += arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
    moment += arm.cross(now[leg] - before[leg] - shift);
  }
  return -spread.ldlt().solve(moment);
}

void AttitudeFilter::Line::add(double time, const Vec3& x) noexcept {
  samples += 1.0;
  sum_t += time;
  sum_tt += square(time);
  sum_x += x;
  sum_tx += time * x;
  sum_xx += x.cwiseAbs2();
}

double AttitudeFilter::Line::spread() const noexcept { return samples * sum_tt - square(sum_t); }

Vec3 AttitudeFilter::Line::slope() const noexcept {
  return (samples * sum_tx - sum_t * sum_x) / spread();
}

double AttitudeFilter::Line::variance() const noexcept {
  const double all = (samples * sum_xx - sum_x.cwiseAbs2()).sum();
  return (all - spread() * slope().squaredNorm()) / square(samples);
}

void AttitudeFilter::record_rest(const AttitudeInput& in, double dt) noexcept {
  if (rest_.time == 0.0) {
    rest_.p_BF = in.p_BF;
    rest_.bias_before = gyro_bias_;
  } else if (!in.turns_on_purpose) {
    rest_.sum_change2 += (in.w_WB_B - rest_.last_w_WB_B).squaredNorm();
  }
  rest_.last_w_WB_B = in.w_WB_B;
  rest_.time += dt;
  rest_.turn_by_gyro += dt * in.w_WB_B;
  // Feet that roll under a turning trunk are no measure of a bias; before and after they are.
  if (in.turns_on_purpose) return;
  rest_.added.add(rest_.time, rest_.turn_by_gyro - turn_over_feet(rest_.p_BF, in.p_BF));
  if (rest_.time > kSettleTime) rest_.specific_force_B.add(rest_.time, in.specific_force_B);
}

/// The ground turns under the robot, or somebody carries both.
bool AttitudeFilter::is_turned() const noexcept {
  const Vec3 by_gyro_B = rest_.added.slope();
  const Vec3 up_B = rest_.specific_force_B.sum_x.normalized();
  // Across the vertical, where gravity shows a turn as well.
  const Vec3 across_B = by_gyro_B - up_B.dot(by_gyro_B) * up_B;
  const Vec3 by_gravity_B = rest_.specific_force_B.slope().cross(up_B) / kGravity;
  const bool tilts =
      across_B.norm() > kMaxGravityTurn && (by_gravity_B - across_B).norm() < 0.5 * across_B.norm();
  // The integral of the noise leaves the line by the square root of the time.
  const double scatter2 = square(kMaxTurnScatter) * (1.0 + rest_.time / kMinRest);
  return tilts || rest_.added.variance() > scatter2 || by_gyro_B.norm() > kMaxGyroBias;
}

/// `measured`: rad/s. The gyro's noise is that of its readings' changes; the slope of its integral
/// over n readings has 6/5 of its variance over n. To it comes what the encoders' noise about the
/// line makes of the slope.
bool AttitudeFilter::contradicts_prior(const Vec3& measured) const noexcept {
  const double n = rest_.added.samples;
  const double noise2 = rest_.sum_change2 / (2.0 * 3.0 * (n - 1.0));
  const double readings = rest_.time / period_;
  const double deviation2 = square(config_.gyro_bias_prior) + 1.2 * noise2 / readings +
                            n * rest_.added.variance() / (3.0 * rest_.added.spread());
  return (measured - rest_.bias_before).squaredNorm() > square(kManyDeviations) * deviation2;
}

void AttitudeFilter::calibrate(const AttitudeInput& in, double dt) noexcept {
  record_rest(in, dt);
  if (in.turns_on_purpose || rest_.added.spread() <= 0.0) return;
  const Vec3 slope = rest_.added.slope();
  if (rest_.time >= kMinRest) {
    if (is_turned()) {
      turned_ = true;
      gyro_bias_ = rest_.bias_before;
      rest_ = Rest{};
      return;
    }
    turned_ = false;
  }
  if (turned_) return;
  if (!bias_known_ && !rest_.overrules_prior && rest_.time > kSettleTime &&
      contradicts_prior(slope)) {
    rest_.overrules_prior = true;
    // Until now the attitude has turned by what was the bias.
    q_WB_ = q_WB_ * Quat(exp_so3(rest_.turn_by_bias - (rest_.time - dt) * slope));
  }
  // Shrunk to what was known before (nothing: no bias) while there are few samples.
  const double share =
      rest_.overrules_prior ? 1.0 : rest_.time / (rest_.time + config_.gyro_rest_time);
  gyro_bias_ = rest_.bias_before + share * (slope - rest_.bias_before);
}

Attitude AttitudeFilter::update(const AttitudeInput& in, double dt) noexcept {
  if (in.at_rest) {
    calibrate(in, dt);
    rest_.turn_by_bias += dt * gyro_bias_;
  } else {
    bias_known_ = bias_known_ || rest_.time >= kMinRest;
    rest_ = Rest{};
  }
  const Vec3 w_WB_B = in.w_WB_B - gyro_bias_;
  const Mat3 R_WB = q_WB_.toRotationMatrix();

  const Vec3 a_turn_B = w_WB_B.cross(R_WB.transpose() * in.v_WB_W);
  const Vec3 up_measured_B = in.specific_force_B - a_turn_B;
  // Linear in the reading: the gait's accelerations average to zero, which their directions would
  // not.
  const Vec3 up_B = R_WB.row(2).transpose();
  const Vec3 tilt_error_B = clamp_norm<3>(up_measured_B / kGravity, kMaxSpecificForce).cross(up_B);
  if (!in.at_rest) {
    gyro_bias_ -=
        dt / (config_.attitude_time_constant * config_.gyro_bias_time_constant) * tilt_error_B;
  }
  const Vec3 correction = tilt_error_B / config_.attitude_time_constant;
  const Vec3 turn = dt * (w_WB_B + correction);
  q_WB_ = (q_WB_ * Quat(exp_so3(turn))).normalized();
  return {q_WB_.toRotationMatrix(), w_WB_B};
}

void AttitudeFilter::reset(const Mat3& R_WB) {
  q_WB_ = Quat(R_WB).normalized();
  gyro_bias_.setZero();
  bias_known_ = turned_ = false;
  rest_ = Rest{};
}

}  // namespace pirouette
