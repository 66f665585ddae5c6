#include "pirouette/foot/rolling_foot.hpp"

#include <gtest/gtest.h>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::paper_leg;
using test::to_leg;
using test::to_mat3;
using test::to_vec3;

constexpr double kRadius = 0.0225;
const RollingFoot kRolling(FootModel::kRolling, kRadius);
const RollingFoot kCentre(FootModel::kCentre, kRadius);

TEST(RollingFoot, ContactJacobianMatchesPinocchio) {
  const auto& section = test::vectors("contact_jacobian");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    const LegGeometry leg = paper_leg(to_leg(c.at("leg")));
    const Vec3 q = to_vec3(c.at("q")), n_B = to_vec3(c.at("n_body"));
    EXPECT_LT(distance(kRolling.contact_jacobian(leg, q, n_B), to_mat3(c.at("J_contact"))), tol);
    const Vec3 p_BF = foot_state(leg, q, Vec3::Zero()).p_BF;
    EXPECT_LT(distance(kRolling.contact_point(p_BF, n_B), to_vec3(c.at("contact_body"))), tol);
  }
}

TEST(RollingFoot, OdometryMatchesPinocchioForBothModels) {
  const auto& section = test::vectors("leg_odometry");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    const FootState foot =
        foot_state(paper_leg(to_leg(c.at("leg"))), to_vec3(c.at("q")), to_vec3(c.at("qd")));
    const Mat3 R_WB = to_mat3(c.at("R_body"));
    const Vec3 w_WB_W = R_WB * to_vec3(c.at("omega_body_local")), n_W = to_vec3(c.at("n_world"));
    EXPECT_LT(distance(kRolling.odometry_velocity(foot, R_WB, w_WB_W, n_W),
                       to_vec3(c.at("v_base_rolling"))),
              tol);
    EXPECT_LT(distance(kCentre.odometry_velocity(foot, R_WB, w_WB_W, n_W),
                       to_vec3(c.at("v_base_pointfoot"))),
              tol);
  }
}

TEST(RollingFoot, IdealOffsetIsThePlanarRollFromTheUprightShank) {
  const auto& section = test::vectors("rolling_ideal_offset");
  for (const auto& c : section.at("cases")) {
    EXPECT_LT(distance(kRolling.ideal_offset(to_vec3(c.at("u_shank")), to_vec3(c.at("n"))),
                       to_vec3(c.at("PI_minus_C"))),
              section.at("tol").get<double>());
  }
}

TEST(RollingFoot, LogFormIsExactForARotationAboutOneAxis) {
  const auto& section = test::vectors("rolling_constant_axis");
  for (const auto& c : section.at("cases")) {
    const Vec3 moved =
        kRolling.displacement(to_mat3(c.at("R0")), to_mat3(c.at("R1")), to_vec3(c.at("n")));
    EXPECT_LT(distance(moved, to_vec3(c.at("displacement"))), section.at("tol").get<double>());
  }
}

Mat3 shank_on_path(const Vec3& yaw_abad_pitch) {
  return rot_z(yaw_abad_pitch[0]) * rot_x(yaw_abad_pitch[1]) * rot_y(yaw_abad_pitch[2]);
}

TEST(RollingFoot, LogFormsAlongAPathSumToTheIntegral) {
  const auto& section = test::vectors("rolling_path");
  constexpr int kSteps = 4000;  // the sum converges with the square of the step
  for (const auto& c : section.at("cases")) {
    const Vec3 from = to_vec3(c.at("angles0_yaw_abad_pitch")),
               to = to_vec3(c.at("angles1_yaw_abad_pitch"));
    const Vec3 n = to_vec3(c.at("n"));
    const double tol = section.at("tol");
    EXPECT_LT(distance(kRolling.displacement(shank_on_path(from), shank_on_path(to), n),
                       to_vec3(c.at("log_form"))),
              tol);
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < kSteps; ++i) {
      const Mat3 R_0 = shank_on_path(from + (to - from) * i / kSteps);
      const Mat3 R_1 = shank_on_path(from + (to - from) * (i + 1) / kSteps);
      sum += kRolling.displacement(R_0, R_1, n);
    }
    EXPECT_LT(distance(sum, to_vec3(c.at("displacement"))), tol);
  }
}

// Each closed form against the integrated spinning stance, base fixed and turning.
class SpinStance : public ::testing::Test {
 protected:
  struct Case {
    LegGeometry leg;
    Vec3 q_start, q_end, displacement;
    double yaw_start, turn, omega, duration, hip_height;
  };

  static std::vector<Case> cases() {
    std::vector<Case> out;
    for (const auto& c : test::vectors("rolling_spin_stance").at("cases")) {
      Case s{.leg = paper_leg(to_leg(c.at("leg"))),
             .q_start = to_vec3(c.at("q_start")),
             .q_end = to_vec3(c.at("q_end")),
             .displacement = to_vec3(c.at("displacement")),
             .yaw_start = c.at("yaw0"),
             .turn = c.at("omega").get<double>() * c.at("T").get<double>(),
             .omega = c.at("omega"),
             .duration = c.at("T"),
             .hip_height = c.at("hip_height")};
      s.leg.knee_sign = c.at("knee");
      out.push_back(s);
    }
    return out;
  }
};

TEST_F(SpinStance, LogAndBodyAxesFormsAgreeWithTheIntegral) {
  for (const Case& c : cases()) {
    const Vec3 log_form =
        kRolling.displacement(rot_z(c.yaw_start) * shank_rotation(c.q_start),
                              rot_z(c.yaw_start + c.turn) * shank_rotation(c.q_end), Vec3::UnitZ());
    const Vec3 body_form =
        kRolling.level_displacement(c.q_start, c.q_end, c.yaw_start + 0.5 * c.turn);
    // Both forms are 0.2 % off at this size: 0.007 mm (docs/equations.md, section 4.4).
    EXPECT_LT((log_form - c.displacement).norm(), 7e-6);
    EXPECT_LT((body_form - c.displacement).norm(), 7e-6);
  }
}

TEST_F(SpinStance, CentreMovesAsTheRollingVelocitySaysWhenIntegrated) {
  constexpr int kSteps = 1000;
  for (const Case& c : cases()) {
    const double dt = c.duration / kSteps;
    double yaw = c.yaw_start;
    Vec3 q = c.q_start, moved = Vec3::Zero();
    // Joint rates from the rolling constraint J_C nu = 0 of a base that only turns (E13).
    const auto joint_rates = [&](const Vec3& posture) -> Vec3 {
      const Vec3 lever = foot_state(c.leg, posture, Vec3::Zero()).p_BF - kRadius * Vec3::UnitZ();
      return kRolling.contact_jacobian(c.leg, posture, Vec3::UnitZ()).inverse() *
             -(c.omega * Vec3::UnitZ()).cross(lever);
    };
    for (int i = 0; i < kSteps; ++i) {  // midpoint rule: error O(dt^2)
      const Vec3 q_mid = q + 0.5 * dt * joint_rates(q);
      const Vec3 dq = joint_rates(q_mid);
      const Vec3 w_WS_W =
          c.omega * Vec3::UnitZ() + rot_z(yaw + 0.5 * dt * c.omega) * shank_jacobian(q_mid) * dq;
      moved += dt * kRolling.rolling_velocity(w_WS_W, Vec3::UnitZ());
      q += dt * dq;
      yaw += dt * c.omega;
    }
    EXPECT_LT(distance(q, c.q_end), 1e-7);
    EXPECT_LT(distance(moved, c.displacement),
              test::vectors("rolling_spin_stance").at("tol").get<double>());
  }
}

TEST_F(SpinStance, StanceTravelForeseesTheContact) {
  for (const Case& c : cases()) {
    StanceMotion motion;
    const Vec3 p_HF = foot_position_H(c.leg, c.q_start);
    // The integral starts over the nominal foothold, so its mid-stance lies half the travel
    // further.
    const double yaw_mid = c.yaw_start + 0.5 * c.turn;
    const Vec3 p_WF_mid = rot_z(c.yaw_start) * (c.leg.p_BH + p_HF) + 0.5 * c.displacement;
    motion.p_BF = rot_z(-yaw_mid) * p_WF_mid;
    motion.twist.yaw_rate = c.omega;
    motion.duration = c.duration;
    const Vec3 travel = rot_z(yaw_mid) * kRolling.stance_travel(c.leg, motion);
    EXPECT_LT((travel - c.displacement).norm(), 3e-5);  // 1 % of the travel
  }
}

TEST(RollingFoot, StanceTravelOfASymmetricSpinIsMirroredAcrossTheBody) {
  StanceMotion left{.p_BF = {0.19, 0.111, -0.27}}, right = left;
  right.p_BF.y() = -left.p_BF.y();
  left.twist.yaw_rate = 0.7;
  right.twist.yaw_rate = -0.7;
  left.duration = right.duration = 0.3;
  const Vec3 travel_left = kRolling.stance_travel(paper_leg(Leg::kFL), left);
  const Vec3 travel_right = kRolling.stance_travel(paper_leg(Leg::kFR), right);
  EXPECT_LT(distance(Vec3(travel_left.x(), -travel_left.y(), travel_left.z()), travel_right),
            1e-15);
}

TEST(RollingFoot, StanceTravelStaysInASlopedPlane) {
  StanceMotion motion{.p_BF = {0.19, 0.111, -0.27}};
  motion.n_H = Vec3(-0.2, 0.1, 1.0).normalized();
  motion.R_HB = Quat::FromTwoVectors(Vec3::UnitZ(), motion.n_H).toRotationMatrix();
  motion.twist = {{0.2, 0.0}, 0.7};
  motion.duration = 0.3;
  const Vec3 travel = kRolling.stance_travel(paper_leg(Leg::kFL), motion);
  EXPECT_GT(travel.norm(), 1e-3);
  EXPECT_NEAR(travel.dot(motion.n_H), 0.0, 1e-15);
}

TEST(RollingFoot, ContactPointIsStillWhenRollingOnFlatGround) {
  const Vec3 w_WS_W(0.4, -1.2, 0.7), n_W = Vec3::UnitZ();
  const Vec3 material_point = kRolling.rolling_velocity(w_WS_W, n_W) + w_WS_W.cross(-kRadius * n_W);
  EXPECT_EQ(material_point, Vec3::Zero());
}

TEST(RollingFoot, PivotingMovesNothing) {
  const Vec3 n_W = Vec3(-0.2, 0.1, 1.0).normalized();
  EXPECT_LT(kRolling.rolling_velocity(3.0 * n_W, n_W).norm(), 1e-16);
}

TEST(RollingFoot, LevelShankVelocityHasItsClosedFormAtAnyYawRate) {
  const Vec3 q(0.2, 0.8, -1.5), dq(0.7, -1.1, 2.3);
  for (const double yaw_rate : {0.0, 0.7, -5.0}) {  // E7, heading axes
    const Vec3 w_WS_H = yaw_rate * Vec3::UnitZ() + shank_jacobian(q) * dq;
    const Vec3 expected = kRadius * Vec3(std::cos(q[0]) * (dq[1] + dq[2]), -dq[0], 0.0);
    EXPECT_LT(distance(kRolling.rolling_velocity(w_WS_H, Vec3::UnitZ()), expected), 1e-16);
  }
}

TEST(RollingFoot, CentreModelIsASphereOfRadiusZero) {
  const LegGeometry leg = paper_leg(Leg::kFL);
  const Vec3 q(0.1, 0.8, -1.6), p(1.0, 2.0, 3.0), n = Vec3(0.1, 0.2, 1.0).normalized();
  EXPECT_EQ(kCentre.contact_point(p, n), p);
  EXPECT_EQ(kCentre.centre_from_contact(p, n), p);
  EXPECT_EQ(kCentre.centre_offset(), 0.0);
  EXPECT_EQ(kCentre.rolling_velocity(p, n), Vec3::Zero());
  EXPECT_EQ(kCentre.contact_jacobian(leg, q, n), foot_jacobian(leg, q));
  EXPECT_EQ(kCentre.ideal_offset(-n, n), Vec3::Zero());
  EXPECT_EQ(kCentre.stance_travel(leg, {.twist = {{0.0, 0.0}, 0.7}, .duration = 0.3}),
            Vec3::Zero());
}

TEST(RollingFoot, CentreAndContactAreInverse) {
  const Vec3 p(1.0, 2.0, 3.0), n = Vec3(0.1, 0.2, 1.0).normalized();
  EXPECT_LT(distance(kRolling.centre_from_contact(kRolling.contact_point(p, n), n), p), 1e-15);
}

TEST(RollingFoot, IdealOffsetIsContinuousThroughTheUprightShank) {
  const auto offset = [](double tilt) {
    return kRolling.ideal_offset(Vec3(std::sin(tilt), 0.0, -std::cos(tilt)), Vec3::UnitZ()).x();
  };
  for (const double tilt : {1e-8, 0.9999e-4, 1.0001e-4, 0.5, 2.0})
    EXPECT_NEAR(offset(tilt), kRadius * tilt, 1e-15);
  EXPECT_TRUE(kRolling.ideal_offset(Vec3::UnitZ(), Vec3::UnitZ()).allFinite());
}

TEST(RollingFoot, IdealFootholdIkReachesTheIdealFoothold) {
  const LegGeometry leg = paper_leg(Leg::kFR);
  const Vec3 n_B = Vec3(0.1, -0.05, 1.0).normalized();
  for (const Vec3& p_HI :
       {Vec3(0.02, -0.06, -0.28), Vec3(-0.08, -0.1, -0.25), Vec3(0.1, 0.0, -0.3)}) {
    const IdealFootholdIk solution = kRolling.ideal_foothold_ik(leg, p_HI, n_B);
    ASSERT_TRUE(solution.valid());
    EXPECT_LE(solution.iterations, 14);
    const Vec3 p_HC = kRolling.contact_point(foot_position_H(leg, solution.ik.q), n_B);
    const Vec3 shank = -shank_rotation(solution.ik.q).col(2);
    EXPECT_LT(distance(p_HC + kRolling.ideal_offset(shank, n_B), p_HI), 1e-10);
  }
}

TEST(RollingFoot, IdealFootholdIkFlagsAShankThatWouldTouchTheGround) {
  const IdealFootholdIk solution =
      kRolling.ideal_foothold_ik(paper_leg(Leg::kFL), {0.0, 0.062, -0.04}, Vec3::UnitZ());
  EXPECT_FALSE(solution.valid());
}

}  // namespace
}  // namespace pirouette
