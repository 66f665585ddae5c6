// Rotations and yaw. R_WB = Rz(yaw) Ry(pitch) Rx(roll) (docs/notation.md).
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Roll, pitch and yaw (rad). Pitch is negative with the nose up; roll is positive with the left
/// side up.
struct RollPitchYaw {
  double roll = 0.0;   ///< rad
  double pitch = 0.0;  ///< rad
  double yaw = 0.0;    ///< rad
};

/// The angle (rad) in [-pi, pi].
inline double wrap_angle(double angle) { return std::remainder(angle, 2.0 * kPi); }

/// Cross-product matrix: skew(v) * w == v x w.
inline Mat3 skew(const Vec3& v) {
  Mat3 m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Rotation by `a` (rad) about x.
inline Mat3 rot_x(double a) {
  const double c = std::cos(a), s = std::sin(a);
  Mat3 m;
  m << 1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c;
  return m;
}

/// Rotation by `a` (rad) about y.
inline Mat3 rot_y(double a) {
  const double c = std::cos(a), s = std::sin(a);
  Mat3 m;
  m << c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c;
  return m;
}

/// Rotation by `a` (rad) about z.
inline Mat3 rot_z(double a) {
  const double c = std::cos(a), s = std::sin(a);
  Mat3 m;
  m << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return m;
}

/// Rotation by `a` (rad) in the plane.
inline Mat2 rot2(double a) {
  const double c = std::cos(a), s = std::sin(a);
  Mat2 m;
  m << c, -s, s, c;
  return m;
}

/// R_WB of `rpy` (rad).
inline Mat3 rotation_from_rpy(const RollPitchYaw& rpy) {
  return rot_z(rpy.yaw) * rot_y(rpy.pitch) * rot_x(rpy.roll);
}

/// Roll, pitch and yaw of `R_WB`, pitch in [-pi/2, pi/2], the others in [-pi, pi].
inline RollPitchYaw rpy_from_rotation(const Mat3& R_WB) {
  return {std::atan2(R_WB(2, 1), R_WB(2, 2)), std::asin(std::clamp(-R_WB(2, 0), -1.0, 1.0)),
          std::atan2(R_WB(1, 0), R_WB(0, 0))};
}

/// Rotation by the angle |v| (rad) about v.
inline Mat3 exp_so3(const Vec3& v) {
  const double angle = v.norm();
  if (angle < 1e-12) return Mat3::Identity() + skew(v);
  return Eigen::AngleAxisd(angle, v / angle).toRotationMatrix();
}

/// Rotation vector (rad) of `R`; its norm is in [0, pi].
inline Vec3 log_so3(const Mat3& R) {
  const Eigen::AngleAxisd aa(Quat(R).normalized());
  const double angle = wrap_angle(aa.angle());
  return angle * aa.axis();
}

/// Continuous yaw from wrapped samples; right while it changes by less than pi per sample.
class YawUnwrapper {
 public:
  /// The unwrapped yaw (rad) of the next sample `yaw` (rad).
  double update(double yaw) {
    unwrapped_ += std::remainder(yaw - unwrapped_, 2.0 * kPi);
    return unwrapped_;
  }
  void reset(double yaw) { unwrapped_ = yaw; }  ///< starts at `yaw` (rad)
  double value() const { return unwrapped_; }   ///< rad, of the last sample

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [unwrapped] = self;
    visit(unwrapped);
  }

 private:
  double unwrapped_ = 0.0;
};

}  // namespace pirouette
