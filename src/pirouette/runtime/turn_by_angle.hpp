// Turning by an angle and stopping there.
#pragma once

#include <algorithm>
#include <cmath>

#include "pirouette/types/motion_command.hpp"

namespace pirouette {

/// Motion commands that turn a robot by an angle, tick by tick, from the estimated angle turned so
/// far: it turns at the commanded rate, brakes, corrects the remaining error and stands. For a
/// MotionSource.
class TurnByAngle {
 public:
  static constexpr double kTolerance = 0.01;    ///< rad, within which the turn is done
  static constexpr double kSteadyTime = 0.5;    ///< s, for which it has to stay there
  static constexpr double kApproachTime = 0.5;  ///< s, time constant of the last approach

  /// `angle`: rad, positive to the left, also more than a turn. `motion`: to the left or right at
  /// its yaw rate (rad/s, not 0), whichever direction the angle asks for; its velocity keeps the
  /// radius, so that the other direction is walked backwards. `deceleration`: rad/s^2.
  TurnByAngle(double angle, const MotionCommand& motion, double deceleration)
      : angle_(angle), motion_(motion), deceleration_(deceleration) {}

  /// The command of this tick; `turned`: rad since the first one, as estimated; `dt`: s.
  MotionCommand update(double turned, double dt) noexcept {
    const double left = angle_ - turned;
    steady_for_ = std::abs(left) < kTolerance ? steady_for_ + dt : 0.0;
    done_ = done_ || steady_for_ > kSteadyTime;
    if (done_) return MotionCommand{};
    const double braking = std::sqrt(2.0 * deceleration_ * std::abs(left));
    const double rate =
        std::min({std::abs(motion_.yaw_rate), braking, std::abs(left) / kApproachTime});
    const double share = std::copysign(rate, left) / motion_.yaw_rate;
    MotionCommand command = motion_;
    command.v_H *= share;
    command.yaw_rate *= share;
    return command;
  }

  bool done() const noexcept { return done_; }  ///< stands from now on

 private:
  double angle_;
  MotionCommand motion_;
  double deceleration_;
  double steady_for_ = 0.0;  ///< s
  bool done_ = false;
};

}  // namespace pirouette
