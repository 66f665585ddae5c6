// Attitude from gyro and accelerometer.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/config/config.hpp"

namespace pirouette {

struct AttitudeInput {
  Vec3 w_WB_B = Vec3::Zero();            ///< rad/s, gyro
  Vec3 specific_force_B = Vec3::Zero();  ///< m/s^2, accelerometer
  Vec3 v_WB_W = Vec3::Zero();            ///< m/s, last velocity estimate of the trunk origin
  bool at_rest = false;                  ///< the robot stands still: the gyro's mean is its bias
};

struct Attitude {
  Mat3 R_WB = Mat3::Identity();
  Vec3 w_WB_B = Vec3::Zero();  ///< rad/s, gyro without its estimated bias
};

/// Complementary filter on SO(3): the gyro is integrated, gravity slowly corrects roll and pitch,
/// and what gravity keeps correcting is gyro bias. Yaw is the gyro's integral: nothing else on
/// board observes it.
///
/// The accelerometer measures gravity plus the trunk's own acceleration. In a steady turn the
/// latter is omega x v for every point of the body, which is subtracted; the gait's part averages
/// out over the filter's time constant. An accelerometer bias becomes a tilt error of bias / g.
class AttitudeFilter {
 public:
  explicit AttitudeFilter(const EstimationConfig& config) : config_(config) {}

  Attitude update(const AttitudeInput& in, double dt) noexcept;
  void reset(const Mat3& R_WB);
  const Vec3& gyro_bias() const { return gyro_bias_; }

 private:
  EstimationConfig config_;
  Quat q_WB_ = Quat::Identity();
  Vec3 gyro_bias_ = Vec3::Zero();
  Vec3 rest_sum_ = Vec3::Zero();
  int rest_count_ = 0;
};

}  // namespace pirouette
