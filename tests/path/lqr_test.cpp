#include "pirouette/path/lqr.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "pirouette/base/planar_twist.hpp"
#include "pirouette/base/rotation.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::to_mat3;
using test::to_vec2;
using test::to_vec3;

double relative(const Mat3& a, const Mat3& b) {
  return distance(a, b) / std::max(1.0, b.cwiseAbs().maxCoeff());
}

TEST(Lqr, DynamicsAndGainsMatchScipyInBothDiscretisations) {
  const auto& section = test::vectors("lqr");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    const Vec2 v_r = to_vec2(c.at("v_r"));
    const double w = c.at("omega_r"), dt = c.at("dt");
    const Mat3 Q = to_vec3(c.at("Q")).asDiagonal(), R = to_vec3(c.at("R")).asDiagonal();
    EXPECT_LT(relative(error_dynamics(v_r, w), to_mat3(c.at("A"))), tol);
    for (const auto& [key, system] :
         {std::pair{"zoh", discretise_zoh(v_r, w, dt)}, {"euler", discretise_euler(v_r, w, dt)}}) {
      const auto& expected = c.at(key);
      EXPECT_LT(relative(system.A, to_mat3(expected.at("Ad"))), tol);
      EXPECT_LT(relative(system.B, to_mat3(expected.at("Bd"))), tol);
      const std::optional<LqrSolution> lqr = solve_dare(system, Q, R);
      ASSERT_TRUE(lqr);
      EXPECT_LT(relative(lqr->P, to_mat3(expected.at("P"))), tol);
      EXPECT_LT(relative(lqr->K, to_mat3(expected.at("K"))), tol);
      const double radius = (system.A - system.B * lqr->K).eigenvalues().cwiseAbs().maxCoeff();
      EXPECT_NEAR(radius, expected.at("spectral_radius").get<double>(), tol);
    }
  }
}

TEST(Lqr, SolutionSatisfiesTheRiccatiEquation) {
  const Mat3 R = Vec3(1.0, 2.0, 0.5).asDiagonal();
  for (const double dt : {0.002, 0.03}) {
    for (const double w : {0.0, 0.7, -6.0}) {
      const Mat3 Q = Vec3(100.0, 30.0, 20.0).asDiagonal();
      const DiscreteErrorDynamics system = discretise_zoh({0.3, -0.1}, w, dt);
      const std::optional<LqrSolution> lqr = solve_dare(system, Q, R);
      ASSERT_TRUE(lqr);
      EXPECT_LE(lqr->doublings, 14);
      EXPECT_LT(dare_residual(system, Q, R, lqr->P), 1e-13);
      EXPECT_LT(distance(lqr->P, lqr->P.transpose()), 1e-9 * lqr->P.norm());
    }
  }
}

TEST(Lqr, StandingReferenceHasTheScalarClosedForm) {
  const Mat3 Q = Vec3::Constant(100.0).asDiagonal(), R = Mat3::Identity();
  const std::optional<LqrSolution> lqr = solve_dare(discretise_zoh(Vec2::Zero(), 0.0, 0.01), Q, R);
  ASSERT_TRUE(lqr);
  const double P = 0.5 * (100.0 + std::sqrt(square(100.0) + 4.0 * 100.0 / square(0.01)));
  EXPECT_LT(distance(lqr->P, Mat3(P * Mat3::Identity())), 1e-9);
  EXPECT_LT(distance(lqr->K, Mat3(P * 0.01 / (1.0 + P * square(0.01)) * Mat3::Identity())), 1e-12);
}

TEST(Lqr, AnUnweightedErrorIsLeftAlone) {
  const Mat3 Q = Vec3(1.0, 1.0, 0.0).asDiagonal();
  const std::optional<LqrSolution> lqr =
      solve_dare(discretise_zoh(Vec2::Zero(), 0.7, 0.002), Q, Mat3::Identity());
  ASSERT_TRUE(lqr);
  EXPECT_EQ(lqr->K.row(2), Eigen::RowVector3d::Zero());
}

TEST(Lqr, AbsentWithoutAStabilisingSolution) {
  DiscreteErrorDynamics unstable{.A = 1.1 * Mat3::Identity(), .B = Mat3::Zero()};
  EXPECT_FALSE(solve_dare(unstable, Mat3::Identity(), Mat3::Identity()));
}

TEST(Lqr, SpinningIsControllable) {
  for (const Vec2& v_r : {Vec2(0.0, 0.0), Vec2(0.3, 0.0)}) {
    const DiscreteErrorDynamics system = discretise_zoh(v_r, 0.7, 0.01);
    Eigen::Matrix<double, 3, 9> reach;
    reach << system.B, system.A * system.B, system.A * system.A * system.B;
    EXPECT_EQ(reach.fullPivLu().rank(), 3);
  }
}

TEST(Lqr, ErrorDynamicsAreTheDerivativeOfTwoMovingPoses) {
  constexpr double kDt = 1e-6, kError = 1e-5;
  const Vec2 v_r(0.3, -0.1);
  const double w = 0.7;
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = kError * Vec3::Unit(k);
    // The reference starts at the origin; the robot, at the error, moves with the same body twist.
    const Vec2 reference = planar_twist_displacement(v_r, w, kDt);
    const Vec2 robot = e.head<2>() + rot2(e.z()) * reference;
    Vec3 later;
    later << rot2(-w * kDt) * (robot - reference), e.z();
    EXPECT_LT(distance((later - e) / (kDt * kError), error_dynamics(v_r, w).col(k)), 1e-4);
  }
}

TEST(Lqr, ZeroOrderHoldSeriesMeetsTheClosedForm) {
  const Vec2 v_r(0.3, -0.1);
  const DiscreteErrorDynamics below = discretise_zoh(v_r, 0.09999, 0.01),
                              above = discretise_zoh(v_r, 0.10001, 0.01);
  EXPECT_LT(distance(below.A, above.A), 3e-7);  // the yaw rates differ by 2e-5, times dt
  EXPECT_LT(distance(below.B, above.B), 3e-9);
  EXPECT_LT(distance(discretise_zoh(v_r, 0.0, 0.01).B.topLeftCorner<2, 2>(),
                     Mat2(0.01 * Mat2::Identity())),
            1e-18);
}

}  // namespace
}  // namespace pirouette
