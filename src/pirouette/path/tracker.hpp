// Velocity command that brings the robot to the path reference and keeps it there.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/path/path_config.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

/// none: the reference's own twist. lqr: plus LQR feedback on position and yaw. lqi: plus an
/// integrator of the position error whose value turns with the body, because the velocity bias of a
/// spinning robot is fixed to its body: a world-fixed law only shrinks the circle that it draws.
class Tracker {
 public:
  /// `control_rate` (Hz) is the rate of calls of update().
  Tracker(const PathConfig& config, double control_rate);

  /// Velocity command after one tick of `dt` (s).
  TwistCommand update(const PathPoint& reference, const RobotState& state, double dt) noexcept;
  void reset() noexcept;  ///< no corrections

  /// Velocity (m/s) that the integrator commands, heading axes.
  Vec2 integral_H() const { return integral_H_; }
  /// Current LQR gain: correction (vx, vy, yaw rate) per error (x, y, yaw), reference heading axes.
  const Mat3& gain() const { return gain_; }

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, control_period, gain_yaw_rate, gain, integral_H, correction_H,
           yaw_rate_correction] = self;
    visit(gain_yaw_rate, gain, integral_H, correction_H, yaw_rate_correction);
  }

 private:
  void solve_gain(double yaw_rate) noexcept;
  void integrate(const Vec2& e_H, const Vec2& proportional_H, double dt) noexcept;

  PathConfig config_;
  double control_period_;
  double gain_yaw_rate_ = 0.0;
  Mat3 gain_ = Mat3::Zero();
  Vec2 integral_H_ = Vec2::Zero();
  Vec2 correction_H_ = Vec2::Zero();
  double yaw_rate_correction_ = 0.0;
};

}  // namespace pirouette
