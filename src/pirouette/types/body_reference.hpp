// Reference of the body: from path, tracker, terrain and CoM planner to MPC and whole-body control.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {

/// Path reference of one tick: where the CoM is to be.
struct PathPoint {
  Vec2 p_WG = Vec2::Zero();  ///< m
  double yaw = 0.0;          ///< rad, unwrapped
  Vec2 v_H = Vec2::Zero();   ///< m/s, feed-forward velocity in the reference's heading axes
  double yaw_rate = 0.0;     ///< rad/s
  double arc_length = 0.0;   ///< m, length of the path from its start
};

/// The tracker's velocity command, in the robot's heading axes.
struct TwistCommand {
  Vec2 v_H = Vec2::Zero();  ///< m/s
  double yaw_rate = 0.0;    ///< rad/s
};

/// Reference of CoM and trunk.
struct BodyReference {
  Vec3 p_WG = Vec3::Zero();    ///< m, CoM
  Vec3 v_WG_W = Vec3::Zero();  ///< m/s, world axes
  Vec3 a_WG_W = Vec3::Zero();  ///< m/s^2, world axes
  RollPitchYaw rpy;            ///< rad, parallel to the terrain; yaw unwrapped
  Vec3 w_WB_W = Vec3::Zero();  ///< rad/s, world axes, matching roll and pitch on a slope (E16)
  TwistCommand twist;          ///< continues the reference over the MPC's horizon
};

}  // namespace pirouette
