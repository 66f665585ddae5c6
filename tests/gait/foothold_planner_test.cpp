#include "pirouette/gait/foothold_planner.hpp"

#include <gtest/gtest.h>

#include "pirouette/base/rotation.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::to_vec2;

// A trot with FR and RL in the air, 0.1 s before they land.
FootholdInput spin_input(double yaw_rate) {
  FootholdInput in;
  in.gait.walking = true;
  in.gait.stance_duration = 0.3;
  in.gait.swing_duration = 0.2;
  for (const Leg leg : kLegs) {
    const bool swings = leg == Leg::kFR || leg == Leg::kRL;
    in.gait.leg[leg] = {.stance = !swings,
                        .progress = 0.5,
                        .duration = swings ? 0.2 : 0.3,
                        .time_remaining = swings ? 0.1 : 0.15,
                        .stride = 1};
    in.nominal_H[leg] = {fore_sign(leg) * 0.19, side_sign(leg) * 0.111};
  }
  in.twist.yaw_rate = yaw_rate;
  return in;
}

TEST(FootholdPlanner, TurningFootholdMatchesTheExponentialOfTheTwist) {
  const auto& section = test::vectors("foothold");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    const Vec2 foothold_H =
        turning_foothold(to_vec2(c.at("hip_xy")), to_vec2(c.at("v")), c.at("omega"), c.at("dt"));
    EXPECT_LT(distance(foothold_H, to_vec2(c.at("foothold_body_now"))), tol);
    const Vec2 foothold_W = to_vec2(c.at("base_xy")) + rot2(c.at("base_yaw")) * foothold_H;
    EXPECT_LT(distance(foothold_W, to_vec2(c.at("foothold_world"))), tol);
  }
}

TEST(FootholdPlanner, SpinStepsAreChordsOfTheFootCircle) {
  // At lift-off of a 0.25 s swing and a 0.25 s stance at 0.7 rad/s the foot is aimed 0.2625 rad
  // ahead.
  const Vec2 hip(0.19, -0.111);
  const Vec2 foothold = turning_foothold(hip, Vec2::Zero(), 0.7, 0.375);
  EXPECT_NEAR(foothold.norm(), hip.norm(), 1e-15);
  EXPECT_NEAR((foothold - hip).norm(), 2.0 * hip.norm() * std::sin(0.2625 / 2.0), 1e-15);
}

TEST(FootholdPlanner, FeetOfAnIdealSpinSurroundTheCentreOfMass) {
  FootholdInput in = spin_input(0.7);
  in.p_WG = {0.3, -0.2};
  in.yaw = 1.1;
  const FootholdPlan plan = FootholdPlanner({}).update(in);
  const Vec2 swing_middle = 0.5 * (plan[Leg::kFR].p_WC + plan[Leg::kRL].p_WC).head<2>();
  const Vec2 stance_middle = 0.5 * (plan[Leg::kFL].p_WC + plan[Leg::kRR].p_WC).head<2>();
  EXPECT_LT(distance(swing_middle, in.p_WG), 1e-15);
  EXPECT_LT(distance(stance_middle, in.p_WG), 1e-15);
}

TEST(FootholdPlanner, TimeRunsToTheMiddleOfTheComingStance) {
  const FootholdInput in = spin_input(0.7);
  const FootholdPlan plan = FootholdPlanner({}).update(in);
  const Vec2 swinging = rot2(0.7 * (0.1 + 0.15)) * in.nominal_H[Leg::kFR];
  const Vec2 standing = rot2(0.7 * (0.15 + 0.2 + 0.15)) * in.nominal_H[Leg::kFL];
  EXPECT_LT(distance(plan[Leg::kFR].p_WC.head<2>(), swinging), 1e-15);
  EXPECT_LT(distance(plan[Leg::kFL].p_WC.head<2>(), standing), 1e-15);
}

TEST(FootholdPlanner, AFootThatStaysDownHasItsNominalPoint) {
  FootholdInput in = spin_input(0.7);
  for (LegPhase& leg : in.gait.leg) leg.time_remaining = std::numeric_limits<double>::infinity();
  const FootholdPlan plan = FootholdPlanner({}).update(in);
  for (const Leg leg : kLegs)
    EXPECT_LT(distance(plan[leg].p_WC.head<2>(), in.nominal_H[leg]), 1e-15);
}

TEST(FootholdPlanner, YawTurnsThePlanAroundTheCentreOfMass) {
  FootholdInput in = spin_input(0.7);
  in.twist.v_H = {0.2, -0.1};
  in.v_WG_H = {0.25, 0.0};
  const FootholdPlan plan = FootholdPlanner({}).update(in);
  in.yaw = 0.9;
  in.p_WG = {1.0, 2.0};
  const FootholdPlan turned = FootholdPlanner({}).update(in);
  for (const Leg leg : kLegs) {
    const Vec2 expected = in.p_WG + rot2(in.yaw) * plan[leg].p_WC.head<2>();
    EXPECT_LT(distance(turned[leg].p_WC.head<2>(), expected), 1e-15);
  }
}

TEST(FootholdPlanner, MirroredCommandsGiveMirroredFootholds) {
  FootholdInput left = spin_input(0.7), right = spin_input(-0.7);
  left.twist.v_H = {0.2, 0.1};
  right.twist.v_H = {0.2, -0.1};
  for (const Leg leg : kLegs) right.gait.leg[leg] = left.gait.leg[Leg::kFR];
  left.gait.leg = right.gait.leg;
  const FootholdPlan a = FootholdPlanner({}).update(left), b = FootholdPlanner({}).update(right);
  const Vec3 mirrored = a[Leg::kFL].p_WC.cwiseProduct(Vec3(1.0, -1.0, 1.0));
  EXPECT_LT(distance(mirrored, b[Leg::kFR].p_WC), 1e-15);
}

TEST(FootholdPlanner, FeedbackStepsIntoTheVelocityError) {
  FootholdInput in = spin_input(0.0);
  in.v_WG_H = {0.1, -0.05};
  FootholdConfig config;
  config.velocity_gain = 0.03;
  const FootholdPlan with = FootholdPlanner(config).update(in);
  config.feedback = false;
  const FootholdPlan without = FootholdPlanner(config).update(in);
  const Vec2 shift = (with[Leg::kFR].p_WC - without[Leg::kFR].p_WC).head<2>();
  EXPECT_LT(distance(shift, Vec2((0.15 + 0.03) * in.v_WG_H)), 1e-15);
}

TEST(FootholdPlanner, AQuickStepGoesToTheCapturePoint) {
  FootholdInput in = spin_input(0.0);
  in.v_WG_H = {0.1, -0.05};
  in.gait.stance_duration = 0.1;
  const FootholdPlan resting = [&] {
    FootholdInput still = in;
    still.v_WG_H.setZero();
    return FootholdPlanner({}).update(still);
  }();
  in.capture_time = 0.166;
  const Vec2 shift =
      (FootholdPlanner({}).update(in)[Leg::kFR].p_WC - resting[Leg::kFR].p_WC).head<2>();
  EXPECT_LT(distance(shift, Vec2(0.166 * in.v_WG_H)), 1e-15);
}

TEST(FootholdPlanner, FootholdsStayWithinReachOfTheirNominalPoint) {
  FootholdInput in = spin_input(0.7);
  in.v_WG_H = {5.0, -3.0};
  FootholdConfig config;
  config.max_offset = 0.1;
  const FootholdPlan plan = FootholdPlanner(config).update(in);
  for (const Leg leg : kLegs) {
    EXPECT_NEAR((plan[leg].p_WC.head<2>() - in.nominal_H[leg]).norm(), 0.1, 1e-12);
  }
}

TEST(FootholdPlanner, RollingShiftIsTakenOffInMidStanceAxes) {
  FootholdInput in = spin_input(0.7);
  const FootholdPlan plain = FootholdPlanner({}).update(in);
  in.rolling_shift_H[Leg::kFR] = {0.002, -0.001};
  const FootholdPlan shifted = FootholdPlanner({}).update(in);
  const Vec2 moved = (shifted[Leg::kFR].p_WC - plain[Leg::kFR].p_WC).head<2>();
  EXPECT_LT(distance(moved, Vec2(-(rot2(0.7 * 0.25) * in.rolling_shift_H[Leg::kFR]))), 1e-15);
}

TEST(FootholdPlanner, FootholdsLieOnThePlaneAndCentresAboveItAlongTheNormal) {
  FootholdInput in = spin_input(0.7);
  in.plane = {.a0 = 0.05, .a1 = 0.2, .a2 = -0.1};
  in.centre_offset = PerLeg<double>::filled(0.0225);
  for (const Foothold& foothold : FootholdPlanner({}).update(in)) {
    EXPECT_NEAR(foothold.p_WC.z(), in.plane.height(foothold.p_WC.head<2>()), 1e-15);
    EXPECT_LT(distance(foothold.p_WF, foothold.p_WC + 0.0225 * in.plane.normal()), 1e-15);
    EXPECT_LT(distance(foothold.n_W, in.plane.normal()), 1e-15);
  }
}

}  // namespace
}  // namespace pirouette
