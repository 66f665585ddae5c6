#include "pirouette/foot/leg_kinematics.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::paper_leg;
using test::to_leg;
using test::to_mat3;
using test::to_vec3;

class LegKinematics : public ::testing::Test {
 protected:
  Vec3 random_posture() {
    std::uniform_real_distribution<double> abad(-0.8, 0.8), hip(-1.0, 1.5), knee(-2.5, -0.3);
    return {abad(generator_), hip(generator_), knee(generator_)};
  }

 private:
  std::mt19937 generator_{7};
};

TEST_F(LegKinematics, ForwardKinematicsAndJacobiansMatchPinocchio) {
  const auto& section = test::vectors("leg_fk_jac");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    const LegGeometry leg = paper_leg(to_leg(c.at("leg")));
    const Vec3 q = to_vec3(c.at("q"));
    EXPECT_LT(distance(foot_position_H(leg, q), to_vec3(c.at("p_hip"))), tol);
    EXPECT_LT(distance(foot_state(leg, q, Vec3::Zero()).p_BF, to_vec3(c.at("p_body"))), tol);
    EXPECT_LT(distance(foot_jacobian(leg, q), to_mat3(c.at("Jv"))), tol);
    EXPECT_LT(distance(shank_jacobian(q), to_mat3(c.at("Jw"))), tol);
    EXPECT_LT(distance(shank_rotation(q), to_mat3(c.at("R_shank"))), tol);
  }
}

TEST_F(LegKinematics, InverseKinematicsMatchesBothBranchesOfPinocchioAndScipy) {
  const auto& section = test::vectors("leg_ik");
  for (const auto& c : section.at("cases")) {
    const LegGeometry leg = paper_leg(to_leg(c.at("leg")));
    const Vec3 p_HF = to_vec3(c.at("p_hip"));
    for (const auto& [sign, key] : {std::pair{-1.0, "q_knee_backward"}, {1.0, "q_knee_forward"}}) {
      const IkSolution ik = inverse_kinematics(leg, p_HF, sign);
      EXPECT_TRUE(ik.reachable());
      const Vec3 miss =
          (ik.q - to_vec3(c.at(key))).unaryExpr([](double a) { return wrap_angle(a); });
      EXPECT_LT(miss.cwiseAbs().maxCoeff(), section.at("tol").get<double>());
    }
  }
}

TEST_F(LegKinematics, UnreachablePointsAreFlaggedAndAnsweredWithAFinitePosture) {
  for (const auto& c : test::vectors("leg_ik_unreachable").at("cases")) {
    const IkSolution ik =
        inverse_kinematics(paper_leg(c.at("side").get<double>()), to_vec3(c.at("p_hip")));
    const std::string flag = c.at("flag");
    EXPECT_EQ(ik.far, flag == "far");
    EXPECT_EQ(ik.near, flag.find("near") != std::string::npos);
    EXPECT_EQ(ik.abad, flag.find("abad") != std::string::npos);
    EXPECT_FALSE(ik.reachable());
    EXPECT_TRUE(ik.q.allFinite());
  }
}

TEST_F(LegKinematics, FarPointsAreReachedForInTheirDirection) {
  const LegGeometry leg = paper_leg(1.0);
  const Vec3 far(0.3, leg.abad_offset, -0.6);
  const Vec3 reached = foot_position_H(leg, inverse_kinematics(leg, far).q);
  EXPECT_NEAR(reached.y(), far.y(), 1e-15);
  EXPECT_NEAR(std::hypot(reached.x(), reached.z()), leg.thigh + leg.shank, 1.01e-4);
  EXPECT_NEAR(reached.x() / reached.z(), far.x() / far.z(), 1e-12);
}

TEST_F(LegKinematics, InverseUndoesForward) {
  for (const Leg leg_name : kLegs) {
    const LegGeometry leg = paper_leg(leg_name);
    for (int i = 0; i < 200; ++i) {
      const Vec3 q = random_posture();
      const Vec3 p_HF = foot_position_H(leg, q);
      const IkSolution ik = inverse_kinematics(leg, p_HF);
      ASSERT_TRUE(ik.reachable());
      // 1e-10 m: the acos of the knee loses half the digits near the straight leg.
      EXPECT_LT(distance(foot_position_H(leg, ik.q), p_HF), 1e-10);
    }
  }
}

TEST_F(LegKinematics, JacobiansAreTheDerivatives) {
  constexpr double kStep = 1e-6;
  const LegGeometry leg = paper_leg(Leg::kRL);
  for (int i = 0; i < 20; ++i) {
    const Vec3 q = random_posture();
    const Mat3 Jv = foot_jacobian(leg, q), Jw = shank_jacobian(q);
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = kStep * Vec3::Unit(k);
      const Vec3 dp = foot_position_H(leg, q + step) - foot_position_H(leg, q - step);
      const Mat3 dR = shank_rotation(q + step) * shank_rotation(q - step).transpose();
      EXPECT_LT(distance(Jv.col(k), dp / (2.0 * kStep)), 1e-9);  // O(step^2) and rounding / step
      EXPECT_LT(distance(Jw.col(k), log_so3(dR) / (2.0 * kStep)), 1e-9);
    }
  }
}

TEST_F(LegKinematics, DeterminantHasItsClosedForm) {
  const LegGeometry leg = paper_leg(-1.0);
  for (int i = 0; i < 20; ++i) {
    const Vec3 q = random_posture();
    EXPECT_NEAR(foot_jacobian_determinant(leg, q), foot_jacobian(leg, q).determinant(), 1e-16);
  }
}

TEST_F(LegKinematics, ShankPointsFromKneeToFoot) {
  const LegGeometry leg = paper_leg(1.0);
  LegGeometry to_knee = leg;
  to_knee.shank = 0.0;
  const Vec3 q(0.3, 0.8, -1.5);
  const Vec3 shank = foot_position_H(leg, q) - foot_position_H(to_knee, q);
  EXPECT_LT(distance(-leg.shank * shank_rotation(q).col(2), shank), 1e-15);
}

TEST_F(LegKinematics, LeftAndRightLegsAreMirrorImages) {
  const Vec3 q(0.4, 0.7, -1.4), mirrored(-0.4, 0.7, -1.4);
  const Vec3 left = foot_position_H(paper_leg(1.0), q),
             right = foot_position_H(paper_leg(-1.0), mirrored);
  EXPECT_LT(distance(Vec3(left.x(), -left.y(), left.z()), right), 1e-16);
}

TEST_F(LegKinematics, VelocityInverseIsExactAwayFromSingularPostures) {
  const LegGeometry leg = paper_leg(1.0);
  const Vec3 q(0.1, 0.8, -1.6), v(0.3, -0.2, 0.5);
  EXPECT_LT(distance(foot_jacobian(leg, q) * inverse_velocity_kinematics(leg, q, v), v), 1e-14);
}

TEST_F(LegKinematics, VelocityInverseStaysBoundedAtTheStraightLeg) {
  const LegGeometry leg = paper_leg(1.0);
  const Vec3 along_the_leg(0.0, 0.0, 1.0);
  for (const double knee : {0.0, -1e-6, -1e-3}) {
    // A damped inverse amplifies by 1 / (2 damping) at most, here 1 / (2 * 0.05) per m/s.
    EXPECT_LE(inverse_velocity_kinematics(leg, {0.0, 0.0, knee}, along_the_leg).norm(),
              10.0 + 1e-6);
  }
}

}  // namespace
}  // namespace pirouette
