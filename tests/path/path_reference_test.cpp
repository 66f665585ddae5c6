#include "pirouette/path/path_reference.hpp"

#include <gtest/gtest.h>

#include "path/kinematic_robot.hpp"
#include "pirouette/base/planar_twist.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::PathLoop;
using test::walk;

constexpr double kDt = 0.002;

PathConfig anchored(PathTracker tracker = PathTracker::kLqr) {
  PathConfig config;
  config.reference = PathReferenceMode::kAnchored;
  config.tracker = tracker;
  config.max_yaw_lead = 0.5;
  return config;
}

RobotState standing_at(const Vec2& p_WG, double yaw) {
  test::KinematicRobot robot;
  robot.p_WG = p_WG;
  robot.yaw = yaw;
  return robot.state();
}

TEST(PathReference, RestsWhereTheRobotStood) {
  PathReference reference(anchored());
  reference.update({}, standing_at({0.3, -0.2}, 0.5), kDt);
  const PathPoint point = reference.update({}, standing_at({0.31, -0.2}, 0.6), kDt);
  EXPECT_EQ(point.p_WG, Vec2(0.3, -0.2));
  EXPECT_NEAR(point.yaw, 0.5, 1e-15);
  EXPECT_EQ(point.yaw_rate, 0.0);
}

TEST(PathReference, ASpinStaysAtThePointWhereWalkingBegan) {
  PathReference reference(anchored());
  reference.update({}, standing_at({0.3, -0.2}, 0.0), kDt);
  for (int i = 0; i < 1000; ++i) {
    const PathPoint point =
        reference.update(walk(Vec2::Zero(), 0.7), standing_at({0.4, 0.1}, 0.0), kDt);
    EXPECT_EQ(point.p_WG, Vec2(0.4, 0.1));
  }
}

TEST(PathReference, TwistRampsWithinItsAccelerations) {
  PathConfig config = anchored();
  PathReference reference(config);
  PathPoint previous = reference.update({}, standing_at(Vec2::Zero(), 0.0), kDt);
  PathPoint point;
  for (int i = 0; i < 1000; ++i) {
    point = reference.update(walk({0.3, -0.1}, 0.7), standing_at(Vec2::Zero(), previous.yaw), kDt);
    EXPECT_LE(std::abs(point.yaw_rate - previous.yaw_rate),
              config.max_yaw_acceleration * kDt + 1e-12);
    EXPECT_LE((point.v_H - previous.v_H).norm(), config.max_acceleration * kDt + 1e-12);
    previous = point;
  }
  EXPECT_NEAR(point.yaw_rate, 0.7, 1e-15);
  EXPECT_LT(distance(point.v_H, Vec2(0.3, -0.1)), 1e-12);
}

TEST(PathReference, FollowsTheExactArcForARobotThatKeepsUp) {
  PathConfig config = anchored();
  config.max_acceleration = config.max_yaw_acceleration = 1e6;
  PathReference reference(config);
  const MotionCommand command = walk({0.3, 0.1}, 0.7);
  const Vec2 start(1.0, 2.0);
  PathPoint point{.yaw = 0.4};
  for (int i = 1; i <= 5000; ++i) {
    point = reference.update(command, standing_at(start, point.yaw), kDt);
    const Vec2 travelled = planar_twist_displacement(command.v_H, command.yaw_rate, i * kDt);
    ASSERT_LT(distance(point.p_WG, start + rot2(0.4) * travelled), 1e-11);
    ASSERT_NEAR(point.yaw, 0.4 + command.yaw_rate * i * kDt, 1e-11);
  }
}

TEST(PathReference, StartsAtTheCommandedPointAndHeading) {
  PathReference reference(anchored());
  MotionCommand command = walk(Vec2::Zero(), 0.0);
  command.point = Vec2(1.0, 2.0);
  command.heading = 0.2 + 4.0 * kPi;
  const PathPoint point = reference.update(command, standing_at({1.1, 2.0}, 0.0), kDt);
  EXPECT_EQ(point.p_WG, Vec2(1.0, 2.0));
  EXPECT_NEAR(point.yaw, 0.2, 1e-14);
}

TEST(PathReference, AChangedPointAnchorsAgain) {
  PathReference reference(anchored());
  MotionCommand command = walk(Vec2::Zero(), 0.7);
  command.point = Vec2(1.0, 2.0);
  const RobotState state = standing_at({1.0, 2.0}, 0.0);
  for (int i = 0; i < 100; ++i) reference.update(command, state, kDt);
  const double yaw = reference.update(command, state, kDt).yaw;
  command.point = Vec2(1.5, 2.0);
  const PathPoint point = reference.update(command, state, kDt);
  EXPECT_EQ(point.p_WG, Vec2(1.5, 2.0));
  EXPECT_NEAR(point.yaw, yaw, 0.01);
}

TEST(PathReference, YawIsNeverFurtherAwayThanTheLead) {
  for (const PathReferenceMode mode : {PathReferenceMode::kVelocity, PathReferenceMode::kIntegrated,
                                       PathReferenceMode::kAnchored}) {
    PathConfig config = anchored();
    config.reference = mode;
    PathReference reference(config);
    const RobotState stuck = standing_at(Vec2::Zero(), 0.0);
    PathPoint point;
    for (int i = 0; i < 5000; ++i) {
      point = reference.update(walk(Vec2::Zero(), 0.7), stuck, kDt);
      ASSERT_LE(std::abs(point.yaw), config.max_yaw_lead + 1e-12);
    }
    EXPECT_NEAR(point.yaw, config.max_yaw_lead, 1e-12);
    EXPECT_EQ(point.yaw_rate, 0.7);
    // Nothing is wound up: once the robot turns, the reference goes on at once.
    const PathPoint next =
        reference.update(walk(Vec2::Zero(), 0.7), standing_at(Vec2::Zero(), 0.1), kDt);
    EXPECT_NEAR(next.yaw, config.max_yaw_lead + 0.7 * kDt, 1e-12);
  }
}

TEST(PathReference, AStuckRobotStopsTheArcAndKeepsItsShape) {
  PathConfig config = anchored();
  config.max_acceleration = config.max_yaw_acceleration = 1e6;
  PathReference reference(config);
  const Vec2 v(0.35, 0.0);
  const double rate = 0.7;
  PathPoint point;
  for (int i = 0; i < 5000; ++i)
    point = reference.update(walk(v, rate), standing_at(Vec2::Zero(), 0.0), kDt);
  EXPECT_NEAR(point.yaw, config.max_yaw_lead, 1e-12);
  const Vec2 at_the_lead = planar_twist_displacement(v, rate, config.max_yaw_lead / rate);
  EXPECT_LT(distance(point.p_WG, at_the_lead), 1e-12);
  EXPECT_EQ(point.v_H, Vec2::Zero());
}

TEST(PathReference, AHeadingOnTheOtherSideIsApproachedTheShortWay) {
  for (const double rate : {0.0, 0.7, -0.7}) {
    for (const double start_deg : {-179.0, -120.0, -30.0, 30.0, 120.0, 179.0}) {
      PathLoop loop(anchored());
      loop.robot.yaw = radians(start_deg);
      MotionCommand command = walk(Vec2::Zero(), rate);
      command.heading = 0.0;
      for (int i = 0; i < 10000; ++i) {
        const double yaw_before = loop.robot.yaw;
        loop.step(command);
        ASSERT_LE(std::abs(loop.point.yaw - yaw_before), 0.5 + 1e-12);
      }
      EXPECT_NEAR(loop.robot.yaw - rate * kDt, loop.point.yaw, 1e-6);  // the robot is a tick on
      if (rate == 0.0) {
        EXPECT_NEAR(loop.robot.yaw, 0.0, 1e-3);  // not a whole turn away
      }
    }
  }
}

TEST(PathReference, ARobotTurnedRoundByHandDoesNotUnwindWholeTurns) {
  PathReference reference(anchored());
  reference.update(walk(Vec2::Zero(), 0.0), standing_at(Vec2::Zero(), 0.0), kDt);
  const PathPoint point =
      reference.update(walk(Vec2::Zero(), 0.0), standing_at(Vec2::Zero(), 4.0 * kPi + 0.1), kDt);
  EXPECT_NEAR(point.yaw, 4.0 * kPi, 1e-12);
}

TEST(PathReference, VelocityModeFollowsTheRobot) {
  PathConfig config = anchored();
  config.reference = PathReferenceMode::kVelocity;
  PathReference reference(config);
  reference.update(walk({0.2, 0.0}, 0.0), standing_at(Vec2::Zero(), 0.0), kDt);
  EXPECT_EQ(reference.update(walk({0.2, 0.0}, 0.0), standing_at({3.0, 4.0}, 0.0), kDt).p_WG,
            Vec2(3.0, 4.0));
}

TEST(PathReference, IntegratedModeStaysNearTheRobot) {
  PathConfig config = anchored();
  config.reference = PathReferenceMode::kIntegrated;
  PathReference reference(config);
  PathPoint point;
  for (int i = 0; i < 2000; ++i) {
    point = reference.update(walk({0.2, 0.0}, 0.0), standing_at(Vec2::Zero(), 0.0), kDt);
  }
  EXPECT_LT(distance(point.p_WG, Vec2(config.max_integrated_lead, 0.0)), 1e-12);
  EXPECT_NEAR(point.v_H.x(), 0.2, 1e-12);
}

TEST(PathReference, StoppingEndsWhereTheRobotIs) {
  PathLoop loop(anchored());
  loop.run(walk({0.2, 0.0}, 0.7), 4.0);
  const Vec2 where = loop.robot.p_WG;
  loop.run({}, 3.0);
  EXPECT_EQ(loop.point.yaw_rate, 0.0);
  EXPECT_EQ(loop.point.v_H, Vec2::Zero());
  EXPECT_LT((loop.point.p_WG - where).norm(), 0.06);  // 0.04 m is the braking way
}

TEST(PathReference, TurningTheWorldTurnsTheReference) {
  const double turn = 2.0;
  PathLoop loop(anchored(PathTracker::kLqi)), turned(anchored(PathTracker::kLqi));
  loop.robot.bias_H = turned.robot.bias_H = {0.01, 0.02};
  turned.robot.yaw = turn;
  for (int i = 0; i < 3000; ++i) {
    loop.step(walk({0.2, 0.05}, 0.7));
    turned.step(walk({0.2, 0.05}, 0.7));
    ASSERT_LT(distance(turned.point.p_WG, rot2(turn) * loop.point.p_WG), 1e-12);
    ASSERT_NEAR(turned.point.yaw, loop.point.yaw + turn, 1e-12);
  }
}

}  // namespace
}  // namespace pirouette
