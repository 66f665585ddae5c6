#include "pirouette/path/position_aid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kTick = 0.002;
const Vec2 kDrift(0.03, -0.02);  // m, by which the odometry is wrong

AidConfig without_ramp() {
  AidConfig config;
  config.ramp_time = 0.0;
  return config;
}

/// A robot that moves at `velocity` by its own odometry, watched from outside.
struct Watched {
  explicit Watched(const AidConfig& config) : offset(config) {}

  /// One tick; with `heard`, a measurement arrives that was taken `delay` (s) ago.
  Vec2 tick(bool heard, const Vec2& error = kDrift) {
    time += kTick;
    const Vec2 p_WB = time * velocity;
    std::optional<PositionAid> aid;
    if (heard) {
      aid.emplace();
      aid->time = time - delay;
      aid->p_WB.head<2>() = p_WB - delay * velocity + error;
    }
    return last = offset.update(aid, p_WB, time, kTick);
  }

  /// At `rate` (Hz).
  void run(double duration, double rate, const Vec2& error = kDrift) {
    const int every = static_cast<int>(std::lround(1.0 / (rate * kTick)));
    const int ticks = static_cast<int>(std::lround(duration / kTick));
    for (int i = 0; i < ticks; ++i) tick(i % every == 0, error);
  }

  PositionAidOffset offset;
  Vec2 velocity = Vec2::Zero();
  double delay = 0.0;
  double time = 0.0;
  Vec2 last = Vec2::Zero();
};

TEST(PositionAidOffset, ApproachesTheDifferenceWithItsTimeConstant) {
  const AidConfig config = without_ramp();
  Watched robot(config);
  robot.run(config.time_constant, 500.0);
  EXPECT_LT(distance(robot.last, (1.0 - std::exp(-1.0)) * kDrift), 1e-14);
  robot.run(30.0 * config.time_constant, 500.0);
  EXPECT_LT(distance(robot.last, kDrift), 1e-13);
}

TEST(PositionAidOffset, FollowsASlowAidAsFastAsAQuickOneButOnlyWhenItSpeaks) {
  const AidConfig config = without_ramp();
  Watched often(config), seldom(config);
  often.run(3.0, 500.0);
  seldom.run(3.0, 10.0);
  // The slow one's first word counts as one tick of the filter, and nothing follows its last.
  EXPECT_LT(distance(often.last, seldom.last), kDrift.norm() * 0.2 / config.time_constant);
  const Vec2 spoken = seldom.last;
  for (int i = 0; i < 40; ++i) seldom.tick(false);
  EXPECT_EQ(seldom.last, spoken);
}

TEST(PositionAidOffset, GainsInfluenceOverTheRamp) {
  const AidConfig config;
  Watched robot(config);
  robot.run(0.5, 500.0);
  // d offset/dt = t / (ramp T) (drift - offset): a Gaussian of time.
  const auto approached = [&](double t) {
    return 1.0 - std::exp(-square(t) / (2.0 * config.ramp_time * config.time_constant));
  };
  // Sums of ticks against the integral: one tick of half a second.
  EXPECT_NEAR(robot.last.norm() / kDrift.norm(), approached(0.5), 5e-3 * approached(0.5));
  robot.run(config.ramp_time - 0.5, 500.0);
  EXPECT_NEAR(robot.last.norm() / kDrift.norm(), approached(config.ramp_time), 1e-3);
}

TEST(PositionAidOffset, ComparesWithTheOdometryAtTheTimeOfTheMeasurement) {
  Watched robot(without_ramp());
  robot.velocity = Vec2(0.5, 0.2);
  robot.delay = 0.0507;  // between two ticks
  robot.run(100.0, 10.0);
  EXPECT_LT(distance(robot.last, kDrift), 1e-9);  // otherwise 25 mm off
}

TEST(PositionAidOffset, AMeasurementOlderThanItsMemoryIsNotUsed) {
  Watched robot(without_ramp());
  robot.velocity = Vec2(0.5, 0.2);
  robot.delay = 1.5;
  robot.run(10.0, 10.0);
  EXPECT_EQ(robot.last, Vec2::Zero());
}

TEST(PositionAidOffset, RemembersAsLongAtAFastRate) {
  PositionAidOffset offset(without_ramp());
  constexpr double kFastTick = 0.0005, kAge = 0.9;  // s
  const Vec2 velocity(0.5, 0.2);
  Vec2 last = Vec2::Zero();
  for (int i = 0; i < 40000; ++i) {
    const double time = i * kFastTick;
    std::optional<PositionAid> aid;
    if (i % 200 == 0) {
      aid.emplace();
      aid->time = time - kAge;
      aid->p_WB.head<2>() = aid->time * velocity + kDrift;
    }
    last = offset.update(aid, time * velocity, time, kFastTick);
  }
  // Measurements begin to be used after 0.9 s; exp(-19.1 s / 4 s) is still to come.
  EXPECT_LT(distance(last, kDrift), 0.01 * kDrift.norm());
}

TEST(PositionAidOffset, HoldsTheLastOffsetWhenTheAidIsLost) {
  const AidConfig config = without_ramp();
  Watched robot(config);
  robot.run(3.0, 10.0);
  for (int i = 0; i < static_cast<int>((config.timeout + 0.01) / kTick); ++i) robot.tick(false);
  const Vec2 held = robot.last;
  EXPECT_GT(held.norm(), 0.5 * kDrift.norm());
  robot.velocity = Vec2(0.1, 0.0);
  for (int i = 0; i < 5000; ++i) EXPECT_EQ(robot.tick(false), held);
}

TEST(PositionAidOffset, AnAidThatComesBackIsRampedInAgain) {
  const AidConfig config;
  Watched robot(config);
  robot.run(60.0, 10.0);
  for (int i = 0; i < 1000; ++i) robot.tick(false);
  const Vec2 held = robot.last;
  const Vec2 moved = kDrift + Vec2(0.1, 0.0);
  robot.run(0.1, 10.0, moved);
  // One tick at full influence would move it by 0.1 m * 2 ms / 4 s = 50 um; fifty by 2.5 mm.
  EXPECT_LT((robot.last - held).norm(), 0.05e-3);
  robot.run(60.0, 10.0, moved);
  EXPECT_LT(distance(robot.last, moved), 1e-6);
}

TEST(PositionAidOffset, BridgesShortDropOutsAtFullInfluence) {
  Watched robot(without_ramp());
  robot.run(2.0, 10.0);
  Watched unbroken = robot;
  for (int i = 0; i < 400; ++i) robot.tick(false);  // 0.8 s, below the timeout
  robot.run(0.002, 500.0);
  unbroken.run(0.802, 500.0);
  // One measurement after a gap does what many in it would have done.
  EXPECT_LT(distance(robot.last, unbroken.last), 0.03 * kDrift.norm());
}

TEST(PositionAidOffset, RejectsOutliers) {
  const AidConfig config = without_ramp();
  Watched robot(config);
  robot.run(40.0, 10.0);
  const Vec2 before = robot.last;
  const Vec2 jump = kDrift + Vec2(0.0, config.max_offset + 0.01);
  for (int i = 0; i < 100; ++i) robot.tick(i % 10 == 0, jump);
  EXPECT_LT(distance(robot.last, before), 1e-5);
  // Outliers alone are no aid.
  Watched misled(config);
  misled.run(5.0, 10.0, jump + Vec2(1.0, 0.0));
  EXPECT_EQ(misled.last, Vec2::Zero());
}

TEST(PositionAidOffset, AveragesTheNoiseOfTheAid) {
  const AidConfig config;
  Watched robot(config);
  std::mt19937 generator(3);
  std::normal_distribution<double> noise(0.0, 5e-3);
  robot.run(20.0, 10.0);
  double squares = 0.0;
  constexpr int kSamples = 2000;  // 200 s at 10 Hz
  for (int i = 0; i < kSamples * 50; ++i) {
    const bool heard = i % 50 == 0;
    const double x = heard ? noise(generator) : 0.0, y = heard ? noise(generator) : 0.0;
    robot.tick(heard, kDrift + Vec2(x, y));
    if (heard) squares += (robot.last - kDrift).squaredNorm() / kSamples;
  }
  // Held samples every d = 0.1 s through a low-pass of T = 4 s: sigma sqrt(d / 2 T) an axis,
  // 0.79 mm in the plane; 25 independent stretches know it to 15 %, doubled.
  EXPECT_NEAR(std::sqrt(squares), 5e-3 * std::sqrt(2.0 * 0.1 / 8.0), 0.3 * 0.79e-3);
}

TEST(PositionAidOffset, DoesNothingWhenDisabledAndForgetsOnReset) {
  AidConfig config = without_ramp();
  config.enabled = false;
  Watched ignored(config);
  ignored.run(5.0, 10.0);
  EXPECT_EQ(ignored.last, Vec2::Zero());

  Watched robot(without_ramp());
  robot.run(5.0, 10.0);
  robot.offset.reset();
  EXPECT_EQ(robot.tick(false), Vec2::Zero());
}

}  // namespace
}  // namespace pirouette
