#include "pirouette/controller/joint_friction.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

LegGeometry rough_leg() {
  LegGeometry leg;
  leg.dry_friction = Vec3(0.2, 0.3, 0.4);
  leg.damping = Vec3(0.01, 0.02, 0.03);
  return leg;
}

TEST(JointFriction, IsDryPlusViscousFrictionOfAMovingJoint) {
  const LegGeometry leg = rough_leg();
  const Vec3 dq(2.0, -3.0, 5.0);
  const Vec3 expected = Vec3(0.2, -0.3, 0.4) + leg.damping.cwiseProduct(dq);
  EXPECT_LT((joint_friction(leg, dq) - expected).norm(), 1e-12);  // tanh(40) is 1
}

TEST(JointFriction, IsOddAndSmoothThroughStandstill) {
  const LegGeometry leg = rough_leg();
  const Vec3 noise = Vec3::Constant(1e-4);
  EXPECT_EQ(joint_friction(leg, Vec3::Zero()), Vec3::Zero());
  EXPECT_EQ(joint_friction(leg, noise), -joint_friction(leg, -noise));
  EXPECT_LT(joint_friction(leg, noise).norm(), 0.01 * leg.dry_friction.norm());
}

}  // namespace
}  // namespace pirouette
