#include "pirouette/estimation/attitude_filter.hpp"

#include <Eigen/Cholesky>

#include "pirouette/base/rotation.hpp"

namespace pirouette {

namespace {
constexpr double kMaxSpecificForce =
    3.0;  // g, above which a reading is an impact and not taken at its size
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

void AttitudeFilter::calibrate(const AttitudeInput& in, double dt) noexcept {
  if (rest_.samples == 0.0) {
    rest_.p_BF = in.p_BF;
    rest_.bias_before = gyro_bias_;
  }
  rest_.samples += 1.0;
  rest_.time += dt;
  rest_.turn_by_gyro += dt * in.w_WB_B;
  const Vec3 added = rest_.turn_by_gyro - turn_over_feet(rest_.p_BF, in.p_BF);
  rest_.sum_t += rest_.time;
  rest_.sum_tt += square(rest_.time);
  rest_.sum_x += added;
  rest_.sum_tx += rest_.time * added;
  const double spread = rest_.samples * rest_.sum_tt - square(rest_.sum_t);
  if (spread <= 0.0) return;
  const Vec3 slope = (rest_.samples * rest_.sum_tx - rest_.sum_t * rest_.sum_x) / spread;
  // Shrunk to what was known before (nothing: no bias) while there are few samples.
  const double share = rest_.samples / (rest_.samples + prior_samples_);
  gyro_bias_ = rest_.bias_before + share * (slope - rest_.bias_before);
}

Attitude AttitudeFilter::update(const AttitudeInput& in, double dt) noexcept {
  if (in.at_rest) {
    calibrate(in, dt);
  } else {
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
  rest_ = Rest{};
}

}  // namespace pirouette
