// Error dynamics of a body that moves freely in the plane, and their LQR gain.
#pragma once

#include <optional>

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Error e = (x, y, yaw) in the reference's heading axes; input u = (vx, vy, yaw rate) beyond the
/// feed-forward. Continuous: e' = A e + u. Discrete: e+ = A e + B u.
struct DiscreteErrorDynamics {
  Mat3 A = Mat3::Identity();  ///< error to next error
  Mat3 B = Mat3::Zero();      ///< s, input to next error
};

/// 1/s, A of the holonomic error model about the reference velocity `v_r` (m/s, reference heading
/// axes) and `yaw_rate` (rad/s). [Zhu21] Eqs. (20)-(22), replaced (E21): docs/equations.md#eq-20
Mat3 error_dynamics(const Vec2& v_r, double yaw_rate);

/// Discrete dynamics, exact with the input held over `dt` (s) (E22). Arguments as for
/// error_dynamics().
DiscreteErrorDynamics discretise_zoh(const Vec2& v_r, double yaw_rate, double dt);

/// [Zhu21] Eq. (23): discrete dynamics by forward Euler. Arguments as for error_dynamics().
DiscreteErrorDynamics discretise_euler(const Vec2& v_r, double yaw_rate, double dt);

/// Solution of the Riccati equation.
struct LqrSolution {
  Mat3 P = Mat3::Zero();  ///< cost to go
  Mat3 K = Mat3::Zero();  ///< u = -K e
  int doublings = 0;      ///< iterations done
};

/// Discrete algebraic Riccati equation by structured doubling ([Zhu21] Eq. (24), E23). `R` positive
/// definite, `Q` positive semidefinite. Absent if it does not converge.
std::optional<LqrSolution> solve_dare(const DiscreteErrorDynamics& system, const Mat3& Q,
                                      const Mat3& R) noexcept;

/// Largest entry of A'PA - P - A'PB (R + B'PB)^-1 B'PA + Q, relative to the largest of P.
double dare_residual(const DiscreteErrorDynamics& system, const Mat3& Q, const Mat3& R,
                     const Mat3& P);

}  // namespace pirouette
