// Slip that no joint encoder sees: feet that twist on a slope creep downhill.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

struct CreepEstimate {
  double torsional_friction = 0.0;  ///< m, yaw moment of the feet per normal force, as observed
  double coefficient = 0.0;         ///< m, slip speed per twist rate and tangential force share
  Vec3 slip_per_twist_W = Vec3::Zero();  ///< m/rad, way of a stance foot down the slope
};

}  // namespace pirouette
