#include "pirouette/controller/localization.hpp"

#include <gtest/gtest.h>

#include "support/mini_cheetah.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::kTick;

/// A robot that stands level at the origin, in sensors and trace.
class Standing {
 public:
  explicit Standing(const Config& config)
      : model(RobotModel::load(test::kRobot).value()), localization(config, model.legs()) {
    BasePose start;
    start.p_WB.z() = 0.29;
    localization.reset(start);
    trace.sensors.specific_force_B.z() = kGravity;
    trace.sensors.foot_contact = PerLeg<bool>::filled(true);
    for (const Leg leg : kLegs) {
      const LegGeometry& g = model.legs()[leg];
      const Vec3 p_HF(0.0, g.abad_offset, g.foot_radius - start.p_WB.z());
      trace.sensors.joint_position[leg] = inverse_kinematics(g, p_HF).q;
      trace.feet[leg] = foot_state(g, trace.sensors.joint_position[leg], Vec3::Zero());
    }
    localization.start(start, trace);
  }

  void tick() {
    trace.sensors.time += kTick;
    localization.estimate(model, kTick, trace);
    localization.find_contacts(trace);
  }
  /// Contact flag of `leg` as the controller takes it, after one tick of a raw `flag`.
  bool measured(Leg leg, bool flag) {
    (*trace.sensors.foot_contact)[leg] = flag;
    localization.find_contacts(trace);
    return trace.contacts[leg].measured;
  }
  void walk(Leg leg, bool stance, double progress) {
    trace.gait.walking = true;
    trace.gait.leg[leg].stance = stance;
    trace.gait.leg[leg].progress = progress;
  }
  bool in_contact(Leg leg) {
    localization.find_contacts(trace);
    return trace.contacts[leg].in_contact;
  }

  RobotModel model;
  Localization localization;
  TickTrace trace;
};

TEST(Localization, AFlagCountsWhenItHasHeldForTheDebounceTime) {
  Config config;
  config.estimation.contact_debounce = 4;
  Standing robot(config);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(robot.measured(Leg::kFL, true)) << i;
  EXPECT_TRUE(robot.measured(Leg::kFL, true));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(robot.measured(Leg::kFL, false)) << i;
  EXPECT_FALSE(robot.measured(Leg::kFL, false));
}

TEST(Localization, WrongFlagsThatDoNotLastAreIgnoredHoweverMany) {
  Config config;
  config.estimation.contact_debounce = 3;
  Standing robot(config);
  for (int i = 0; i < 3; ++i) robot.measured(Leg::kRR, true);
  for (int i = 0; i < 300; ++i) EXPECT_TRUE(robot.measured(Leg::kRR, i % 3 == 0)) << i;
  EXPECT_FALSE(robot.measured(Leg::kRR, false) && robot.measured(Leg::kRR, false));
}

TEST(Localization, EveryFootIsDebouncedByItself) {
  Config config;
  config.estimation.contact_debounce = 2;
  Standing robot(config);
  for (int i = 0; i < 2; ++i) robot.localization.find_contacts(robot.trace);
  // FR is wrong in one tick, FL in the next.
  EXPECT_TRUE(robot.measured(Leg::kFR, false));
  (*robot.trace.sensors.foot_contact)[Leg::kFR] = true;
  EXPECT_TRUE(robot.measured(Leg::kFL, false));
  EXPECT_TRUE(robot.trace.contacts[Leg::kFR].measured);
}

TEST(Localization, WithoutDebouncingTheFlagIsTakenAsItIs) {
  Config config;
  config.estimation.contact_debounce = 1;
  Standing robot(config);
  for (const bool flag : {true, false, true, true, false}) {
    EXPECT_EQ(robot.measured(Leg::kRL, flag), flag);
  }
}

TEST(Localization, WithoutContactSensingTheScheduleStandsIn) {
  Standing robot{Config{}};
  robot.trace.sensors.foot_contact.reset();
  for (const bool stance : {true, false}) {
    robot.walk(Leg::kFR, stance, 0.9);
    EXPECT_EQ(robot.in_contact(Leg::kFR), stance);
    EXPECT_EQ(robot.trace.contacts[Leg::kFR].measured, stance);
  }
}

TEST(Localization, AFootThatLandsLateInItsSwingCarriesUntilTheNextLiftOff) {
  Config config;
  config.estimation.contact_debounce = 1;
  config.gait.early_contact_progress = 0.6;
  Standing robot(config);
  const Leg leg = Leg::kFL;
  robot.walk(leg, false, 0.5);
  EXPECT_FALSE(robot.in_contact(leg));  // touching, but just lifted off
  robot.walk(leg, false, 0.65);
  EXPECT_TRUE(robot.in_contact(leg));
  robot.walk(leg, false, 0.8);
  robot.measured(leg, false);  // bounces
  EXPECT_TRUE(robot.in_contact(leg));
  robot.walk(leg, true, 0.1);
  EXPECT_TRUE(robot.in_contact(leg));
  robot.walk(leg, false, 0.1);
  EXPECT_FALSE(robot.in_contact(leg));
}

TEST(Localization, FeetRollOnThePlaneOfASlopeAndOnTheLevelOfATread) {
  const TerrainPlane slope{.a0 = 0.0, .a1 = 0.2, .a2 = -0.1};
  const auto normal = [&](ContactNormal choice, bool stepped) {
    Config config;
    config.terrain.contact_normal = choice;
    Standing robot(config);
    robot.trace.plane = slope;
    robot.trace.ground.stepped = stepped;
    robot.localization.find_contacts(robot.trace);
    const FootContact& contact = robot.trace.contacts[Leg::kRR];
    const double r = robot.localization.foot().radius();
    EXPECT_LT(distance(contact.p_WC, robot.trace.state.p_WF[Leg::kRR] - r * contact.n_W), 1e-15);
    return contact.n_W;
  };
  EXPECT_EQ(normal(ContactNormal::kAuto, false), slope.normal());
  EXPECT_EQ(normal(ContactNormal::kAuto, true), Vec3::UnitZ());
  EXPECT_EQ(normal(ContactNormal::kPlane, true), slope.normal());
  EXPECT_EQ(normal(ContactNormal::kVertical, false), Vec3::UnitZ());
}

TEST(Localization, AStandingRobotStaysWhereItIs) {
  Standing robot{Config{}};
  for (int i = 0; i < 500; ++i) robot.tick();
  EXPECT_LT(distance(robot.trace.state.p_WB, Vec3(0.0, 0.0, 0.29)), 1e-9);
  EXPECT_LT(robot.trace.state.v_WB_W.norm(), 1e-9);
  EXPECT_LT(distance(robot.trace.state.R_WB, Mat3::Identity()), 1e-12);
}

/// Of a robot whose ground rises by 0.27 along x.
CreepEstimate creep_on_slope(CreepModelMode mode, bool stepped) {
  Config config;
  config.creep.mode = mode;
  Standing robot(config);
  robot.trace.plane.a1 = 0.27;
  robot.trace.ground.stepped = stepped;
  robot.tick();
  return robot.trace.creep;
}

TEST(Localization, CreepsDownASlopeButNotOnItsSteps) {
  const Vec3 slip_W = creep_on_slope(CreepModelMode::kStored, false).slip_per_twist_W;
  EXPECT_LT(slip_W.x(), -1e-3);
  EXPECT_EQ(slip_W.y(), 0.0);
  EXPECT_EQ(creep_on_slope(CreepModelMode::kStored, true).slip_per_twist_W, Vec3::Zero());
  EXPECT_EQ(creep_on_slope(CreepModelMode::kOff, false).slip_per_twist_W, Vec3::Zero());
}

// The trunk turns and the legs do not: seen from the ground the shanks twist at the trunk's rate.
TEST(Localization, TheCreepOfTwistingShanksMovesTheTrunk) {
  const auto velocity_along_slope = [](CreepModelMode mode) {
    Config config;
    config.creep.mode = mode;
    config.estimation.attitude_time_constant = 1000.0;
    Standing robot(config);
    robot.trace.plane.a1 = 0.27;
    for (const Leg leg : kLegs) {
      robot.walk(leg, true, 0.5);
      robot.trace.contacts[leg].measured = true;
      robot.trace.contacts[leg].n_W = robot.trace.plane.normal();
    }
    robot.trace.sensors.w_WB_B.z() = 0.7;
    for (int i = 0; i < 10; ++i) {
      robot.localization.estimate(robot.model, kTick, robot.trace);
    }
    return robot.trace.state.v_WB_W.x();
  };
  const double shift =
      velocity_along_slope(CreepModelMode::kStored) - velocity_along_slope(CreepModelMode::kOff);
  EXPECT_LT(shift, 0.0);
  // Ten ticks are only a beginning for a filter that trusts its inertia: a fiftieth of the whole.
  const double whole = 0.7 * creep_on_slope(CreepModelMode::kStored, false).slip_per_twist_W.x();
  EXPECT_LT(shift, 0.02 * whole);
  EXPECT_GT(shift, 1.1 * whole);
}

TEST(Localization, StandsOnTheTruthWhenToldTo) {
  Config config;
  config.estimation.source = EstimatorSource::kTruth;
  Standing robot(config);
  BaseTruth truth;
  truth.p_WB = Vec3(1.0, -2.0, 0.3);
  truth.R_WB = rotation_from_rpy({0.1, -0.2, 2.0});
  robot.trace.sensors.truth = truth;
  robot.tick();
  EXPECT_EQ(robot.trace.state.p_WB, truth.p_WB);
  EXPECT_EQ(robot.trace.state.R_WB, truth.R_WB);
  EXPECT_NEAR(robot.trace.state.rpy.yaw, 2.0, 1e-15);
}

}  // namespace
}  // namespace pirouette
