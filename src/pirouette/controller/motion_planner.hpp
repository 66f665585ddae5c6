// Path reference and tracker, on odometry corrected by the position aid.
#pragma once

#include "pirouette/path/path_config.hpp"
#include "pirouette/path/path_reference.hpp"
#include "pirouette/path/position_aid.hpp"
#include "pirouette/path/tracker.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Input of MotionPlanner::update(), all of this tick.
struct MotionPlannerInput {
  const MotionCommand& command;           ///< what the user asks of the robot
  const RobotState& state;                ///< estimated state of the robot
  const std::optional<PositionAid>& aid;  ///< absent: no measurement in this tick
};

/// Output of MotionPlanner::update().
struct MotionPlan {
  Vec2 aid_offset = Vec2::Zero();  ///< m, from the odometry's position to the aid's
  PathPoint path;                  ///< path reference
  TwistCommand twist;              ///< the tracker's velocity command
  Vec2 integral_H = Vec2::Zero();  ///< m/s, the tracker's body-frame integrator
};

/// Computes reference and velocity command of the CoM.
class MotionPlanner {
 public:
  /// `control_rate` (Hz) is the rate of calls of update().
  MotionPlanner(const PathConfig& path, const AidConfig& aid, double control_rate)
      : aid_offset_(aid), path_reference_(path), tracker_(path, control_rate) {}

  /// Plan after one tick of `dt` (s).
  MotionPlan update(const MotionPlannerInput& in, double dt) noexcept;

  /// See PathReference::follow.
  void follow(std::optional<Path> path) { path_reference_.follow(std::move(path)); }
  bool follows_path() const noexcept { return path_reference_.follows_path(); }  ///< a path is set
  /// Discards all memory but the path.
  void reset() noexcept;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [aid_offset, path_reference, tracker] = self;
    visit(aid_offset, path_reference, tracker);
  }

 private:
  PositionAidOffset aid_offset_;
  PathReference path_reference_;
  Tracker tracker_;
};

}  // namespace pirouette
