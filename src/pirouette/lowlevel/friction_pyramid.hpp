// Linear limits of the force on a foot, in axes of the ground.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Two unit tangents that complete `n` to a right-handed frame (t1, t2, n); t1 lies along world x's
/// projection.
inline void ground_tangents(const Vec3& n, Vec3& t1, Vec3& t2) {
  t1 = (Vec3::UnitX() - n.x() * n).normalized();
  t2 = n.cross(t1);
}

inline constexpr int kPyramidRows = 6;  ///< four faces, the least and the largest normal force

/// Rows of  C f >= lower  for the force on the robot at a contact with normal `n`, world axes:
/// |f.t1| <= mu f.n, |f.t2| <= mu f.n, f_min <= f.n <= f_max.
struct FrictionPyramid {
  Eigen::Matrix<double, kPyramidRows, 3> C;      ///< left-hand side
  Eigen::Matrix<double, kPyramidRows, 1> lower;  ///< N

  /// `n` is the unit normal; `min_normal` and `max_normal` in N.
  FrictionPyramid(const Vec3& n, double friction, double min_normal, double max_normal) {
    Vec3 t1, t2;
    ground_tangents(n, t1, t2);
    C.row(0) = friction * n - t1;
    C.row(1) = friction * n + t1;
    C.row(2) = friction * n - t2;
    C.row(3) = friction * n + t2;
    C.row(4) = n;
    C.row(5) = -n;
    lower << 0.0, 0.0, 0.0, 0.0, min_normal, -max_normal;
  }

  /// C f - lower (N); negative in the rows that `f` (N) violates.
  Eigen::Matrix<double, kPyramidRows, 1> slack(const Vec3& f) const { return C * f - lower; }
};

}  // namespace pirouette
