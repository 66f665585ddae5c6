// Indices of a quadruped's trunk, joints and feet in a compiled MuJoCo model.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <string>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"

namespace pirouette {

/// Indices of one leg in an mjModel; arrays in the order abad, hip, knee.
struct LegMap {
  std::array<int, kJointsPerLeg> joint{};  ///< joint ids
  std::array<int, kJointsPerLeg> qpos{};   ///< addresses in mjData::qpos
  std::array<int, kJointsPerLeg> dof{};    ///< addresses in mjData::qvel
  std::array<int, kJointsPerLeg> body{};   ///< bodies that the joints move: abad link, thigh, shank
  int foot_geom = -1;                      ///< the foot sphere
  double knee_sign = -1.0;      ///< sign of the knee angle: -1 knees backward, +1 forward
  Vec3 tau_max = Vec3::Zero();  ///< N m
};

/// Indices of a quadruped in an mjModel.
struct RobotMap {
  int trunk_body = -1;  ///< body with the free joint
  int trunk_qpos = -1;  ///< address of the free joint's position and quaternion
  int trunk_dof = -1;   ///< address of its 6 velocities
  PerLeg<LegMap> legs{};
};

/// N m, limit of a motor for which the robot file gives none.
inline constexpr double kNoTorqueLimit = 1e3;

/// Finds the robot in `model` by the names of its joints; errors call the model `file`.
///
/// A leg's joints are the three hinges whose names begin with FR, FL, RR or RL (upper or lower
/// case) below the body with the free joint; along the chain they are abad (about +x), hip and knee
/// (about +y, at q = 0). Its foot is the colliding sphere fixed to the shank: the one named with
/// the leg's prefix or, without such a name, the lowest. A torque limit is the joint's
/// actuatorfrcrange or else its motor's forcerange or ctrlrange. The knee's sign is that of its
/// range or, if the knee bends both ways, of the first keyframe, else -1. Every leg is checked;
/// what was not found comes back as errors, the first of which lists all joints of the file.
Result<RobotMap> map_robot(const mjModel& model, const std::string& file);

}  // namespace pirouette
