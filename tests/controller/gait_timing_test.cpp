#include "pirouette/controller/gait_timing.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

constexpr double kPeriod = 0.002;  ///< s

/// A walking robot that does what it should, unless a test says otherwise.
struct Walking {
  explicit Walking(const GaitConfig& config) : timing(config) {
    command.walk = true;
    command.yaw_rate = 0.7;
  }

  GaitTimingOutput update() {
    const GaitTimingOutput out = timing.update(
        {command, v_WG_W, last_reference_v_WG_W, last_path_yaw_rate, last_walking, last_stepped},
        kPeriod);
    last_walking = out.gait.walking;
    return out;
  }
  /// s, once the timing has taken effect.
  GaitPhase settled() {
    for (int i = 0; i < 1000; ++i) update();
    return update().gait;
  }

  GaitTiming timing;
  MotionCommand command;
  Vec3 v_WG_W = Vec3::Zero(), last_reference_v_WG_W = Vec3::Zero();
  std::optional<double> last_path_yaw_rate;
  bool last_walking = false, last_stepped = false;
};

double stride(const GaitPhase& gait) { return gait.stance_duration + gait.swing_duration; }

TEST(GaitTiming, AFastTurnShortensTheStride) {
  const GaitConfig config;
  Walking slow(config), fast(config);
  fast.command.yaw_rate = 4.0;
  EXPECT_NEAR(stride(slow.settled()), config.period, 1e-12);
  EXPECT_NEAR(stride(fast.settled()), config.period_at(4.0), 1e-12);
}

TEST(GaitTiming, OnAPathTheYawRateIsThePaths) {
  const GaitConfig config;
  Walking robot(config);
  robot.last_path_yaw_rate = 4.0;
  EXPECT_NEAR(stride(robot.settled()), config.period_at(4.0), 1e-12);
}

TEST(GaitTiming, StepsLengthenTheStance) {
  const GaitConfig config;
  Walking robot(config);
  robot.last_stepped = true;
  const GaitPhase gait = robot.settled();
  EXPECT_NEAR(gait.stance_duration / stride(gait), config.step_duty_at(config.period), 1e-12);
  EXPECT_GT(config.step_duty_at(config.period), config.duty);
}

TEST(GaitTiming, APushShortensTheStrideAtOnceButNotOnStepsNorAtRest) {
  const GaitConfig config;
  const auto pushed = [&](bool walking, bool stepped) {
    Walking robot(config);
    robot.command.walk = walking;
    robot.last_stepped = stepped;
    robot.settled();
    robot.v_WG_W.y() = 1.1 * config.recovery_speed;
    return robot.update();
  };
  EXPECT_TRUE(pushed(true, false).recovering);
  EXPECT_NEAR(stride(pushed(true, false).gait), config.recovery_period_at(0.7), 1e-12);
  EXPECT_FALSE(pushed(true, true).recovering);
  EXPECT_FALSE(pushed(false, false).recovering);
}

TEST(GaitTiming, AVelocityThatIsWantedIsNoPush) {
  const GaitConfig config;
  Walking robot(config);
  robot.settled();
  robot.v_WG_W.x() = robot.last_reference_v_WG_W.x() = 2.0 * config.recovery_speed;
  EXPECT_FALSE(robot.update().recovering);
}

}  // namespace
}  // namespace pirouette
