#include "pirouette/terrain/plane_estimator.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::to_vec3;

const TerrainPlane kSlope{.a0 = 0.1, .a1 = 0.2, .a2 = -0.3};

TerrainConfig unfiltered() {
  TerrainConfig config;
  config.filter_time = 0.0;
  config.ridge = 0.0;
  return config;
}

PlaneInput feet_on(const TerrainPlane& plane, const Vec2& centre = Vec2::Zero()) {
  PlaneInput in;
  for (const Leg leg : kLegs) {
    const Vec2 xy = centre + Vec2(fore_sign(leg) * 0.19, side_sign(leg) * 0.111);
    in.p_WC[leg] << xy, plane.height(xy);
    in.touching[leg] = true;
  }
  return in;
}

void expect_plane(const TerrainPlane& plane, const TerrainPlane& expected, double tolerance) {
  EXPECT_NEAR(plane.a0, expected.a0, tolerance);
  EXPECT_NEAR(plane.a1, expected.a1, tolerance);
  EXPECT_NEAR(plane.a2, expected.a2, tolerance);
}

TEST(PlaneFit, MatchesNumpyLeastSquares) {
  const auto& section = test::vectors("terrain_plane");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    std::vector<Vec3> points;
    for (const auto& p : c.at("points")) points.push_back(to_vec3(p));
    const std::vector<double> weights = c.at("weights");
    const TerrainPlane plane = fit_plane(points, weights, {}, 2.5e-3, 0.0);
    const Vec3 a = to_vec3(c.at("a"));
    EXPECT_LT(distance(Vec3(plane.a0, plane.a1, plane.a2), a), tol);
    EXPECT_LT(distance(plane.normal(), to_vec3(c.at("n"))), tol);
    const RollPitchYaw rpy = terrain_aligned_rpy(plane, c.at("yaw"));
    EXPECT_NEAR(rpy.roll, c.at("roll").get<double>(), tol);
    EXPECT_NEAR(rpy.pitch, c.at("pitch").get<double>(), tol);
  }
}

TEST(PlaneFit, CollinearFeetKeepThePreviousSlopeAcrossTheirLine) {
  const std::vector<Vec3> line = {{-0.2, 0.0, -0.02}, {0.0, 0.0, 0.0}, {0.2, 0.0, 0.02}};
  const std::vector<double> weights(3, 1.0);
  expect_plane(fit_plane(line, weights, kSlope, 2.5e-3, 0.0),
               {.a0 = 0.0, .a1 = 0.1, .a2 = kSlope.a2}, 1e-12);
}

TEST(PlaneFit, OneContactOnlyMovesTheHeight) {
  const std::vector<Vec3> point = {{0.5, -0.2, 0.4}};
  const std::vector<double> weight = {1.0};
  const TerrainPlane plane = fit_plane(point, weight, kSlope, 2.5e-3, 1e-3);
  EXPECT_NEAR(plane.height(0.5, -0.2), 0.4, 1e-15);
  EXPECT_NEAR(plane.a1, kSlope.a1, 1e-15);
  EXPECT_NEAR(plane.a2, kSlope.a2, 1e-15);
}

TEST(PlaneFit, NoWeightAtAllKeepsThePreviousPlane) {
  const std::vector<Vec3> points(4, Vec3(1.0, 2.0, 3.0));
  const std::vector<double> weights(4, 0.0);
  const TerrainPlane plane = fit_plane(points, weights, kSlope, 2.5e-3, 1e-3);
  expect_plane(plane, kSlope, 0.0);
  EXPECT_EQ(plane.weight, 0.0);
}

TEST(PlaneFit, SphereCentresLieOnThePlaneShiftedByTheRadius) {
  const double r = 0.0225;
  PlaneInput in = feet_on(kSlope);
  for (Vec3& p : in.p_WC) p += r * kSlope.normal();
  const std::array<double, 4> weights = {1.0, 1.0, 1.0, 1.0};
  const TerrainPlane plane = fit_plane(in.p_WC.values, weights, {}, 2.5e-3, 0.0);
  const double shift = r * std::sqrt(1.0 + square(kSlope.a1) + square(kSlope.a2));
  expect_plane(plane, {.a0 = kSlope.a0 + shift, .a1 = kSlope.a1, .a2 = kSlope.a2}, 1e-14);
}

TEST(PlaneFit, ResidualIsTheScatterAboutThePlane) {
  PlaneInput in = feet_on({});
  for (const Leg leg : kLegs)
    in.p_WC[leg].z() = (leg == Leg::kFR || leg == Leg::kRL) ? 0.01 : -0.01;
  const std::array<double, 4> weights = {1.0, 1.0, 1.0, 1.0};
  EXPECT_NEAR(fit_plane(in.p_WC.values, weights, {}, 2.5e-3, 0.0).residual_rms, 0.01, 1e-15);
}

TEST(TerrainAlignment, TrunkStandsAlongTheNormalAndLooksWhereTold) {
  for (const double yaw : {0.0, 0.7, -2.5}) {
    const Mat3 R_WB = rotation_from_rpy(terrain_aligned_rpy(kSlope, yaw));
    EXPECT_LT(distance(R_WB.col(2), kSlope.normal()), 1e-15);
    EXPECT_NEAR(std::atan2(R_WB(1, 0), R_WB(0, 0)), yaw, 1e-15);
  }
}

TEST(TerrainAlignment, UphillAheadIsNoseUp) {
  EXPECT_LT(terrain_aligned_rpy({.a0 = 0.0, .a1 = 0.2}, 0.0).pitch, 0.0);
  EXPECT_GT(terrain_aligned_rpy({.a0 = 0.0, .a2 = 0.2}, 0.0).roll, 0.0);
}

TEST(TerrainAlignment, RateIsTheDerivativeOfTheAttitude) {
  constexpr double kStep = 1e-5, kYawRate = 0.7;
  for (const double yaw : {0.0, 0.7, -2.5}) {
    const Mat3 before = rotation_from_rpy(terrain_aligned_rpy(kSlope, yaw - kYawRate * kStep));
    const Mat3 after = rotation_from_rpy(terrain_aligned_rpy(kSlope, yaw + kYawRate * kStep));
    const Vec3 rate = log_so3(after * before.transpose()) / (2.0 * kStep);
    EXPECT_LT(distance(terrain_aligned_rate(kSlope, yaw, kYawRate), rate), 1e-9);
  }
}

TEST(PlaneEstimator, FindsThePlaneUnderFourFeet) {
  PlaneEstimator estimator(unfiltered());
  const TerrainPlane plane = estimator.update(feet_on(kSlope), 0.002);
  expect_plane(plane, kSlope, 1e-14);
  EXPECT_EQ(plane.weight, 4.0);
}

TEST(PlaneEstimator, RemembersLiftedFeetWithFadingWeight) {
  PlaneEstimator estimator(unfiltered());
  PlaneInput in = feet_on(kSlope);
  estimator.update(in, 0.002);
  in.touching[Leg::kFR] = in.touching[Leg::kRL] = false;
  in.p_WC[Leg::kFR].z() = in.p_WC[Leg::kRL].z() = 1.0;  // in the air: must not count
  TerrainPlane plane;
  for (int i = 0; i < 75; ++i) plane = estimator.update(in, 0.002);
  expect_plane(plane, kSlope, 1e-14);
  EXPECT_NEAR(plane.weight, 2.0 + 2.0 * std::exp(-0.15 / 0.3), 1e-12);
  for (int i = 0; i < 500; ++i) plane = estimator.update(in, 0.002);
  EXPECT_EQ(plane.weight, 2.0);
}

TEST(PlaneEstimator, KeepsThePlaneWhenTooLittleIsKnown) {
  PlaneEstimator estimator(unfiltered());
  estimator.reset(kSlope);
  PlaneInput in = feet_on({});
  for (const Leg leg : kLegs) in.touching[leg] = leg == Leg::kFR;
  expect_plane(estimator.update(in, 0.002), kSlope, 0.0);
}

TEST(PlaneEstimator, LimitsTheSlopeAboutTheFeet) {
  TerrainConfig config = unfiltered();
  config.max_slope = 0.5;
  PlaneEstimator estimator(config);
  const Vec2 centre(1.0, 2.0);
  const TerrainPlane steep{.a0 = 0.1, .a1 = 0.8, .a2 = -0.6};
  const TerrainPlane plane = estimator.update(feet_on(steep, centre), 0.002);
  EXPECT_NEAR(std::hypot(plane.a1, plane.a2), 0.5, 1e-14);
  EXPECT_NEAR(plane.height(centre), steep.height(centre), 1e-14);
}

TEST(PlaneEstimator, ApproachesANewPlaneWithItsTimeConstantWhereverTheRobotIs) {
  TerrainConfig config = unfiltered();
  config.filter_time = 0.3;
  for (const Vec2& centre : {Vec2(0.0, 0.0), Vec2(50.0, -20.0)}) {
    PlaneEstimator estimator(config);
    TerrainPlane plane;
    for (int i = 0; i < 150; ++i) plane = estimator.update(feet_on(kSlope, centre), 0.002);
    const double share = 1.0 - std::exp(-1.0);
    EXPECT_NEAR(plane.a1, share * kSlope.a1, 1e-12);
    EXPECT_NEAR(plane.height(centre), share * kSlope.height(centre), 1e-11);
  }
}

TEST(PlaneEstimator, TakesTheRememberedPlaneInPlaceOfTheFeets) {
  PlaneEstimator estimator(unfiltered());
  const TerrainPlane remembered{
      .a0 = -0.05, .a1 = 0.1, .a2 = 0.15, .residual_rms = 0.012, .weight = 80.0};
  PlaneInput in = feet_on(kSlope, Vec2(1.0, -2.0));
  in.remembered = remembered;
  const TerrainPlane plane = estimator.update(in, 0.002);
  expect_plane(plane, remembered, 1e-14);
  EXPECT_EQ(plane.residual_rms, remembered.residual_rms);
  EXPECT_EQ(plane.weight, remembered.weight);

  in.remembered.reset();
  expect_plane(estimator.update(in, 0.002), kSlope, 1e-13);
}

TEST(PlaneEstimator, LimitsAndFiltersTheRememberedPlaneToo) {
  TerrainConfig config = unfiltered();
  config.max_slope = 0.5;
  config.filter_time = 0.3;
  PlaneEstimator estimator(config);
  const Vec2 centre(1.0, 2.0);
  PlaneInput in = feet_on({}, centre);
  in.remembered = TerrainPlane{.a0 = 0.1, .a1 = 0.8, .a2 = -0.6, .weight = 80.0};
  TerrainPlane plane;
  for (int i = 0; i < 150; ++i) plane = estimator.update(in, 0.002);
  const double share = 1.0 - std::exp(-1.0);
  EXPECT_NEAR(plane.a1, share * 0.4, 1e-12);
  EXPECT_NEAR(plane.a2, share * -0.3, 1e-12);
  EXPECT_NEAR(plane.height(centre), share * in.remembered->height(centre), 1e-12);
}

TEST(PlaneEstimator, SwitchedOffKeepsThePlaneItWasGiven) {
  TerrainConfig config;
  config.estimation = TerrainEstimation::kOff;
  PlaneEstimator estimator(config);
  const TerrainPlane floor{.a0 = 0.02};
  estimator.reset(floor);
  expect_plane(estimator.update(feet_on(kSlope), 0.002), floor, 0.0);
}

}  // namespace
}  // namespace pirouette
