#include "pirouette/controller/sensor_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace pirouette {
namespace {

constexpr double kPeriod = 0.002;  ///< s

/// A live robot: every value differs from that of any other tick by at most 1e-3 a tick.
SensorReading live(int tick) {
  const double drift = 1e-3 * tick;
  SensorReading sensors;
  sensors.time = tick * kPeriod;
  sensors.joint_position = PerLeg<Vec3>::filled(Vec3::Constant(drift));
  sensors.specific_force_B = Vec3(drift, 0.0, kGravity);
  sensors.w_WB_B = Vec3(0.0, drift, 0.7);
  return sensors;
}

JointCommand moving(double rate) {
  LegCommand leg;
  leg.dq.setConstant(rate);
  return JointCommand::filled(leg);
}

struct Guarded {
  SafetyConfig config;
  SensorGuard guard{config, kPeriod};
  bool walking = true;
  JointCommand sent = moving(0.99);

  bool update(const SensorReading& sensors) {
    return guard.update(sensors, MotionCommand{}, sent, walking);
  }
  const GuardedInput& input() const { return guard.input(); }
};

TEST(SensorGuard, HandsOnWhatALiveRobotMeasures) {
  Guarded g;
  for (int tick = 0; tick < 1000; ++tick) {
    ASSERT_TRUE(g.update(live(tick)));
    ASSERT_EQ(g.input().sensors.w_WB_B, live(tick).w_WB_B);
    for (const bool stuck : g.input().encoder_stuck) ASSERT_FALSE(stuck);
  }
}

TEST(SensorGuard, LosesAnAidWithoutANumberAndNothingElse) {
  Guarded g;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int tick = 0; tick < 100; ++tick) {
    SensorReading occluded = live(tick);
    occluded.aid = PositionAid{.p_WB = Vec3(0.1, nan, 0.3)};
    ASSERT_TRUE(g.update(occluded));
    ASSERT_FALSE(g.input().sensors.aid);
  }
}

TEST(SensorGuard, HearsAnAidOnce) {
  Guarded g;
  SensorReading sensors = live(0);
  sensors.aid = PositionAid{};
  EXPECT_TRUE(g.update(sensors));
  EXPECT_TRUE(g.input().sensors.aid);
  sensors.w_WB_B.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(g.update(sensors));
  EXPECT_FALSE(g.input().sensors.aid);
}

TEST(SensorGuard, LetsTheSampleBeforeStandInForASpike) {
  for (const bool of_gyro : {true, false}) {
    Guarded g;
    for (int tick = 0; tick < 10; ++tick) g.update(live(tick));
    SensorReading spike = live(10);
    Vec3& spoilt = of_gyro ? spike.w_WB_B : spike.specific_force_B;
    spoilt.x() += 1.01 * (of_gyro ? g.config.max_gyro_step : g.config.max_accelerometer_step);
    EXPECT_TRUE(g.update(spike));
    EXPECT_EQ(g.input().sensors.w_WB_B, live(9).w_WB_B);
    EXPECT_EQ(g.input().sensors.specific_force_B, live(9).specific_force_B);
    EXPECT_EQ(g.input().sensors.joint_position[Leg::kFR], live(10).joint_position[Leg::kFR]);
    EXPECT_TRUE(g.update(live(11)));
    EXPECT_EQ(g.input().sensors.w_WB_B, live(11).w_WB_B);
  }
}

TEST(SensorGuard, BelievesAJumpThatStays) {
  Guarded g;
  g.update(live(0));
  const Vec3 jump(0.0, 0.0, 2.0 * g.config.max_gyro_step);
  int held = 0;
  for (int tick = 1; tick < 100; ++tick) {
    SensorReading sensors = live(tick);
    sensors.w_WB_B += jump;
    ASSERT_TRUE(g.update(sensors));
    if (g.input().sensors.w_WB_B == live(0).w_WB_B) ++held;
  }
  EXPECT_EQ(held, 10);  // 20 ms
}

/// Updates that are good before the guard gives up, with an IMU dead from tick 10 on.
int ticks_with_a_dead_imu(Guarded& g) {
  int tick = 0;
  for (; tick < 1000; ++tick) {
    SensorReading sensors = live(tick);
    sensors.w_WB_B = live(std::min(tick, 10)).w_WB_B;
    sensors.specific_force_B = live(std::min(tick, 10)).specific_force_B;
    if (!g.update(sensors)) break;
  }
  return tick - 11;
}

TEST(SensorGuard, GivesUpOnAnImuThatRepeatsItselfWhileWalking) {
  Guarded g;
  EXPECT_EQ(ticks_with_a_dead_imu(g), 50);  // 0.1 s
  Guarded standing;
  standing.walking = false;
  EXPECT_EQ(ticks_with_a_dead_imu(standing), 1000 - 11);
}

TEST(SensorGuard, ForgivesAnImuThatIsSlowerThanTheController) {
  Guarded g;
  for (int tick = 0; tick < 1000; ++tick) {
    SensorReading sensors = live(tick);
    sensors.w_WB_B = live(tick - tick % 10).w_WB_B;
    sensors.specific_force_B = live(tick - tick % 10).specific_force_B;
    ASSERT_TRUE(g.update(sensors));
  }
}

SensorReading with_frozen_knee(int tick, Leg leg) {
  SensorReading sensors = live(tick);
  sensors.joint_position[leg].z() = 0.0;
  return sensors;
}

TEST(SensorGuard, FindsAnEncoderThatStandsStillWhileItsJointIsToMove) {
  Guarded g;
  g.update(with_frozen_knee(0, Leg::kRL));
  // 0.05 rad at 0.99 rad/s and 2 ms a tick.
  for (int tick = 1; tick <= 26; ++tick) {
    ASSERT_TRUE(g.update(with_frozen_knee(tick, Leg::kRL)));
    for (const Leg leg : kLegs)
      EXPECT_EQ(g.input().encoder_stuck[leg], leg == Leg::kRL && tick > 25) << tick;
  }
  g.update(live(27));
  EXPECT_FALSE(g.input().encoder_stuck[Leg::kRL]);
}

TEST(SensorGuard, DoesNotBlameAnEncoderWhoseJointIsToStandStill) {
  Guarded g;
  g.sent = moving(0.0);
  for (int tick = 0; tick < 1000; ++tick) {
    ASSERT_TRUE(g.update(with_frozen_knee(tick, Leg::kRL)));
    ASSERT_FALSE(g.input().encoder_stuck[Leg::kRL]);
  }
}

TEST(SensorGuard, GivesUpOnTwoBlindLegs) {
  Guarded g;
  int tick = 0;
  for (; tick < 100; ++tick) {
    SensorReading sensors = with_frozen_knee(tick, Leg::kRL);
    sensors.joint_position[Leg::kFR].x() = 0.0;
    if (!g.update(sensors)) break;
  }
  EXPECT_EQ(tick, 26);
}

TEST(SensorGuard, IsAsNewAfterReset) {
  Guarded g;
  ticks_with_a_dead_imu(g);
  g.guard.reset();
  EXPECT_TRUE(g.update(live(0)));
  SensorReading bad = live(1);
  bad.time = std::numeric_limits<double>::quiet_NaN();
  g.guard.reset();
  EXPECT_FALSE(g.update(bad));
}

}  // namespace
}  // namespace pirouette
