// True state of the simulation, for metrics, pictures and studies; the controller never sees it.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// True state at one moment.
struct PlantTruth {
  double time = 0.0;           ///< s, simulated
  BaseTruth base;              ///< pose and velocity of the trunk frame
  Vec3 a_WB_W = Vec3::Zero();  ///< m/s^2, trunk origin, world axes, gravity taken out (0 at rest)
  Vec3 p_WG = Vec3::Zero();    ///< m, whole-body CoM
  Vec3 v_WG_W = Vec3::Zero();  ///< m/s
  PerLeg<Vec3> joint_position{};  ///< rad
  PerLeg<Vec3> joint_velocity{};  ///< rad/s
  PerLeg<Vec3> joint_torque{};    ///< N m, applied by the motors
  PerLeg<Vec3> p_WF{};            ///< m, sphere centres
  PerLeg<Vec3> f_W{};             ///< N, ground reaction on each foot, world axes
  PerLeg<Vec3>
      v_slip_W{};  ///< m/s, velocity of the foot's material point at the contact; 0 in the air
  PerLeg<bool> contact{};                ///< the foot touches the ground
  double ground_height = 0.0;            ///< m, of the terrain below the CoM
  Vec3 ground_normal_W = Vec3::UnitZ();  ///< unit normal of the terrain's overall slope
};

}  // namespace pirouette
