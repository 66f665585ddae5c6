#include "pirouette/estimation/attitude_filter.hpp"

#include "pirouette/base/rotation.hpp"

namespace pirouette {

namespace {
constexpr double kMaxSpecificForce =
    3.0;  // g, above which a reading is an impact and not taken at its size
}  // namespace

Attitude AttitudeFilter::update(const AttitudeInput& in, double dt) noexcept {
  if (in.at_rest) {
    // Mean of the samples at rest, shrunk to the prior "no bias" while there are few of them.
    rest_sum_ += in.w_WB_B;
    ++rest_count_;
    gyro_bias_ = rest_sum_ / (rest_count_ + config_.gyro_rest_samples);
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
  rest_sum_.setZero();
  rest_count_ = 0;
}

}  // namespace pirouette
