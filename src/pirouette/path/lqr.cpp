#include "pirouette/path/lqr.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace pirouette {
namespace {

Mat3 feedback_gain(const DiscreteErrorDynamics& system, const Mat3& R, const Mat3& P) {
  const Mat3 BtP = system.B.transpose() * P;
  return (R + BtP * system.B).ldlt().solve(BtP * system.A);
}

}  // namespace

Mat3 error_dynamics(const Vec2& v_r, double yaw_rate) {
  Mat3 A;
  A << 0.0, yaw_rate, -v_r.y(), -yaw_rate, 0.0, v_r.x(), 0.0, 0.0, 0.0;
  return A;
}

DiscreteErrorDynamics discretise_zoh(const Vec2& v_r, double yaw_rate, double dt) {
  constexpr double kSeriesAngle = 1e-3;  // rad; below it the quotients lose digits, the series none
  const double w = yaw_rate, angle = w * dt, angle2 = square(angle);
  const double c = std::cos(angle), s = std::sin(angle);
  double s1, c1, s2, c2;  // first and second integrals of sin and cos over the step
  if (std::abs(angle) < kSeriesAngle) {
    s1 = dt * (1.0 - angle2 / 6.0);
    c1 = dt * angle * (0.5 - angle2 / 24.0);
    c2 = square(dt) * (0.5 - angle2 / 24.0);
    s2 = square(dt) * angle * (1.0 / 6.0 - angle2 / 120.0);
  } else {
    s1 = s / w;
    c1 = (1.0 - c) / w;
    c2 = (1.0 - c) / square(w);
    s2 = (angle - s) / square(w);
  }
  Mat2 turn, once, twice;
  turn << c, s, -s, c;
  once << s1, c1, -c1, s1;
  twice << c2, s2, -s2, c2;
  const Vec2 sideways(-v_r.y(), v_r.x());

  DiscreteErrorDynamics system;
  system.A << turn, once * sideways, 0.0, 0.0, 1.0;
  system.B << once, twice * sideways, 0.0, 0.0, dt;
  return system;
}

DiscreteErrorDynamics discretise_euler(const Vec2& v_r, double yaw_rate, double dt) {
  return {.A = Mat3::Identity() + dt * error_dynamics(v_r, yaw_rate), .B = dt * Mat3::Identity()};
}

std::optional<LqrSolution> solve_dare(const DiscreteErrorDynamics& system, const Mat3& Q,
                                      const Mat3& R) noexcept {
  constexpr int kMaxDoublings = 50;
  constexpr double kTolerance = 1e-13;
  Mat3 A = system.A;
  Mat3 G = system.B * R.ldlt().solve(system.B.transpose());
  Mat3 H = Q;
  for (int i = 1; i <= kMaxDoublings; ++i) {
    const Mat3 W = (Mat3::Identity() + G * H).inverse();
    const Mat3 AW = A * W;
    const Mat3 dG = AW * G * A.transpose();
    const Mat3 dH = A.transpose() * H * W * A;
    A = AW * A;
    G += dG;
    H += dH;
    const double size = H.norm();
    if (!std::isfinite(size)) return std::nullopt;
    if (dH.norm() <= kTolerance * size) {
      return LqrSolution{.P = H, .K = feedback_gain(system, R, H), .doublings = i};
    }
  }
  return std::nullopt;
}

double dare_residual(const DiscreteErrorDynamics& system, const Mat3& Q, const Mat3& R,
                     const Mat3& P) {
  const Mat3 PA = P * system.A;
  const Mat3 residual =
      system.A.transpose() * PA - P - PA.transpose() * system.B * feedback_gain(system, R, P) + Q;
  return residual.cwiseAbs().maxCoeff() / P.cwiseAbs().maxCoeff();
}

}  // namespace pirouette
