// The estimator's output: where the robot is, as far as its sensors can tell.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {

/// G is the whole-body centre of mass; F a foot's sphere centre; B the trunk frame; W the world.
struct RobotState {
  double time = 0.0;           ///< s
  Vec3 p_WB = Vec3::Zero();    ///< m
  Vec3 v_WB_W = Vec3::Zero();  ///< m/s, world axes
  Mat3 R_WB = Mat3::Identity();
  RollPitchYaw rpy;               ///< rad; yaw is unwrapped
  Vec3 w_WB_B = Vec3::Zero();     ///< rad/s, body axes
  PerLeg<Vec3> joint_position{};  ///< rad
  PerLeg<Vec3> joint_velocity{};  ///< rad/s
  Vec3 p_WG = Vec3::Zero();       ///< m, centre of mass
  Vec3 v_WG_W = Vec3::Zero();     ///< m/s, world axes
  PerLeg<Vec3> p_WF{};            ///< m, sphere centres
  PerLeg<Vec3> v_WF_W{};          ///< m/s, world axes

  Vec3 w_WB_W() const { return R_WB * w_WB_B; }
};

}  // namespace pirouette
