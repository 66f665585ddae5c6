// Turns of any radius and paths in the real closed loop: Kalman filter, sensor noise and biases on.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/trial.hpp"

namespace pirouette {
namespace {

using test::spin;

constexpr double kMissing = 1e9;  // mm

std::string seed_of(int seed) { return "run.seed=" + std::to_string(seed); }

std::string velocity(double x, double y) {
  return "run.velocity=[" + std::to_string(x) + ", " + std::to_string(y) + "]";
}

/// Circle of `radius` (m) at `rate` (rad/s), walked forwards.
Metrics circle(double radius, double rate, const std::vector<std::string>& more) {
  std::vector<std::string> overrides = {"run.rate=" + std::to_string(rate),
                                        velocity(radius * std::abs(rate), 0.0)};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return spin(overrides);
}

class TurnOnTheFlat : public testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(TurnOnTheFlat, EightTurnsStayWithinFiveMillimetresOfTheCircle) {
  const auto [radius, rate] = GetParam();
  for (int seed = 1; seed <= 3; ++seed) {
    const Metrics m = circle(radius, rate, {seed_of(seed)});
    EXPECT_FALSE(m.fell);
    EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-3);
    EXPECT_LE(m.path.cross_track_mean_mm.value_or(kMissing), 5.0) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, TurnOnTheFlat,
                         testing::Combine(testing::Values(0.25, 0.5, 1.0),
                                          testing::Values(0.7, -0.7)));

TEST(TurnWithTrueState, TheTrackerItselfStaysWithinTwoMillimetresAtEveryRadius) {
  for (const double radius : {0.25, 0.5, 1.0}) {
    for (const double rate : {0.7, -0.7}) {
      const Metrics m = circle(radius, rate, {"estimation.source=truth", "run.turns=2"});
      EXPECT_FALSE(m.fell) << radius << " " << rate;
      EXPECT_LE(m.path.cross_track_mean_mm.value_or(kMissing), 2.0) << radius << " " << rate;
    }
  }
}

TEST(TurnInEveryDirection, BackwardsAndSidewaysAreAsGoodAsForwards) {
  constexpr double kSpeed = 0.175;  // m/s: a radius of 0.25 m
  for (const auto& [x, y] : {std::pair{-kSpeed, 0.0}, {0.0, kSpeed}, {0.0, -kSpeed}}) {
    const Metrics m = spin({velocity(x, y), "run.turns=3"});
    EXPECT_FALSE(m.fell) << x << " " << y;
    EXPECT_LE(m.path.cross_track_mean_mm.value_or(kMissing), 5.0) << x << " " << y;
  }
}

TEST(StraightWalking, KeepsToTheLine) {
  const Metrics m = spin({"run.rate=0", velocity(0.3, 0.0), "run.turns=1"});
  EXPECT_FALSE(m.fell);
  // 4.5 m on: a yaw that is wrong by 2 mrad leaves the line by 9 mm there.
  EXPECT_LE(m.path.cross_track_mean_mm.value_or(kMissing), 10.0);
}

class PathOnTheFlat : public testing::TestWithParam<const char*> {};

TEST_P(PathOnTheFlat, TwoLapsStayOnThePath) {
  for (int seed = 1; seed <= 5; ++seed) {
    const Metrics m = spin({std::string("run.path=") + GetParam(), seed_of(seed)});
    EXPECT_FALSE(m.fell);
    EXPECT_LE(m.path.cross_track_mean_mm.value_or(kMissing), 10.0) << "seed " << seed;
    EXPECT_LE(m.path.along_track_mean_mm.value_or(kMissing), 15.0) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, PathOnTheFlat, testing::Values("figure8", "square"));

TEST(SpinOnThePoint, HasNoPathToLeave) {
  const Metrics m = spin({"run.turns=0.1", "run.settle_time=0.2"});
  EXPECT_FALSE(m.path.cross_track_mean_mm.has_value());
  EXPECT_FALSE(m.path.along_track_mean_mm.has_value());
}

}  // namespace
}  // namespace pirouette
