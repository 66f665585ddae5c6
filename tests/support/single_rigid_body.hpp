// The linear single rigid body of the convex MPC, written out in full: the reference for the
// condensed one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette::test {

inline constexpr int kSrbStates = 13;  ///< [roll pitch yaw, p, omega (world), v, g_z]

using SrbState = Eigen::Matrix<double, kSrbStates, 1>;
using SrbMatrix = Eigen::Matrix<double, kSrbStates, kSrbStates>;

/// x_dot = A x + B f, or x_next = A x + B f; f stacks the contact forces.
struct SrbDynamics {
  SrbMatrix A = SrbMatrix::Zero();
  Eigen::MatrixXd B;
};

/// d(rpy)/dt = T omega for small roll and pitch ([DiCarlo18]).
inline Mat3 small_angle_rate_map(const RollPitchYaw& rpy) { return rot_z(rpy.yaw).transpose(); }

/// The same without approximation (E24): column k of the inverse is the axis that angle k turns
/// about.
inline Mat3 exact_rate_map(const RollPitchYaw& rpy) {
  Mat3 axes;
  axes << rot_z(rpy.yaw) * rot_y(rpy.pitch) * Vec3::UnitX(), rot_z(rpy.yaw) * Vec3::UnitY(),
      Vec3::UnitZ();
  return axes.inverse();
}

/// `arms`: contacts from the CoM, m, world axes.
inline SrbDynamics srb_dynamics(double mass, const Mat3& inertia_W, const Mat3& rate_map,
                                const std::vector<Vec3>& arms) {
  SrbDynamics d;
  d.A.block<3, 3>(0, 6) = rate_map;
  d.A.block<3, 3>(3, 9).setIdentity();
  d.A(11, 12) = 1.0;
  d.B.setZero(kSrbStates, 3 * static_cast<int>(arms.size()));
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const int column = 3 * static_cast<int>(i);
    d.B.block<3, 3>(6, column) = inertia_W.inverse() * skew(arms[i]);
    d.B.block<3, 3>(9, column) = Mat3::Identity() / mass;
  }
  return d;
}

/// Exact for forces held over `dt`, because A^3 = 0 and A^2 B = 0.
inline SrbDynamics discretised(const SrbDynamics& d, double dt) {
  SrbDynamics out;
  out.A = SrbMatrix::Identity() + dt * d.A + 0.5 * dt * dt * d.A * d.A;
  out.B = dt * d.B + 0.5 * dt * dt * d.A * d.B;
  return out;
}

}  // namespace pirouette::test
