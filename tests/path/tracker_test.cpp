#include "pirouette/path/tracker.hpp"

#include <gtest/gtest.h>

#include "path/kinematic_robot.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::PathLoop;
using test::walk;

constexpr double kSpin = 0.7;  // rad/s

PathConfig anchored(PathTracker tracker) {
  PathConfig config;
  config.reference = PathReferenceMode::kAnchored;
  config.tracker = tracker;
  config.state_weight = {1.0, 1.0, 4.0};  // gains of about 1 /s on position and 2 /s on yaw
  config.input_weight = {1.0, 1.0, 1.0};
  config.integral_gain = 1.0;
  config.integral_limit = 0.08;
  return config;
}

/// m, mean distance of the robot from where it started, over one turn.
double radius_over_a_turn(PathLoop& loop) {
  const int steps = static_cast<int>(2.0 * kPi / kSpin / PathLoop::kDt);
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    loop.step(walk(Vec2::Zero(), kSpin));
    sum += loop.robot.p_WG.norm();
  }
  return sum / steps;
}

TEST(Tracker, BodyFixedBiasDrawsTheCircleThatTheoryPredicts) {
  PathLoop loop(anchored(PathTracker::kLqr));
  loop.robot.bias_H = {0.015, -0.010};
  loop.run(walk(Vec2::Zero(), kSpin), 30.0);
  const double k = loop.tracker.gain()(0, 0);
  EXPECT_NEAR(k, 1.0, 0.01);
  EXPECT_NEAR(radius_over_a_turn(loop), loop.robot.bias_H.norm() / std::hypot(k, kSpin), 1e-5);
}

TEST(Tracker, WithoutFeedbackTheCircleIsBiasOverYawRate) {
  PathLoop loop(anchored(PathTracker::kNone));
  loop.robot.bias_H = {0.0195, 0.0};
  loop.robot.yaw_rate = kSpin;
  loop.run(walk(Vec2::Zero(), kSpin), 30.0);
  Vec2 low = loop.robot.p_WG, high = low;
  for (int i = 0; i < 5000; ++i) {
    loop.step(walk(Vec2::Zero(), kSpin));
    low = low.cwiseMin(loop.robot.p_WG);
    high = high.cwiseMax(loop.robot.p_WG);
  }
  EXPECT_LT(distance(high - low, Vec2::Constant(2.0 * 0.0195 / kSpin)), 1e-5);
}

TEST(Tracker, BodyFrameIntegratorRemovesTheCircle) {
  for (const double lag : {0.0, 0.1, 0.2}) {
    PathLoop loop(anchored(PathTracker::kLqi));
    loop.robot.bias_H = {0.015, -0.010};
    loop.robot.lag = lag;
    loop.run(walk(Vec2::Zero(), kSpin), 60.0);
    EXPECT_LT(radius_over_a_turn(loop), 1e-6) << lag;
    EXPECT_LT(distance(loop.tracker.integral_H(), Vec2(-loop.robot.bias_H)), 1e-6);
  }
}

TEST(Tracker, BodyFrameIntegratorWorksOnAnArcToo) {
  PathLoop loop(anchored(PathTracker::kLqi));
  loop.robot.bias_H = {0.015, -0.010};
  loop.robot.lag = 0.1;
  loop.run(walk({0.3, 0.0}, kSpin), 60.0);
  // The robot is a tick on: 0.6 mm.
  EXPECT_LT((loop.robot.p_WG - loop.point.p_WG).norm(), 0.7e-3);
}

TEST(Tracker, AFarStartIsApproachedWithoutALongOvershoot) {
  for (const PathTracker tracker : {PathTracker::kLqr, PathTracker::kLqi}) {
    PathLoop loop(anchored(tracker));
    loop.robot.lag = 0.15;
    loop.robot.p_WG = {0.1, 0.0};
    loop.robot.yaw = radians(30.0);
    MotionCommand command = walk(Vec2::Zero(), kSpin);
    command.point = Vec2::Zero();
    command.heading = 0.0;
    for (int i = 0; i < 7500; ++i) {
      loop.step(command);
      ASSERT_LT(loop.robot.p_WG.norm(), 0.11);
    }
    EXPECT_LT(loop.robot.p_WG.norm(), 1e-3);
    EXPECT_NEAR(loop.robot.yaw, loop.point.yaw, 2e-3);  // the robot is a tick on: 1.4e-3 rad
  }
}

TEST(Tracker, FeedForwardIsTheReferenceTwist) {
  Tracker tracker(anchored(PathTracker::kNone), 500.0);
  const PathPoint reference{.p_WG = {1.0, 2.0}, .yaw = 0.3, .v_H = {0.2, -0.1}, .yaw_rate = 0.7};
  test::KinematicRobot robot;
  robot.yaw = 0.5;
  const TwistCommand twist = tracker.update(reference, robot.state(), 0.002);
  // The same velocity in the world, seen from a heading that is 0.2 rad further left.
  EXPECT_LT(distance(rot2(0.5) * twist.v_H, rot2(0.3) * reference.v_H), 1e-15);
  EXPECT_EQ(twist.yaw_rate, 0.7);
}

TEST(Tracker, PositionFeedbackDoesNotDependOnYaw) {
  const PathPoint reference{.yaw_rate = 0.7};
  Vec2 first_W = Vec2::Zero();
  for (const double yaw : {0.0, 0.3, -0.4}) {
    PathConfig config = anchored(PathTracker::kLqr);
    config.max_correction_rate = 1e6;
    Tracker tracker(config, 500.0);
    test::KinematicRobot robot;
    robot.p_WG = {0.05, 0.02};
    robot.yaw = yaw;
    const Vec2 v_W = rot2(yaw) * tracker.update(reference, robot.state(), 0.002).v_H;
    if (yaw == 0.0) first_W = v_W;
    EXPECT_LT(distance(v_W, first_W), 1e-15);
  }
}

TEST(Tracker, CorrectionsAreClampedAndRateLimited) {
  PathConfig config = anchored(PathTracker::kLqi);
  Tracker tracker(config, 500.0);
  test::KinematicRobot robot;
  robot.p_WG = {5.0, -3.0};
  robot.yaw = 2.0;
  TwistCommand previous;
  for (int i = 0; i < 2000; ++i) {
    const TwistCommand twist = tracker.update({}, robot.state(), 0.002);
    EXPECT_LE(twist.v_H.norm(), config.max_velocity_correction + 1e-12);
    EXPECT_LE(std::abs(twist.yaw_rate), config.max_yaw_rate_correction + 1e-12);
    EXPECT_LE((twist.v_H - previous.v_H).norm(), config.max_correction_rate * 0.002 + 1e-12);
    EXPECT_LE(std::abs(twist.yaw_rate - previous.yaw_rate),
              config.max_yaw_acceleration * 0.002 + 1e-12);
    EXPECT_LE(tracker.integral_H().norm(), config.integral_limit + 1e-12);
    previous = twist;
  }
  EXPECT_EQ(tracker.integral_H(), Vec2::Zero());  // saturated from the start: nothing winds up
}

TEST(Tracker, ResetForgetsIntegratorAndCorrection) {
  PathLoop loop(anchored(PathTracker::kLqi));
  loop.robot.bias_H = {0.02, 0.0};
  loop.run(walk(Vec2::Zero(), kSpin), 5.0);
  EXPECT_GT(loop.tracker.integral_H().norm(), 0.01);
  loop.tracker.reset();
  EXPECT_EQ(loop.tracker.integral_H(), Vec2::Zero());
  test::KinematicRobot on_target;
  EXPECT_EQ(loop.tracker.update({}, on_target.state(), 0.002).v_H, Vec2::Zero());
}

TEST(Tracker, GainFollowsTheYawRateOfTheReference) {
  PathConfig config = anchored(PathTracker::kLqr);
  config.state_weight = {4.0, 1.0, 4.0};  // with unequal weights the gain depends on the rate
  Tracker tracker(config, 500.0);
  const Mat3 at_rest = tracker.gain();
  test::KinematicRobot robot;
  tracker.update({.yaw_rate = 2.0}, robot.state(), 0.002);
  EXPECT_GT(distance(tracker.gain(), at_rest), 0.1);
  tracker.update({.yaw_rate = 0.0}, robot.state(), 0.002);
  EXPECT_LT(distance(tracker.gain(), at_rest), 1e-12);
}

TEST(Tracker, MirroredErrorsGiveMirroredCommands) {
  Tracker left(anchored(PathTracker::kLqi), 500.0), right(anchored(PathTracker::kLqi), 500.0);
  test::KinematicRobot robot, mirrored;
  robot.p_WG = {0.03, 0.02};
  mirrored.p_WG = {0.03, -0.02};
  robot.yaw = 0.2;
  mirrored.yaw = -0.2;
  for (int i = 0; i < 100; ++i) {
    const TwistCommand a = left.update({.yaw_rate = 0.7}, robot.state(), 0.002);
    const TwistCommand b = right.update({.yaw_rate = -0.7}, mirrored.state(), 0.002);
    EXPECT_LT(distance(a.v_H, Vec2(b.v_H.x(), -b.v_H.y())), 1e-15);
    EXPECT_NEAR(a.yaw_rate, -b.yaw_rate, 1e-15);
  }
}

}  // namespace
}  // namespace pirouette
