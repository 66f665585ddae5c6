#include "pirouette/path/path_reference.hpp"

#include <gtest/gtest.h>

#include "path/kinematic_robot.hpp"
#include "pirouette/base/planar_twist.hpp"
#include "pirouette/base/rotation.hpp"
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

double distance_to(const Vec2& a, const Vec2& b) { return (a - b).norm(); }

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

TEST(PathReference, TheRampKeepsTheRadius) {
  // Anchored at the origin, a turn of 0.5 m to the left is about (0, 0.5) from its first moment on.
  PathLoop loop(anchored(PathTracker::kNone));
  for (int i = 0; i < 2000; ++i) {
    loop.step(walk({0.35, 0.0}, 0.7));
    ASSERT_NEAR(distance_to(loop.point.p_WG, {0.0, 0.5}), 0.5, 1e-9);
  }
}

/// Half a metre straight on, then a bend to the left; given away from the origin.
Path bend() {
  const std::vector<Vec2> points = {{2.0, 0.0}, {2.5, 0.0}, {2.9, 0.2}, {3.0, 0.6}, {3.0, 1.0}};
  return Path::spline(points, false).value();
}

/// `bend()` as it lies when followed from `start` with its tangent along `heading`.
Path bend_from(const Vec2& start, double heading) {
  Path path = bend();
  path.start_at(start, heading);
  return path;
}

TEST(PathReferenceOnAPath, BeginsWhereTheRobotStandsAndStaysOnThePathToItsEnd) {
  PathLoop loop(anchored());
  loop.robot.p_WG = {0.3, -0.4};
  loop.robot.yaw = 2.0;
  loop.reference.follow(bend());
  const Path path = bend_from({0.3, -0.4}, 2.0);
  for (int i = 0; i < 6000; ++i) {
    loop.step(walk({0.2, 0.0}, 0.7));
    const PathSample due = path.at(loop.point.arc_length);
    ASSERT_LT(distance(loop.point.p_WG, due.p), 1e-9);
    ASSERT_NEAR(wrap_angle(loop.point.yaw - due.heading), 0.0, 1e-9);
    // Feed-forward: along the tangent, and turning as the path bends.
    ASSERT_NEAR(loop.point.v_H.y(), 0.0, 1e-9);
    ASSERT_NEAR(loop.point.yaw_rate, due.curvature * loop.point.v_H.x(), 1e-9);
  }
  EXPECT_NEAR(loop.point.arc_length, path.length(), 1e-3);
  EXPECT_LT(loop.point.v_H.norm(), 0.01);
  EXPECT_LT(distance_to(loop.robot.p_WG, path.at(path.length()).p), 0.005);
}

TEST(PathReferenceOnAPath, TheDirectionOfTheVelocityIsThatOfThePathInTheBody) {
  for (const double direction_deg : {90.0, -90.0, 180.0, 30.0}) {
    PathLoop loop(anchored());
    loop.reference.follow(bend());
    const Vec2 v_H = rot2(radians(direction_deg)) * Vec2(0.2, 0.0);
    const Path path = bend_from(Vec2::Zero(), radians(direction_deg));
    loop.run(walk(v_H, 0.0), 5.0);
    const PathSample due = path.at(loop.point.arc_length);
    EXPECT_LT(distance(loop.point.p_WG, due.p), 1e-9);
    EXPECT_NEAR(wrap_angle(loop.point.yaw + radians(direction_deg) - due.heading), 0.0, 1e-9);
    EXPECT_LT(distance(loop.point.v_H, v_H), 1e-9);
  }
}

TEST(PathReferenceOnAPath, AHeldHeadingDoesNotTurnWithThePath) {
  PathLoop loop(anchored());
  loop.robot.yaw = 0.4;
  loop.reference.follow(bend());
  MotionCommand command = walk({0.2, 0.0}, 0.0);
  command.hold_heading = true;
  loop.run(command, 7.0);
  EXPECT_NEAR(loop.point.yaw, 0.4, 1e-12);
  EXPECT_EQ(loop.point.yaw_rate, 0.0);
  const Path path = bend_from(Vec2::Zero(), 0.4);
  EXPECT_LT(distance(loop.point.p_WG, path.at(loop.point.arc_length).p), 1e-9);
  EXPECT_GT(loop.point.v_H.y(), 0.1) << "the path has turned left, the body has not";
}

TEST(PathReferenceOnAPath, WaitsForARobotThatIsStuck) {
  PathConfig config = anchored();
  PathReference reference(config);
  reference.follow(bend());
  const RobotState stuck = standing_at(Vec2::Zero(), 0.0);
  PathPoint point;
  for (int i = 0; i < 5000; ++i) {
    point = reference.update(walk({0.2, 0.0}, 0.0), stuck, kDt);
    ASSERT_LE(point.arc_length, config.max_path_lead + 1e-12);
  }
  EXPECT_NEAR(point.arc_length, config.max_path_lead, 1e-12);
  EXPECT_LT(point.v_H.norm(), 1e-9);
}

TEST(PathReferenceOnAPath, ACommandedPointPutsThePathInTheWorldAndTheRobotJoinsIt) {
  PathReference reference(anchored());
  reference.follow(bend());
  MotionCommand command = walk({0.2, 0.0}, 0.0);
  command.point = Vec2(1.0, 1.0);
  command.heading = 0.0;
  const Vec2 robot(1.3, 1.1);
  const PathPoint point = reference.update(command, standing_at(robot, 0.0), kDt);
  const Path path = bend_from({1.0, 1.0}, 0.0);
  EXPECT_GT(point.arc_length, 0.2);
  EXPECT_LT(distance(point.p_WG, path.at(path.nearest(robot)).p), 1e-5);
}

TEST(PathReferenceOnAPath, ItsCrossingIsPassedOnTheSameBranch) {
  std::vector<Vec2> points;
  for (int i = 0; i < 24; ++i) {
    const double a = 2.0 * kPi * i / 24.0;
    points.emplace_back(0.6 * std::sin(a), 0.6 * std::sin(a) * std::cos(a));
  }
  const Path path = Path::spline(points, true).value();
  PathLoop loop(anchored());
  loop.reference.follow(path);
  double previous = 0.0;
  for (int i = 0; i < 15000; ++i) {
    loop.step(walk({0.2, 0.0}, 0.0));
    ASSERT_LE(loop.point.arc_length - previous, 0.2 * kDt + 1e-12);
    previous = loop.point.arc_length;
  }
  EXPECT_NEAR(previous, 0.2 * 30.0, 0.1) << "the ramp takes 0.04 m, no branch is skipped";
}

TEST(PathReferenceOnAPath, WithoutThePathTheTwistIsFollowedAgain) {
  PathReference reference(anchored()), plain(anchored());
  reference.follow(bend());
  reference.follow(std::nullopt);
  for (int i = 0; i < 500; ++i) {
    const RobotState state = standing_at(Vec2::Zero(), 0.0);
    const PathPoint point = reference.update(walk({0.2, 0.0}, 0.7), state, kDt);
    const PathPoint expected = plain.update(walk({0.2, 0.0}, 0.7), state, kDt);
    ASSERT_EQ(point.p_WG, expected.p_WG);
    ASSERT_EQ(point.yaw, expected.yaw);
  }
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
