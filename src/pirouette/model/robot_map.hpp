// Indices of a quadruped's trunk, joints and feet in a compiled MuJoCo model.
#pragma once

#include <mujoco/mujoco.h>

#include <array>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_description.hpp"
#include "pirouette/types/joint_convention.hpp"

namespace pirouette {

/// Indices of one leg in an mjModel; arrays and vectors in the order abad, hip, knee.
struct LegMap {
  std::array<int, kJointsPerLeg> joint{};  ///< joint ids
  std::array<int, kJointsPerLeg> qpos{};   ///< addresses in mjData::qpos
  std::array<int, kJointsPerLeg> dof{};    ///< addresses in mjData::qvel
  std::array<int, kJointsPerLeg> body{};   ///< bodies that the joints move: abad link, thigh, shank
  int foot_geom = -1;                      ///< the foot sphere
  double knee_sign = -1.0;      ///< sign of the knee angle: -1 knees backward, +1 forward
  Vec3 tau_max = Vec3::Zero();  ///< N m
  JointConvention convention;   ///< of the file's joints
};

/// Indices of a quadruped in an mjModel.
struct RobotMap {
  int trunk_body = -1;  ///< body with the free joint
  int trunk_qpos = -1;  ///< address of the free joint's position and quaternion
  int trunk_dof = -1;   ///< address of its 6 velocities
  PerLeg<LegMap> legs{};
};

/// Finds the robot of a complete `description` (of read_robot) in `model`, which was compiled from
/// its specification; other things may be in the model too. The errors name constraints that tie
/// the robot to the world or one of its legs to something.
Result<RobotMap> map_robot(const mjModel& model, const RobotDescription& description);

}  // namespace pirouette
