// The reference and its continuation against closed forms and their own derivatives.
#include "pirouette/controller/body_horizon.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kHeight = 0.29;  // m
// Central differences: the cut-off terms are about kStep^2, rounding 1e-16 / kStep.
constexpr double kStep = 1e-5;
constexpr double kDifference = 1e-8;

TerrainPlane slope() {
  TerrainPlane plane;
  plane.a0 = 0.03;
  plane.a1 = 0.25;
  plane.a2 = -0.12;
  return plane;
}

/// A robot that turns on a slope, its heading off the path's and its CoM off the plan's.
HorizonInput turning(double yaw_rate) {
  HorizonInput in;
  in.plane = slope();
  in.path.yaw = 0.8;
  in.yaw = 0.7;
  in.twist = {Vec2(0.3, -0.1), yaw_rate};
  in.com_plan.p_WG = Vec2(0.51, -0.2);
  in.p_WG = Vec2(0.5, -0.2);
  in.com_height = kHeight;
  return in;
}

const std::vector<double> kYawRates = {-4.0, -0.7, 0.0, 0.7, 2.0};

TEST(BodyReference, IsTheCommandedTwistInTheRobotsHeadingAlongThePlane) {
  const HorizonInput in = turning(0.7);
  const BodyReference out = body_reference(in);
  const Vec2 v_xy = rot2(0.7) * Vec2(0.3, -0.1);
  EXPECT_LT(distance(out.v_WG_W.head<2>(), v_xy), 1e-15);
  EXPECT_NEAR(out.v_WG_W.dot(in.plane.normal()), 0.0, 1e-15);
  EXPECT_LT(distance(out.p_WG.head<2>(), Vec2(0.51, -0.2)), 1e-15);
  EXPECT_NEAR(out.p_WG.z(), in.plane.height(0.51, -0.2) + kHeight, 1e-15);
  EXPECT_EQ(out.rpy.yaw, 0.8);
}

TEST(BodyReference, StaysNearTheMeasuredCentreOfMass) {
  HorizonInput in = turning(0.7);
  in.com_plan.p_WG = Vec2(0.5, 0.3);
  const BodyReference out = body_reference(in);
  EXPECT_LT(distance(out.p_WG.head<2>(), Vec2(0.5, -0.2 + in.max_lead)), 1e-15);
}

TEST(BodyReference, AcceleratesTowardsTheCentreOfTheTurn) {
  for (const double yaw_rate : kYawRates) {
    const HorizonInput in = turning(yaw_rate);
    const BodyReference now = body_reference(in);
    const Vec3 change = reference_after(now, in.plane, kHeight, kStep).v_WG_W -
                        reference_after(now, in.plane, kHeight, -kStep).v_WG_W;
    EXPECT_LT(distance(now.a_WG_W, change / (2.0 * kStep)), kDifference) << yaw_rate;
  }
}

TEST(ReferenceAfter, BeginsAtTheReference) {
  for (const double yaw_rate : kYawRates) {
    const HorizonInput in = turning(yaw_rate);
    const BodyReference now = body_reference(in);
    const BodyMotion same = reference_after(now, in.plane, kHeight, 0.0);
    EXPECT_LT(distance(same.p_WG, now.p_WG), 1e-15);
    EXPECT_LT(distance(same.v_WG_W, now.v_WG_W), 1e-15);
    EXPECT_LT(distance(same.w_WB_W, now.w_WB_W), 1e-15);
    EXPECT_LT(distance(same.rpy, Vec3(now.rpy.roll, now.rpy.pitch, now.rpy.yaw)), 1e-15);
  }
}

TEST(ReferenceAfter, MovesAsItsVelocitySays) {
  for (const double yaw_rate : kYawRates) {
    const HorizonInput in = turning(yaw_rate);
    const BodyReference now = body_reference(in);
    for (const double t : {0.1, 0.45, 1.3}) {
      const BodyMotion before = reference_after(now, in.plane, kHeight, t - kStep);
      const BodyMotion here = reference_after(now, in.plane, kHeight, t);
      const BodyMotion after = reference_after(now, in.plane, kHeight, t + kStep);
      EXPECT_LT(distance((after.p_WG - before.p_WG) / (2.0 * kStep), here.v_WG_W), kDifference);
      EXPECT_NEAR(here.rpy.z(), 0.8 + yaw_rate * t, 1e-14);
      // R' R^T is the cross product with the angular velocity.
      const auto rotation = [](const BodyMotion& m) {
        return rotation_from_rpy({m.rpy.x(), m.rpy.y(), m.rpy.z()});
      };
      const Mat3 W =
          (rotation(after) - rotation(before)) / (2.0 * kStep) * rotation(here).transpose();
      EXPECT_LT(distance(Vec3(W(2, 1), W(0, 2), W(1, 0)), here.w_WB_W), kDifference);
    }
  }
}

// The closed form on the level: a circle of radius v / w.
TEST(ReferenceAfter, OfATwistIsACircle) {
  HorizonInput in = turning(2.0);
  in.plane = TerrainPlane{};
  const BodyReference now = body_reference(in);
  const Vec2 v = now.v_WG_W.head<2>();
  const Vec2 centre = now.p_WG.head<2>() + Vec2(-v.y(), v.x()) / 2.0;
  for (double t = 0.0; t < 4.0; t += 0.1) {
    const BodyMotion here = reference_after(now, in.plane, kHeight, t);
    EXPECT_LT(distance(here.p_WG.head<2>(), centre + rot2(2.0 * t) * (now.p_WG.head<2>() - centre)),
              1e-13);
    EXPECT_LT(distance(here.v_WG_W.head<2>(), rot2(2.0 * t) * v), 1e-13);
  }
}

}  // namespace
}  // namespace pirouette
