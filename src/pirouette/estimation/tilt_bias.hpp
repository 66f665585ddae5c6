// Part of the attitude error that turns with the trunk: docs/terrain.md#tilt-bias.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// An accelerometer's bias tilts the estimated attitude by a rotation fixed in the body. The ground
/// under a turning robot then seems to have a slope a = a0 + R(yaw) b: a0 is constant, b turns with
/// the robot. Least squares over the last turns separates them, with A = E[a], B = E[R^T a], M =
/// E[R]:
///   b = (B - M^T A) / (1 - |M|^2),
/// which needs a large part of a turn; before that it is shrunk towards 0.
class TiltBias {
 public:
  /// `averaging_time` (s); 0: the estimate is always zero.
  explicit TiltBias(double averaging_time) : averaging_time_(averaging_time) {}

  /// Adds one tick of `dt` (s). `slope`: gradient of the ground by the uncorrected attitude, world
  /// axes; `yaw` (rad).
  void update(const Vec2& slope, double yaw, double dt) noexcept;

  /// Estimated gradient b, heading axes.
  Vec2 slope_H() const noexcept;

  /// Attitude error (rad, body axes, small): R_true = R_estimated * exp(-rotation_B()).
  Vec3 rotation_B() const noexcept;

  void reset() noexcept { *this = TiltBias(averaging_time_); }  ///< the estimate is zero

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [averaging_time, mean_slope, mean_slope_H, mean_turn, weight] = self;
    visit(mean_slope, mean_slope_H, mean_turn, weight);
  }

 private:
  double averaging_time_;
  Vec2 mean_slope_ = Vec2::Zero();    ///< A
  Vec2 mean_slope_H_ = Vec2::Zero();  ///< B
  Vec2 mean_turn_ = Vec2::Zero();     ///< cosine and sine part of M
  double weight_ = 0.0;               ///< of the data; the rest is the prior
};

}  // namespace pirouette
