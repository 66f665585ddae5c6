// Plane of the ground, z = a0 + a1 x + a2 y in world axes.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Plane through the contact points of the feet: z = a0 + a1 x + a2 y.
struct TerrainPlane {
  double a0 = 0.0;            ///< m, height of the contact plane at the world's origin
  double a1 = 0.0;            ///< gradient along x
  double a2 = 0.0;            ///< gradient along y
  double residual_rms = 0.0;  ///< m, of the contact points about the plane
  double weight = 0.0;        ///< sum of the weights of the fitted points; 0: never fitted

  double height(double x, double y) const { return a0 + a1 * x + a2 * y; }  ///< m, at (x, y) (m)
  double height(const Vec2& xy) const { return height(xy.x(), xy.y()); }    ///< m, at `xy` (m)
  /// Unit normal, upwards.
  Vec3 normal() const { return Vec3(-a1, -a2, 1.0).normalized(); }
};

}  // namespace pirouette
