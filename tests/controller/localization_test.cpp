#include "pirouette/controller/localization.hpp"

#include <gtest/gtest.h>

#include "support/mini_cheetah.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::kTick;

/// A robot that stands level at the origin. The public members are what the next call takes, the
/// last tick's and this one's alike.
class Standing {
 public:
  explicit Standing(const Config& config)
      : model(RobotModel::load(test::kRobot).value()), localization(config, model.legs()) {
    BasePose start;
    start.p_WB.z() = 0.29;
    localization.reset(start);
    sensors.specific_force_B.z() = kGravity;
    sensors.foot_contact = PerLeg<bool>::filled(true);
    for (const Leg leg : kLegs) {
      const LegGeometry& g = model.legs()[leg];
      const Vec3 p_HF(0.0, g.abad_offset, g.foot_radius - start.p_WB.z());
      sensors.joint_position[leg] = inverse_kinematics(g, p_HF).q;
      out.feet[leg] = foot_state(g, sensors.joint_position[leg], Vec3::Zero());
    }
    const RobotState at_rest = localization.start(start, sensors.joint_position);
    out.state = at_rest;
  }

  void estimate() {
    out = localization.estimate(
        {sensors, out.state, contacts, gait, plane, ground, f_W, false, JointCommand{}}, model,
        kTick);
  }
  void find_contacts() {
    contacts = localization.find_contacts(
        {sensors.foot_contact, encoder_stuck, out.state, out.feet, gait, plane, ground}, kTick);
  }
  void tick() {
    sensors.time += kTick;
    estimate();
    find_contacts();
  }
  /// Contact flag of `leg` as the controller takes it, after one tick of a raw `flag`.
  bool measured(Leg leg, bool flag) {
    (*sensors.foot_contact)[leg] = flag;
    find_contacts();
    return contacts[leg].measured;
  }
  void walk(Leg leg, bool stance, double progress) {
    gait.walking = true;
    gait.leg[leg].stance = stance;
    gait.leg[leg].progress = progress;
  }
  bool in_contact(Leg leg) {
    find_contacts();
    return contacts[leg].in_contact;
  }

  RobotModel model;
  Localization localization;
  SensorReading sensors;
  PerLeg<bool> encoder_stuck{};
  GaitPhase gait;
  TerrainPlane plane;
  GroundEstimate ground;
  PerLeg<Vec3> f_W;
  LocalizationOutput out;
  FootContacts contacts;
};

TEST(Localization, AFlagCountsWhenItHasHeldForTheDebounceTime) {
  Config config;
  config.estimation.contact_debounce_time = 4 * kTick;
  Standing robot(config);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(robot.measured(Leg::kFL, true)) << i;
  EXPECT_TRUE(robot.measured(Leg::kFL, true));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(robot.measured(Leg::kFL, false)) << i;
  EXPECT_FALSE(robot.measured(Leg::kFL, false));
}

TEST(Localization, WrongFlagsThatDoNotLastAreIgnoredHoweverMany) {
  Config config;
  config.estimation.contact_debounce_time = 3 * kTick;
  Standing robot(config);
  for (int i = 0; i < 3; ++i) robot.measured(Leg::kRR, true);
  for (int i = 0; i < 140; ++i) EXPECT_TRUE(robot.measured(Leg::kRR, i % 3 == 0)) << i;
  EXPECT_FALSE(robot.measured(Leg::kRR, false) && robot.measured(Leg::kRR, false));
}

TEST(Localization, TheDebounceTimeIsTheSameAtAnyRate) {
  for (const auto& [rate, ticks] : {std::pair(100.0, 1), {200.0, 1}, {500.0, 3}, {1000.0, 6}}) {
    Config config;
    config.control.rate = rate;
    Standing robot(config);
    for (int i = 1; i < ticks; ++i) EXPECT_FALSE(robot.measured(Leg::kFL, true)) << rate;
    EXPECT_TRUE(robot.measured(Leg::kFL, true)) << rate;
  }
}

TEST(Localization, EveryFootIsDebouncedByItself) {
  Config config;
  config.estimation.contact_debounce_time = 2 * kTick;
  Standing robot(config);
  for (int i = 0; i < 2; ++i) robot.find_contacts();
  // FR is wrong in one tick, FL in the next.
  EXPECT_TRUE(robot.measured(Leg::kFR, false));
  (*robot.sensors.foot_contact)[Leg::kFR] = true;
  EXPECT_TRUE(robot.measured(Leg::kFL, false));
  EXPECT_TRUE(robot.contacts[Leg::kFR].measured);
}

TEST(Localization, WithoutDebouncingTheFlagIsTakenAsItIs) {
  Config config;
  config.estimation.contact_debounce_time = 1 * kTick;
  Standing robot(config);
  for (const bool flag : {true, false, true, true, false}) {
    EXPECT_EQ(robot.measured(Leg::kRL, flag), flag);
  }
}

TEST(Localization, AFootWhoseEncodersAreStuckIsNotMeasured) {
  Config config;
  config.estimation.contact_debounce_time = 3 * kTick;
  Standing robot(config);
  for (int i = 0; i < 3; ++i) robot.find_contacts();
  EXPECT_TRUE(robot.contacts[Leg::kFL].measured);
  robot.encoder_stuck[Leg::kFL] = true;
  robot.find_contacts();
  EXPECT_FALSE(robot.contacts[Leg::kFL].measured);
  EXPECT_TRUE(robot.contacts[Leg::kRR].measured);
}

TEST(Localization, WithoutContactSensingTheScheduleStandsIn) {
  Standing robot{Config{}};
  robot.sensors.foot_contact.reset();
  for (const bool stance : {true, false}) {
    robot.walk(Leg::kFR, stance, 0.9);
    EXPECT_EQ(robot.in_contact(Leg::kFR), stance);
    EXPECT_EQ(robot.contacts[Leg::kFR].measured, stance);
  }
}

TEST(Localization, AFootThatLandsLateInItsSwingCarriesUntilTheNextLiftOff) {
  Config config;
  config.estimation.contact_debounce_time = 1 * kTick;
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
    robot.plane = slope;
    robot.ground.stepped = stepped;
    robot.find_contacts();
    const FootContact& contact = robot.contacts[Leg::kRR];
    const double r = robot.localization.rolling_feet()[Leg::kFR].radius();
    EXPECT_LT(distance(contact.p_WC, robot.out.state.p_WF[Leg::kRR] - r * contact.n_W), 1e-15);
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
  EXPECT_LT(distance(robot.out.state.p_WB, Vec3(0.0, 0.0, 0.29)), 1e-9);
  EXPECT_LT(robot.out.state.v_WB_W.norm(), 1e-9);
  EXPECT_LT(distance(robot.out.state.R_WB, Mat3::Identity()), 1e-12);
}

/// Of a robot whose ground rises by 0.27 along x.
CreepEstimate creep_on_slope(CreepModelMode mode, bool stepped) {
  Config config;
  config.creep.mode = mode;
  Standing robot(config);
  robot.plane.a1 = 0.27;
  robot.ground.stepped = stepped;
  robot.tick();
  return robot.out.creep;
}

TEST(Localization, CreepsDownASlopeButNotOnItsSteps) {
  const Vec3 slip_W = creep_on_slope(CreepModelMode::kStored, false).slip_per_twist_W;
  EXPECT_LT(slip_W.x(), -1e-3);
  EXPECT_EQ(slip_W.y(), 0.0);
  EXPECT_EQ(creep_on_slope(CreepModelMode::kStored, true).slip_per_twist_W, Vec3::Zero());
  EXPECT_EQ(creep_on_slope(CreepModelMode::kOff, false).slip_per_twist_W, Vec3::Zero());
}

/// m/s along x that the creep adds to a trunk that turns at `yaw_rate` (rad/s) on that slope while
/// the legs do not: seen from the ground the shanks twist at the trunk's rate. After ten ticks.
double creep_shift(double yaw_rate) {
  const auto velocity_along_slope = [&](CreepModelMode mode) {
    Config config;
    config.creep.mode = mode;
    config.estimation.attitude_time_constant = 1000.0;
    Standing robot(config);
    robot.plane.a1 = 0.27;
    for (const Leg leg : kLegs) {
      robot.walk(leg, true, 0.5);
      robot.contacts[leg].measured = true;
      robot.contacts[leg].n_W = robot.plane.normal();
    }
    robot.sensors.w_WB_B.z() = yaw_rate;
    for (int i = 0; i < 10; ++i) robot.estimate();
    return robot.out.state.v_WB_W.x();
  };
  return velocity_along_slope(CreepModelMode::kStored) - velocity_along_slope(CreepModelMode::kOff);
}

TEST(Localization, TheCreepPointsDownhillWhicheverWayTheRobotTurns) {
  EXPECT_LT(creep_shift(0.7), 0.0);
  EXPECT_LT(creep_shift(-0.7), 0.0);
}

TEST(Localization, ATrunkThatTurnsOverOneFootMovesAboutIt) {
  Config config;
  config.estimation.attitude_time_constant = 1000.0;
  Standing robot(config);
  robot.walk(Leg::kFR, true, 0.5);
  robot.contacts[Leg::kFR].measured = true;
  robot.contacts[Leg::kFR].n_W = Vec3::UnitZ();
  for (const Leg leg : {Leg::kFL, Leg::kRR, Leg::kRL}) robot.walk(leg, false, 0.5);
  const Vec3 w(0.0, 0.0, 0.7);
  robot.sensors.w_WB_B = w;
  for (int i = 0; i < 10; ++i) robot.estimate();
  const Vec3 about_foot = -w.cross(robot.out.feet[Leg::kFR].p_BF);
  const Vec3 v = robot.out.state.v_WB_W;
  // Ten ticks are only a beginning, but in the right direction.
  EXPECT_GT(v.dot(about_foot), 0.01 * about_foot.squaredNorm());
  EXPECT_GT(v.normalized().dot(about_foot.normalized()), 0.95);
}

// The end of a stance counts as little as its beginning: the foot may already lift or slip.
TEST(Localization, AFootAtEitherEndOfItsStanceIsTrustedLess) {
  const auto speed = [](double progress) {
    Standing robot{Config{}};
    for (const Leg leg : kLegs) {
      robot.walk(leg, true, progress);
      robot.contacts[leg].measured = true;
      // All feet say that the trunk moves; the accelerometer says that it rests.
      const Vec3 forwards(0.1, 0.0, 0.0);
      const LegGeometry& g = robot.model.legs()[leg];
      robot.sensors.joint_velocity[leg] =
          foot_jacobian(g, robot.sensors.joint_position[leg]).inverse() * -forwards;
    }
    robot.estimate();
    return robot.out.state.v_WB_W.x();
  };
  const double window = EstimationConfig{}.trust_window;
  ASSERT_GT(window, 0.0);
  EXPECT_LT(speed(0.1 * window), 0.5 * speed(0.5));
  EXPECT_LT(speed(1.0 - 0.1 * window), 0.5 * speed(0.5));
  EXPECT_NEAR(speed(0.1 * window), speed(1.0 - 0.1 * window), 1e-12);
}

// On a slope a sphere's centre is r sqrt(1 + s^2) above the point of the plane below it, not r.
TEST(Localization, TheHeightOnASlopeIsThatOfASphereThatTouchesThePlane) {
  constexpr double kGradient = 0.5;
  Config config;
  Standing robot(config);
  const double radius = robot.model.legs()[Leg::kFR].foot_radius;
  robot.plane.a1 = kGradient;
  // The plane through the feet as they stand, one above the other along x.
  for (const Leg leg : kLegs) {
    robot.contacts[leg].measured = true;
    robot.contacts[leg].n_W = robot.plane.normal();
  }
  double mean_height = 0.0;
  for (const Leg leg : kLegs)
    mean_height +=
        (robot.out.state.p_WF[leg].z() - robot.plane.height(robot.out.state.p_WF[leg].head<2>())) /
        kLegCount;
  robot.plane.a0 = mean_height - radius * std::sqrt(1.0 + square(kGradient));
  const double before = robot.out.state.p_WB.z();
  for (int i = 0; i < 500; ++i) robot.estimate();
  EXPECT_NEAR(robot.out.state.p_WB.z(), before, 0.1 * radius * (std::sqrt(1.25) - 1.0));
}

TEST(Localization, TheCreepOfTwistingShanksMovesTheTrunk) {
  const double shift = creep_shift(0.7);
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
  robot.sensors.truth = truth;
  robot.tick();
  EXPECT_EQ(robot.out.state.p_WB, truth.p_WB);
  EXPECT_EQ(robot.out.state.R_WB, truth.R_WB);
  EXPECT_NEAR(robot.out.state.rpy.yaw, 2.0, 1e-15);
}

}  // namespace
}  // namespace pirouette
