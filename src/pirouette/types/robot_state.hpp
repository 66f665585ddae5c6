// Estimated state of the robot.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {

/// Output of the estimator. G is the CoM of the whole robot; F the centre of a foot sphere; B the
/// trunk frame; W the world.
struct RobotState {
  double time = 0.0;              ///< s, of the sensor reading
  Vec3 p_WB = Vec3::Zero();       ///< m, trunk origin
  Vec3 v_WB_W = Vec3::Zero();     ///< m/s, trunk origin, world axes
  Mat3 R_WB = Mat3::Identity();   ///< trunk axes in world axes
  RollPitchYaw rpy;               ///< rad, of R_WB; yaw unwrapped
  Vec3 w_WB_B = Vec3::Zero();     ///< rad/s, body axes
  PerLeg<Vec3> joint_position{};  ///< rad
  PerLeg<Vec3> joint_velocity{};  ///< rad/s
  Vec3 p_WG = Vec3::Zero();       ///< m, centre of mass
  Vec3 v_WG_W = Vec3::Zero();     ///< m/s, world axes
  PerLeg<Vec3> p_WF{};            ///< m, sphere centres
  PerLeg<Vec3> v_WF_W{};          ///< m/s, world axes

  /// rad/s, world axes.
  Vec3 w_WB_W() const { return R_WB * w_WB_B; }
};

}  // namespace pirouette
