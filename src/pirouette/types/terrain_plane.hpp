// The ground as the feet have met it: a plane z = a0 + a1 x + a2 y in world axes.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

struct TerrainPlane {
  double a0 = 0.0;            ///< m, height of the contact plane at the world's origin
  double a1 = 0.0;            ///< slope along x
  double a2 = 0.0;            ///< slope along y
  double residual_rms = 0.0;  ///< m, of the contact points about the plane
  double weight = 0.0;        ///< sum of the weights of the points behind it; 0: never fitted

  double height(double x, double y) const { return a0 + a1 * x + a2 * y; }
  double height(const Vec2& xy) const { return height(xy.x(), xy.y()); }
  /// Unit normal, away from the ground.
  Vec3 normal() const { return Vec3(-a1, -a2, 1.0).normalized(); }
};

}  // namespace pirouette
