// What the user asks of the robot.
#pragma once

#include <optional>

#include "pirouette/base/math.hpp"

namespace pirouette {

/// A planar twist of the CoM in heading axes. Zero velocity and a yaw rate: a spin. Zero twist with
/// `walk`: trotting on the spot. The signed turning radius is velocity.x / yaw_rate.
struct MotionCommand {
  bool walk = false;          ///< false: stand on four feet
  Vec2 v_H = Vec2::Zero();    ///< m/s, in heading axes
  double yaw_rate = 0.0;      ///< rad/s
  std::optional<Vec2> point;  ///< m, world: where the reference starts; absent: where the CoM
                              ///< stands when walking begins
  std::optional<double>
      heading;  ///< rad, world: heading of the reference at its start; absent: the robot's own
  /// On a path (SpinController::follow) the length of v_H is the speed along the path and the
  /// direction of v_H is that of the path in the body; yaw_rate is ignored. True: the body keeps
  /// its heading; false: it turns with the path.
  bool hold_heading = false;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [walk, v_H, yaw_rate, point, heading, hold_heading] = self;
    visit(walk, v_H, yaw_rate, point, heading, hold_heading);
  }
};

}  // namespace pirouette
