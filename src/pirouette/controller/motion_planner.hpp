// What the trunk is to do: path reference and tracker, both on the odometry that a position aid
// corrects.
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

/// All of this tick.
struct MotionPlannerInput {
  const MotionCommand& command;
  const RobotState& state;
  const std::optional<PositionAid>& aid;
};

struct MotionPlan {
  Vec2 aid_offset = Vec2::Zero();  ///< m, from the odometry's position to the aid's
  PathPoint path;
  TwistCommand twist;
  Vec2 integral_H = Vec2::Zero();  ///< m/s, the tracker's body-frame integrator
};

class MotionPlanner {
 public:
  /// `control_rate` (Hz) is the rate at which update() will be called.
  MotionPlanner(const PathConfig& path, const AidConfig& aid, double control_rate)
      : aid_offset_(aid), path_reference_(path), tracker_(path, control_rate) {}

  MotionPlan update(const MotionPlannerInput& in, double dt) noexcept;

  /// See PathReference::follow.
  void follow(std::optional<Path> path) { path_reference_.follow(std::move(path)); }
  bool follows_path() const noexcept { return path_reference_.follows_path(); }
  /// The path stays.
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
