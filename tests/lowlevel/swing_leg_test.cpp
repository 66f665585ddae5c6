#include "pirouette/lowlevel/swing_leg.hpp"

#include <gtest/gtest.h>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kExact = 1e-14;

SwingInput step_up() {
  SwingInput in;
  in.p_WF_liftoff = {0.1, -0.2, 0.02};
  in.p_WF_target = {0.17, -0.16, 0.05};
  in.duration = 0.25;
  in.clearance = 0.06;
  return in;
}

SwingTarget at(SwingInput in, double progress) {
  in.progress = progress;
  return swing_target(in);
}

TEST(SwingLeg, LeavesAndArrivesAtRestWhereAsked) {
  const SwingInput in = step_up();
  for (const double progress : {0.0, 1.0}) {
    const SwingTarget end = at(in, progress);
    const Vec3& p_WF = progress == 0.0 ? in.p_WF_liftoff : in.p_WF_target;
    EXPECT_LT(distance(end.p_WF, p_WF), kExact);
    EXPECT_LT(end.v_WF_W.norm(), kExact);
    EXPECT_LT(end.a_WF_W.norm(), 1e-12);  // curvature of order 1 / duration^2
  }
}

TEST(SwingLeg, StaysAtItsEndsBeyondThem) {
  const SwingInput in = step_up();
  EXPECT_EQ(at(in, -0.2).p_WF, at(in, 0.0).p_WF);
  EXPECT_EQ(at(in, 1.3).p_WF, at(in, 1.0).p_WF);
}

TEST(SwingLeg, PassesItsApexAtMidSwingWithTheClearanceAboveTheHigherEnd) {
  for (const bool up : {true, false}) {
    SwingInput in = step_up();
    if (!up) std::swap(in.p_WF_liftoff, in.p_WF_target);
    const SwingTarget apex = at(in, 0.5);
    EXPECT_NEAR(apex.p_WF.z(), 0.05 + in.clearance, kExact);
    EXPECT_NEAR(apex.v_WF_W.z(), 0.0, kExact);
    EXPECT_LT(distance(apex.p_WF.head<2>(), 0.5 * (in.p_WF_liftoff + in.p_WF_target).head<2>()),
              kExact);
    for (double s = 0.0; s <= 1.0; s += 0.01) {
      EXPECT_LE(at(in, s).p_WF.z(), apex.p_WF.z() + kExact);
      EXPECT_GE(at(in, s).p_WF.z(), 0.02 - kExact);
    }
  }
}

TEST(SwingLeg, VelocityAndAccelerationAreTheDerivatives) {
  constexpr double kStep = 1e-6;  // of the progress
  const SwingInput in = step_up();
  const double dt = kStep * in.duration;
  for (double s = 0.013; s < 1.0; s += 0.02) {  // beside 0.5, where the third derivative jumps
    const SwingTarget before = at(in, s - kStep), now = at(in, s), after = at(in, s + kStep);
    // Rounding over the step: 1e-17 m and 1e-16 m/s over 2.5e-7 s.
    EXPECT_LT(distance(now.v_WF_W, (after.p_WF - before.p_WF) / (2.0 * dt)), 1e-9);
    EXPECT_LT(distance(now.a_WF_W, (after.v_WF_W - before.v_WF_W) / (2.0 * dt)), 1e-8);
  }
}

TEST(SwingLeg, IsContinuousUpToTheAccelerationAtTheApex) {
  constexpr double kStep = 1e-9;  // of the progress
  const SwingTarget before = at(step_up(), 0.5 - kStep), after = at(step_up(), 0.5 + kStep);
  EXPECT_LT(distance(before.p_WF, after.p_WF), 1e-9);
  EXPECT_LT(distance(before.v_WF_W, after.v_WF_W), 1e-8);
  EXPECT_LT(distance(before.a_WF_W, after.a_WF_W), 1e-5);  // kStep times a jerk below 10^3 m/s^3
}

TEST(SwingLeg, DoesNotKickWhenItsTargetMoves) {
  // At both ends a moved target changes neither velocity nor acceleration.
  SwingInput moved = step_up();
  moved.p_WF_target += Vec3(0.05, -0.03, 0.0);
  for (const double progress : {0.0, 1.0}) {
    EXPECT_LT(distance(at(moved, progress).v_WF_W, at(step_up(), progress).v_WF_W), kExact);
    EXPECT_LT(distance(at(moved, progress).a_WF_W, at(step_up(), progress).a_WF_W), 1e-12);
  }
}

}  // namespace
}  // namespace pirouette
