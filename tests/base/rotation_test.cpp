#include "pirouette/base/rotation.hpp"

#include <gtest/gtest.h>

#include "pirouette/base/planar_twist.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

TEST(Rotation, YawUnwrapsAsNumpyDoes) {
  const auto& section = test::vectors("yaw_unwrap");
  YawUnwrapper unwrapper;
  for (std::size_t i = 0; i < section.at("wrapped").size(); ++i) {
    EXPECT_NEAR(unwrapper.update(section.at("wrapped")[i].get<double>()),
                section.at("unwrapped")[i].get<double>(), section.at("tol").get<double>());
  }
}

TEST(Rotation, RollPitchYawRoundTrips) {
  const RollPitchYaw rpy{0.3, -0.7, 2.9};
  const RollPitchYaw back = rpy_from_rotation(rotation_from_rpy(rpy));
  EXPECT_NEAR(back.roll, rpy.roll, 1e-14);
  EXPECT_NEAR(back.pitch, rpy.pitch, 1e-14);
  EXPECT_NEAR(back.yaw, rpy.yaw, 1e-14);
}

TEST(Rotation, NoseUpIsNegativePitchAndLeftSideUpIsPositiveRoll) {
  EXPECT_GT((rotation_from_rpy({0.0, -0.1, 0.0}) * Vec3::UnitX()).z(), 0.0);
  EXPECT_GT((rotation_from_rpy({0.1, 0.0, 0.0}) * Vec3::UnitY()).z(), 0.0);
}

TEST(Rotation, LogarithmInvertsExponentialUpToAHalfTurn) {
  const Vec3 axis = Vec3(0.3, -0.5, 0.8).normalized();
  for (const double angle : {0.0, 1e-13, 1e-9, 1e-4, 0.5, 3.1}) {
    EXPECT_LT(distance(log_so3(exp_so3(angle * axis)), angle * axis), 1e-12) << angle;
  }
}

TEST(Rotation, SkewIsTheCrossProduct) {
  const Vec3 a(1.0, -2.0, 3.0), b(0.5, 0.25, -4.0);
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

TEST(PlanarTwist, SeriesMeetsTheClosedFormAtTheSwitch) {
  const Vec2 v(0.4, -0.3);
  const Vec2 below = planar_twist_displacement(v, 0.9999e-4, 1.0);
  const Vec2 above = planar_twist_displacement(v, 1.0001e-4, 1.0);
  EXPECT_LT(distance(below, above), 2e-8 * v.norm());  // the yaw rates differ by 2e-8
  EXPECT_EQ(planar_twist_displacement(v, 0.0, 2.0), Vec2(2.0 * v));
}

TEST(PlanarTwist, DrivesACircleOfRadiusSpeedOverYawRate) {
  const Vec2 half_turn = planar_twist_displacement({0.3, 0.0}, 0.5, kPi / 0.5);
  EXPECT_LT(distance(half_turn, Vec2(0.0, 2.0 * 0.3 / 0.5)), 1e-15);
}

}  // namespace
}  // namespace pirouette
