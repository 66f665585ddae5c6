// Feed-forward against the joints' own friction.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/types/leg_geometry.hpp"

namespace pirouette {

/// N m, torque that dry and viscous friction of a leg's joints take at the rates `dq` (rad/s). Dry
/// friction is smoothed about standstill, so that noise in `dq` does not flip it.
inline Vec3 joint_friction(const LegGeometry& leg, const Vec3& dq) {
  constexpr double kSmoothRate = 0.05;  // rad/s
  const Vec3 direction = (dq / kSmoothRate).array().tanh();
  return leg.dry_friction.cwiseProduct(direction) + leg.damping.cwiseProduct(dq);
}

}  // namespace pirouette
