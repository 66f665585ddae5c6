// Creep of the stance feet: slip that no joint encoder measures.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Creep downhill of feet that twist on a slope. docs/terrain.md#creep
struct CreepEstimate {
  double torsional_friction = 0.0;  ///< m, yaw moment of the feet per normal force, as observed
  double coefficient = 0.0;         ///< m, slip speed per twist rate and tangential force share
  /// m/rad, downhill displacement of a stance foot per angle of twist
  Vec3 slip_per_twist_W = Vec3::Zero();
};

}  // namespace pirouette
