#include "pirouette/controller/ground_sense.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kTick = 0.002, kRadius = 0.0225;  // s, m

using Ground = std::function<double(const Vec2&)>;

double slope(const Vec2& p) { return 0.2 * p.x() - 0.1 * p.y(); }
double stairs(const Vec2& p) { return 0.05 * std::floor(p.x() / 0.2 + 0.5); }

/// Feet of a robot that spins on the spot, all four in mid-stance at every step.
class Spinning {
 public:
  Spinning(const TerrainConfig& config, Ground ground)
      : sense(config, PerLeg<double>::filled(kRadius)), ground_(std::move(ground)) {
    place();
    std::array<Vec3, kLegCount> contacts;
    for (const Leg leg : kLegs) contacts[index(leg)] = feet[leg].p_WC;
    first_plane = sense.start(contacts);
  }

  /// Feet down where the trunk has turned to; `measured`: their contact flags.
  void step(bool measured = true) {
    yaw_ += 0.35;
    place();
    for (const Leg leg : kLegs) {
      feet[leg].in_contact = true;
      feet[leg].measured = measured;
      LegPhase& phase = gait.leg[leg];
      ++phase.stride;
      phase.stance = true;
      phase.progress = 0.5;
    }
    update();
  }
  void update() { out = sense.update({feet, gait, state}, kTick); }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }

  FootContacts feet;
  GaitPhase gait;
  RobotState state;
  GroundSense sense;
  TerrainPlane first_plane;
  GroundSenseOutput out;

 private:
  void place() {
    for (const Leg leg : kLegs) {
      const Vec2 hip(fore_sign(leg) * 0.19, side_sign(leg) * 0.11);
      const Vec2 xy = rot2(yaw_) * hip;
      feet[leg].p_WC << xy, ground_(xy);
      state.p_WF[leg] = feet[leg].p_WC + kRadius * Vec3::UnitZ();
    }
  }

  Ground ground_;
  double yaw_ = 0.0;
};

TEST(GroundSense, StartsFromThePlaneUnderTheFeet) {
  const Spinning robot(TerrainConfig{}, slope);
  EXPECT_NEAR(robot.first_plane.a1, 0.2, 1e-14);
  EXPECT_NEAR(robot.first_plane.a2, -0.1, 1e-14);
  EXPECT_NEAR(robot.first_plane.a0, 0.0, 1e-15);
}

TEST(GroundSense, AFlatWorldStaysFlatAtTheHeightOfTheFeet) {
  TerrainConfig config;
  config.estimation = TerrainEstimation::kOff;
  Spinning robot(config, [](const Vec2& p) { return 0.1 + slope(p); });
  robot.steps(10);
  EXPECT_EQ(robot.out.plane.a1, 0.0);
  EXPECT_EQ(robot.out.plane.a2, 0.0);
  EXPECT_NEAR(robot.out.plane.a0, 0.1, 1e-15);
  EXPECT_FALSE(robot.out.ground.stepped);
}

TEST(GroundSense, TellsSlopesFromStairs) {
  Spinning on_slope(TerrainConfig{}, slope), on_stairs(TerrainConfig{}, stairs);
  on_slope.steps(40);
  on_stairs.steps(40);
  EXPECT_TRUE(on_slope.out.ground.known);
  EXPECT_FALSE(on_slope.out.ground.stepped);
  EXPECT_EQ(on_slope.out.remembered_treads, 0);
  EXPECT_TRUE(on_stairs.out.ground.stepped);
  EXPECT_EQ(on_stairs.out.remembered_treads, 3);
}

TEST(GroundSense, TakesEachStanceDownOnceInItsMiddle) {
  Spinning robot(TerrainConfig{}, stairs);
  robot.step();
  for (int i = 0; i < 50; ++i) robot.update();  // the same stance goes on
  EXPECT_FALSE(robot.out.ground.known);
  robot.steps(2);
  EXPECT_TRUE(robot.out.ground.known);
}

TEST(GroundSense, IgnoresFeetBeforeMidStanceInTheAirAndOffTheGround) {
  Spinning robot(TerrainConfig{}, stairs);
  for (int i = 0; i < 10; ++i) robot.step(/*measured=*/false);
  EXPECT_FALSE(robot.out.ground.known);
  for (const bool stance : {true, false}) {
    for (int stride = 100; stride < 110; ++stride) {
      for (const Leg leg : kLegs) {
        robot.feet[leg].measured = true;
        robot.gait.leg[leg] = {.stance = stance, .progress = stance ? 0.4 : 0.9};
        robot.gait.leg[leg].stride = stride + (stance ? 0 : 100);
      }
      robot.update();
    }
  }
  EXPECT_FALSE(robot.out.ground.known);
}

TEST(GroundSense, OnStepsThePlaneIsTheRememberedOne) {
  TerrainConfig config;
  config.filter_time = 0.0;
  Spinning robot(config, stairs);
  robot.steps(40);
  TerrainPlane through_feet;
  {
    PlaneEstimator four_feet(config);
    PlaneInput in;
    for (const Leg leg : kLegs) {
      in.p_WC[leg] = robot.feet[leg].p_WC;
      in.touching[leg] = true;
    }
    through_feet = four_feet.update(in, kTick);
  }
  EXPECT_GT(robot.out.plane.weight, 100.0);  // footholds, not feet
  // Long-run gradient of the stairs over the ring of feet; the four feet alone swing about it.
  EXPECT_NEAR(robot.out.plane.a2, 0.0, 0.02);
  EXPECT_GT(std::abs(through_feet.a1 - robot.out.plane.a1) + std::abs(through_feet.a2), 0.02);
}

TEST(GroundSense, MovesAPlannedFootholdOffTheEdgeToTheHeightOfItsTread) {
  Spinning robot(TerrainConfig{}, stairs);
  robot.steps(40);
  Foothold planned;
  planned.p_WC = Vec3(0.115, 0.19, 0.02);
  const Foothold out = robot.sense.adapted(planned, Leg::kFR, kRadius);
  EXPECT_GT(out.p_WC.x(), 0.12);
  EXPECT_NEAR(out.p_WC.y(), 0.19, 5e-3);
  EXPECT_NEAR(out.p_WC.z(), 0.05, 1e-12);
  EXPECT_LT(distance(out.p_WF, out.p_WC + kRadius * Vec3::UnitZ()), 1e-15);
  EXPECT_EQ(out.n_W, Vec3::UnitZ());

  // A point foot's contact is its centre, a radius above the tread.
  const Foothold point = robot.sense.adapted(planned, Leg::kFR, 0.0);
  EXPECT_NEAR(point.p_WC.z(), 0.05 + kRadius, 1e-12);
  EXPECT_EQ(point.p_WF, point.p_WC);
}

TEST(GroundSense, LeavesAFootholdWhereTheMemoryKnowsNothing) {
  Spinning robot(TerrainConfig{}, stairs);
  robot.steps(3);
  Foothold planned;
  planned.p_WC = Vec3(0.115, 0.19, 0.02);
  const Foothold out = robot.sense.adapted(planned, Leg::kFR, kRadius);
  EXPECT_EQ(out.p_WC, planned.p_WC);
  EXPECT_LT(distance(out.p_WF, out.p_WC + kRadius * Vec3::UnitZ()), 1e-15);
}

TEST(GroundSense, StartsAfresh) {
  Spinning robot(TerrainConfig{}, stairs);
  robot.steps(40);
  std::array<Vec3, kLegCount> contacts;
  for (const Leg leg : kLegs) contacts[index(leg)] = robot.feet[leg].p_WC;
  robot.sense.start(contacts);
  robot.update();
  EXPECT_FALSE(robot.out.ground.known);
  EXPECT_EQ(robot.out.remembered_treads, 0);
}

}  // namespace
}  // namespace pirouette
