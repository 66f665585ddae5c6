// Pose of the robot when the simulation begins.
#pragma once

#include <mujoco/mujoco.h>

#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_map.hpp"
#include "pirouette/plant/terrain.hpp"

namespace pirouette {

/// Writes a standing pose into data.qpos: the trunk parallel to the terrain's overall slope and
/// heading `yaw`, the CoM over `xy` and `com_height` above the ground along gravity, each foot
/// sphere vertically below its hip and just touching; at an edge, within a few millimetres of it.
/// On uneven ground `com_height` is above the mean of the four feet. Returns an error for
/// each leg that cannot reach; empty: none.
Errors stand_robot(const mjModel& model, const RobotMap& map, const Terrain& terrain,
                   const Vec2& xy, double yaw, double com_height, mjData& data);

}  // namespace pirouette
