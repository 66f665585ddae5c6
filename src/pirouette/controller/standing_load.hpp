// Whether a robot can carry itself: forces and torques of standing on two feet.
#pragma once

#include "pirouette/base/result.hpp"
#include "pirouette/controller/controller_config.hpp"
#include "pirouette/model/robot_model.hpp"

namespace pirouette {

/// A robot that stands with body.height on level ground, every foot below its hip.
struct StandingLoad {
  PerLeg<Vec3> q{};          ///< rad, joint angles of LegGeometry
  PerLeg<bool> reaches{};    ///< the foot reaches the ground
  PerLeg<Vec3> torque{};     ///< N m, of a leg that carries half the weight, as in a trot
  Vec3 p_BG = Vec3::Zero();  ///< m, CoM in trunk axes
};

/// The load of `robot` at `body_height` (m, of the CoM above the ground).
StandingLoad standing_load(RobotModel& robot, double body_height);

/// Why a robot cannot walk with `config`, each with the number that says so: a foot that does not
/// reach the ground, a joint beyond its range, a motor too weak for half the weight on one leg,
/// mpc.max_normal_force of two feet below the weight. The errors have keys, no file.
Errors check_standing(const ControllerConfig& config, RobotModel& robot);

}  // namespace pirouette
