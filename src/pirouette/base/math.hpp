// Fixed-size Eigen aliases and scalar helpers used by every stage.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pirouette {

using Vec2 = Eigen::Vector2d;              ///< column vector
using Vec3 = Eigen::Vector3d;              ///< column vector
using Vec4 = Eigen::Vector4d;              ///< column vector
using Vec6 = Eigen::Matrix<double, 6, 1>;  ///< column vector
using Mat2 = Eigen::Matrix2d;              ///< 2 x 2
using Mat3 = Eigen::Matrix3d;              ///< 3 x 3
using Quat = Eigen::Quaterniond;           ///< unit quaternion

inline constexpr double kPi = 3.14159265358979323846;  ///< pi
inline constexpr double kGravity = 9.81;               ///< m/s^2, along -z of the world

constexpr double square(double x) { return x * x; }                         ///< x^2
constexpr double radians(double degrees) { return degrees * kPi / 180.0; }  ///< rad
constexpr double degrees(double radians) { return radians * 180.0 / kPi; }  ///< deg

/// Vector `v` shortened to at most `limit` in length, direction kept.
template <int N>
Eigen::Matrix<double, N, 1> clamp_norm(const Eigen::Matrix<double, N, 1>& v, double limit) {
  const double norm = v.norm();
  if (norm <= limit) return v;
  return v * (limit / norm);
}

}  // namespace pirouette
