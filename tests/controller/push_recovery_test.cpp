#include "pirouette/controller/push_recovery.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pirouette {
namespace {

constexpr double kPeriod = 0.002;  ///< s

TEST(PushRecovery, LastsAsLongAsThePushAndItsTime) {
  const GaitConfig config;
  PushRecovery recovery(config);
  const Vec2 fast(0.0, -1.01 * config.recovery_speed), slow(0.99 * config.recovery_speed, 0.0);
  EXPECT_FALSE(recovery.update(slow, kPeriod));
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(recovery.update(fast, kPeriod));
  int ticks = 0;
  while (recovery.update(slow, kPeriod)) ++ticks;
  EXPECT_NEAR(ticks, config.recovery_time / kPeriod, 1.0);  // rounding of the time left
  EXPECT_TRUE(recovery.update(fast, kPeriod));
  recovery.reset();
  EXPECT_FALSE(recovery.update(slow, kPeriod));
}

TEST(RecoveryStride, IsNeverLongerThanTheStrideNorTooShortToSwing) {
  GaitConfig config;
  EXPECT_EQ(config.recovery_period_at(0.7), config.recovery_period);
  EXPECT_EQ(config.recovery_period_at(5.0), config.period_at(5.0));
  config.duty = 0.9;
  EXPECT_DOUBLE_EQ(config.recovery_period_at(0.0) * (1.0 - config.duty), 0.05);
  config.period = 0.2;
  EXPECT_EQ(config.recovery_period_at(0.0), 0.2);
}

}  // namespace
}  // namespace pirouette
