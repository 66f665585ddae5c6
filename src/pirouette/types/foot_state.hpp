// Kinematics of one foot relative to the trunk.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

/// Foot relative to the trunk, from the joint angles and rates of its leg.
struct FootState {
  Vec3 p_BF = Vec3::Zero();      ///< m, sphere centre in trunk axes
  Vec3 v_BF_B = Vec3::Zero();    ///< m/s, of the sphere centre relative to the trunk, trunk axes
  Vec3 w_BS_B = Vec3::Zero();    ///< rad/s, of the shank S relative to the trunk, trunk axes
  Mat3 R_BS = Mat3::Identity();  ///< shank orientation in trunk axes
};

}  // namespace pirouette
