// Where the CoM should be and where it should look, at each moment of a motion command.
#pragma once

#include <optional>

#include "pirouette/base/math.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

/// The commanded twist, ramped and integrated exactly from an anchor: the command's point and
/// heading, or else where the robot stands when walking begins. A changed point or heading anchors
/// again. The reference waits for a robot that cannot keep up: it advances along its path only
/// while its yaw is less than max_yaw_lead ahead, so position and heading stay on the same path. An
/// error that is larger at the start (up to 180 degrees, the short way round) may shrink but not
/// grow. At rest the reference stays where walking ended.
class PathReference {
 public:
  explicit PathReference(const PathConfig& config) : config_(config) {}

  PathPoint update(const MotionCommand& command, const RobotState& state, double dt) noexcept;

  /// The next update anchors at the robot.
  void reset() noexcept;

 private:
  void anchor(const Vec2& p_WG, double yaw, const RobotState& state) noexcept;
  void anchor_when_due(const MotionCommand& command, const RobotState& state) noexcept;
  void ramp_twist(const MotionCommand& command, double dt) noexcept;
  /// Share of `yaw_step` that the path may advance while its yaw is `yaw_gap` ahead of the robot.
  double pace_for(double yaw_gap, double yaw_step) noexcept;
  /// Moves the set-point along; returns the share of the commanded speed at which it went.
  double advance(const RobotState& state, double dt) noexcept;

  PathConfig config_;
  bool anchored_ = false;
  bool walking_ = false;
  std::optional<Vec2> command_point_;
  std::optional<double> command_heading_;
  TwistCommand twist_;          ///< ramped command
  Vec2 p_WG_ = Vec2::Zero();    ///< m, set-point
  double yaw_ = 0.0;            ///< rad, of the path; same branch as the robot's yaw
  double yaw_gap_limit_ = 0.0;  ///< rad, how far the path's yaw may be ahead
};

}  // namespace pirouette
