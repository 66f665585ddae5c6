// Lengths, limits and joint friction of one leg, read from the robot's file by model/.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/types/joint_convention.hpp"

namespace pirouette {

/// A leg with abad about +x and hip and knee about +y, straight down at q = 0, whatever the joints
/// of its file are. Vectors hold abad, hip, knee.
struct LegGeometry {
  Vec3 p_BH = Vec3::Zero();  ///< m, abad axis H in trunk axes
  double abad_offset = 0.0;  ///< m, from H to the leg's plane along y, signed: positive on the left
  double hip_drop = 0.0;     ///< m, from H down to the hip axis
  double thigh = 0.0;        ///< m, hip to knee
  double shank = 0.0;        ///< m, knee to sphere centre
  double foot_radius = 0.0;  ///< m, of the sphere
  double knee_sign = -1.0;   ///< sign of the knee angle: -1 knees backward, +1 forward
  Vec3 q_min = Vec3::Constant(-kPi);   ///< rad, lower joint limits
  Vec3 q_max = Vec3::Constant(kPi);    ///< rad, upper joint limits
  Vec3 tau_max = Vec3::Constant(1e3);  ///< N m, torque limits
  Vec3 dry_friction = Vec3::Zero();    ///< N m, of the joints
  Vec3 damping = Vec3::Zero();         ///< N m s/rad, of the joints
  JointConvention convention;          ///< of the joints of the file
};

}  // namespace pirouette
