// Motion of a body with a constant planar twist.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Displacement (m) of the body's origin after `t` (s) of the constant twist `v` (m/s, in axes that
/// turn with the body) and `yaw_rate` (rad/s); in the axes at the start.
/// [Zhu21] Eq. (1), corrected for any planar twist: docs/equations.md#eq-1
inline Vec2 planar_twist_displacement(const Vec2& v, double yaw_rate, double t) {
  constexpr double kSeriesAngle = 1e-4;  // rad; below it the quotients lose digits, the series none
  const double angle = yaw_rate * t;
  double a, b;
  if (std::abs(angle) < kSeriesAngle) {
    a = t * (1.0 - square(angle) / 6.0);
    b = t * angle * (0.5 - square(angle) / 24.0);
  } else {
    a = std::sin(angle) / yaw_rate;
    b = (1.0 - std::cos(angle)) / yaw_rate;
  }
  return {a * v.x() - b * v.y(), b * v.x() + a * v.y()};
}

}  // namespace pirouette
