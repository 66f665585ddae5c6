// Reference of the CoM: position, heading and velocity at each moment of a motion command.
#pragma once

#include <optional>

#include "pirouette/base/math.hpp"
#include "pirouette/path/path.hpp"
#include "pirouette/path/path_config.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

/// Integrates the commanded twist, ramped, or follows a path at the ramped speed. Both begin at an
/// anchor: the command's point and heading, else the robot's when walking begins. A changed point
/// or heading anchors again. The reference waits for a robot that cannot keep up: it advances only
/// while its yaw is less than max_yaw_lead ahead and, on a path, its arc length less than
/// max_path_lead, so position and heading stay on the same path. A yaw error that is larger at the
/// start (up to 180 degrees, the short way round) may shrink but not grow. At rest the reference
/// stays where walking ended.
class PathReference {
 public:
  explicit PathReference(const PathConfig& config) : config_(config) {}  ///< not anchored, no path

  /// Follows `path` (absent: the twist) from the next update that walks. A path begins at the
  /// anchor; with a commanded point the robot joins it at the nearest point. The reference slows
  /// down towards the end of an open path and stays there.
  void follow(std::optional<Path> path);

  bool follows_path() const noexcept { return path_.has_value(); }  ///< a path is set

  /// Reference after one tick of `dt` (s).
  PathPoint update(const MotionCommand& command, const RobotState& state, double dt) noexcept;

  /// The next update anchors at the robot. The path stays.
  void reset() noexcept;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, path, arc_length, robot_arc_length, travel_direction, anchored, walking,
           command_point, command_heading, twist, p_WG, yaw, yaw_gap_limit] = self;
    visit(path, arc_length, robot_arc_length, travel_direction, anchored, walking, command_point,
          command_heading, twist, p_WG, yaw, yaw_gap_limit);
  }

 private:
  void anchor(const Vec2& p_WG, double yaw, const RobotState& state) noexcept;
  void anchor_when_due(const MotionCommand& command, const RobotState& state) noexcept;
  void start_path(const MotionCommand& command, const RobotState& state) noexcept;
  void ramp_twist(const MotionCommand& command, double dt) noexcept;
  /// Puts the reference's yaw on the branch nearest to the robot's; returns how far it is ahead.
  double yaw_gap(const RobotState& state) noexcept;
  /// Share of `yaw_step` that the path may advance while its yaw is `yaw_gap` ahead of the robot.
  double pace_for(double yaw_gap, double yaw_step) noexcept;
  PathPoint follow_twist(const RobotState& state, double dt) noexcept;
  PathPoint follow_path(const MotionCommand& command, const RobotState& state, double dt) noexcept;
  /// The set-point as far from the robot as the mode allows.
  Vec2 kept_near(const Vec2& com) const noexcept;
  /// The present set-point with its velocity (m/s, world axes).
  PathPoint point_with(const Vec2& v_W, double yaw_rate, const RobotState& state) const noexcept;

  PathConfig config_;
  std::optional<Path> path_;
  double arc_length_ = 0.0;        ///< m, of the set-point
  double robot_arc_length_ = 0.0;  ///< m, of the path's point nearest to the robot
  double travel_direction_ = 0.0;  ///< rad, of the path from the body's front
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
