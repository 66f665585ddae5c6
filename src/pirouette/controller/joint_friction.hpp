// Feed-forward torque against joint friction.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/types/leg_geometry.hpp"

namespace pirouette {

/// Torque (N m) of dry and viscous friction in a leg's joints at the rates `dq` (rad/s). Dry
/// friction is smoothed around zero rate, so that noise in `dq` does not flip its sign.
inline Vec3 joint_friction(const LegGeometry& leg, const Vec3& dq) {
  constexpr double kSmoothRate = 0.05;  // rad/s
  const Vec3 direction = (dq / kSmoothRate).array().tanh();
  return leg.dry_friction.cwiseProduct(direction) + leg.damping.cwiseProduct(dq);
}

}  // namespace pirouette
