#include "pirouette/controller/spin_controller.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "pirouette/controller/command_guard.hpp"
#include "pirouette/controller/tick_clock.hpp"
#include "support/closed_loop.hpp"

namespace pirouette {
namespace {

/// Without the self-check, so that the robot stands and walks at once.
Config unchecked() {
  Config config;
  config.safety.self_check = SelfCheckMode::kNone;
  return config;
}

using test::ClosedLoop;
using test::equal;
using test::is_finite;
using test::kTick;
using test::make_controller;
using test::make_plant;
using test::spin;
using test::stand_still;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Everything that a sensor can spoil.
const std::vector<std::function<void(SensorReading&)>> kSpoilers = {
    [](SensorReading& s) { s.time = kNan; },
    [](SensorReading& s) { s.joint_position[Leg::kRL].z() = kNan; },
    [](SensorReading& s) { s.joint_velocity[Leg::kFR].x() = kNan; },
    [](SensorReading& s) { s.specific_force_B.y() = std::numeric_limits<double>::infinity(); },
    [](SensorReading& s) { s.w_WB_B.z() = kNan; },
};

SensorReading spoilt(SensorReading sensors) {
  kSpoilers[1](sensors);
  return sensors;
}

void expect_stood_down(const JointCommand& command, const Config& config) {
  EXPECT_TRUE(equal(command, damped_stand_down(config.joint.kd_stand)));
}

double tilt(const PlantTruth& truth) { return std::acos(truth.base.R_WB(2, 2)); }

/// The readings of a robot that stands, spins and stops, and what the controller answered.
struct Recording {
  BasePose start;
  std::vector<SensorReading> readings;
  std::vector<MotionCommand> motions;
  std::vector<JointCommand> commands;
};

Recording record(const Config& config, double rate) {
  ClosedLoop loop(config);
  Recording out{{loop.plant.truth().base.p_WB, loop.plant.truth().base.R_WB}, {}, {}, {}};
  for (int i = 0; i < 1000; ++i) {
    out.motions.push_back(i < 100 || i > 800 ? stand_still() : spin(rate));
    out.readings.push_back(loop.plant.sense());
    out.commands.push_back(loop.tick(out.readings.back(), out.motions.back()));
  }
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kStanding);
  return out;
}

TEST(SpinController, AnswersTheSameInputsWithTheSameBits) {
  const Config config;
  const Recording recording = record(config, 0.7);
  SpinController again = make_controller(config);
  again.reset(recording.start);
  for (std::size_t i = 0; i < recording.readings.size(); ++i) {
    ASSERT_TRUE(
        equal(again.tick(recording.readings[i], recording.motions[i]), recording.commands[i]))
        << i;
  }
}

TEST(SpinController, IsAsNewAfterReset) {
  const Config config;
  const Recording recording = record(config, 0.7);
  SpinController used = make_controller(config);
  used.reset({recording.start.p_WB + Vec3(1.0, 2.0, 0.0), rot_z(1.0) * recording.start.R_WB});
  for (std::size_t i = 0; i < 333; ++i) used.tick(recording.readings[i], spin(-0.4));
  used.reset(recording.start);
  for (std::size_t i = 0; i < recording.readings.size(); ++i) {
    ASSERT_TRUE(
        equal(used.tick(recording.readings[i], recording.motions[i]), recording.commands[i]))
        << i;
  }
}

TEST(SpinController, SharesNothingWithAnotherOneInTheProcess) {
  Config first, second;
  second.gait.duty = 0.5;
  second.foot.model = FootModel::kCentre;
  second.path.tracker = PathTracker::kLqr;
  second.run.seed = 2;
  const Recording a = record(first, 0.7), b = record(second, -1.0);
  SpinController a_again = make_controller(first), b_again = make_controller(second);
  a_again.reset(a.start);
  b_again.reset(b.start);
  for (std::size_t i = 0; i < a.readings.size(); ++i) {
    ASSERT_TRUE(equal(a_again.tick(a.readings[i], a.motions[i]), a.commands[i])) << i;
    ASSERT_TRUE(equal(b_again.tick(b.readings[i], b.motions[i]), b.commands[i])) << i;
  }
}

TEST(SpinController, BridgesAFewBadReadingsOfAnySensor) {
  const Config config;
  for (const auto& spoil : kSpoilers) {
    ClosedLoop loop(config);
    loop.run(0.2, stand_still());
    loop.run(1.0, spin(0.7));
    for (int i = 0; i < ticks_in(config.safety.max_bad_reading_time, kTick); ++i) {
      SensorReading sensors = loop.plant.sense();
      spoil(sensors);
      ASSERT_TRUE(is_finite(loop.tick(sensors, spin(0.7))));
      ASSERT_EQ(loop.controller.status(), ControllerStatus::kWalking);
    }
    loop.run(2.0, spin(0.7));
    EXPECT_EQ(loop.controller.status(), ControllerStatus::kWalking);
    EXPECT_LT(tilt(loop.plant.truth()), 0.1);
  }
}

TEST(SpinController, TreatsABadCommandLikeABadReading) {
  const Config config = unchecked();
  ClosedLoop loop(config);
  loop.run(0.2, stand_still());
  loop.run(0.5, spin(0.7));
  MotionCommand bad = spin(kNan);
  bad.point = Vec2(kNan, 0.0);
  for (int i = 0; i < ticks_in(config.safety.max_bad_reading_time, kTick); ++i) {
    ASSERT_TRUE(is_finite(loop.tick(bad)));
    ASSERT_EQ(loop.controller.status(), ControllerStatus::kWalking);
  }
  expect_stood_down(loop.tick(bad), config);
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kBadInput);
}

TEST(SpinController, KeepsTimeWhileItBridges) {
  const Config config;
  const Recording recording = record(config, 0.7);
  SpinController undisturbed = make_controller(config), bridging = make_controller(config);
  undisturbed.reset(recording.start);
  bridging.reset(recording.start);
  for (std::size_t i = 0; i < 400; ++i) {
    const SensorReading& sensors = recording.readings[i];
    undisturbed.tick(sensors, recording.motions[i]);
    bridging.tick(i >= 300 && i < 305 ? spoilt(sensors) : sensors, recording.motions[i]);
    ASSERT_NEAR(bridging.trace().gait.cycle, undisturbed.trace().gait.cycle, 1e-12) << i;
  }
}

TEST(SpinController, StandsDownAfterTooManyBadReadingsUntilReset) {
  const Config config;
  ClosedLoop loop(config);
  loop.run(0.2, stand_still());
  loop.run(1.0, spin(0.7));
  for (int i = 0; i < ticks_in(config.safety.max_bad_reading_time, kTick); ++i) {
    loop.tick(spoilt(loop.plant.sense()), spin(0.7));
  }
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kWalking);
  expect_stood_down(loop.tick(spoilt(loop.plant.sense()), spin(0.7)), config);
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kBadInput);

  for (int i = 0; i < 500; ++i) {  // good again, and yet
    expect_stood_down(loop.tick(spin(0.7)), config);
    ASSERT_EQ(loop.controller.status(), ControllerStatus::kBadInput);
  }
  const BaseTruth& base = loop.plant.truth().base;
  loop.controller.reset({base.p_WB, base.R_WB});
  loop.tick(stand_still());
  EXPECT_NE(loop.controller.status(), ControllerStatus::kBadInput);
}

TEST(SpinController, DoesNotStartOnABadReading) {
  const Config config;
  ClosedLoop loop(config);
  expect_stood_down(loop.tick(spoilt(loop.plant.sense()), stand_still()), config);
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kBadInput);
}

TEST(SpinController, StandsDownWhenTheTrunkTiltsTooFar) {
  Config config = unchecked();
  config.estimation.source = EstimatorSource::kTruth;
  for (const double angle : {config.safety.max_tilt - 0.05, config.safety.max_tilt + 0.05}) {
    ClosedLoop loop(config);
    loop.run(0.2, stand_still());
    SensorReading sensors = loop.plant.sense();
    sensors.truth->R_WB = rot_x(angle) * sensors.truth->R_WB;
    const JointCommand& command = loop.tick(sensors, stand_still());
    if (angle < config.safety.max_tilt) {
      EXPECT_EQ(loop.controller.status(), ControllerStatus::kStanding);
    } else {
      EXPECT_EQ(loop.controller.status(), ControllerStatus::kFallen);
      expect_stood_down(command, config);
    }
  }
}

TEST(SpinController, StandsDownWhenTheRobotHasSunk) {
  const Config config = unchecked();
  ClosedLoop loop(config);
  loop.run(0.2, stand_still());
  for (int i = 0; i < 1000 && !is_stood_down(loop.controller.status()); ++i) {
    SensorReading sensors = loop.plant.sense();
    sensors.joint_position =
        PerLeg<Vec3>::filled(Vec3(0.0, 1.9, -2.7));  // hips 9 cm above the feet
    loop.controller.tick(sensors, stand_still());
  }
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kFallen);
}

TEST(SpinController, StandsDownWhenKnockedOver) {
  const Config config = unchecked();
  ClosedLoop loop(config);
  loop.run(0.2, stand_still());
  loop.plant.push(Vec3(0.0, 6.0, 1.5));
  for (int i = 0; i < 1500 && !is_stood_down(loop.controller.status()); ++i) loop.tick(spin(0.7));
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kFallen);
  loop.run(1.0, spin(0.7));
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kFallen);
}

/// Ticks that a controller with `config` works before it stands down.
int ticks_until_stood_down(const Config& config, ControllerStatus expected) {
  ClosedLoop loop(config);
  int ticks = 0;
  while (ticks < 1000 && !is_stood_down(loop.controller.status())) {
    EXPECT_TRUE(is_finite(loop.tick(stand_still())));
    ++ticks;
  }
  EXPECT_EQ(loop.controller.status(), expected);
  expect_stood_down(loop.tick(stand_still()), config);
  return ticks;
}

TEST(SpinController, StandsDownWhenNoForcesCanBeFound) {
  Config config = unchecked();
  config.mpc.min_normal_force = 100.0;
  config.mpc.max_normal_force = 50.0;
  EXPECT_EQ(ticks_until_stood_down(config, ControllerStatus::kSolverFailed),
            ticks_in(config.safety.max_hold_time, kTick) + 1);
}

TEST(SpinController, StandsDownWhenWholeBodyControlFailsAlthoughTheMpcDoesNot) {
  Config config = unchecked();
  config.mpc.solve_period = 0.0;
  config.wbc.weight_acceleration = kNan;
  EXPECT_EQ(ticks_until_stood_down(config, ControllerStatus::kSolverFailed),
            ticks_in(config.safety.max_hold_time, kTick) + 1);
}

TEST(SpinController, StandsDownRatherThanSendACommandThatIsNotFinite) {
  Config config = unchecked();
  config.joint.kp_stance = kNan;
  EXPECT_EQ(ticks_until_stood_down(config, ControllerStatus::kBadCommand), 1);
}

TEST(SpinController, StandsAndTrotsOnTheSpotWithoutContactSensors) {
  Config config = unchecked();
  config.plant.sensors.contact_flags = false;
  ClosedLoop loop(config);
  ASSERT_FALSE(loop.plant.sense().foot_contact.has_value());
  loop.run(1.0, stand_still());
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kStanding);
  const Vec2 start = loop.plant.truth().p_WG.head<2>();
  double lowest = 1.0, farthest = 0.0, most_tilted = 0.0;
  for (int i = 0; i < 2500; ++i) {
    loop.tick(spin(0.0));
    const PlantTruth& truth = loop.plant.truth();
    lowest = std::min(lowest, truth.p_WG.z());
    farthest = std::max(farthest, (truth.p_WG.head<2>() - start).norm());
    most_tilted = std::max(most_tilted, tilt(truth));
  }
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kWalking);
  EXPECT_GT(lowest, 0.9 * config.body.height);
  EXPECT_LT(farthest, 0.02);
  EXPECT_LT(most_tilted, 0.05);
}

TEST(SpinController, SpinsAboutThePointWhereItStood) {
  ClosedLoop loop(Config{});
  loop.run(1.0, stand_still());
  const PlantTruth start = loop.plant.truth();
  YawUnwrapper yaw;
  yaw.reset(rpy_from_rotation(start.base.R_WB).yaw);
  double farthest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    loop.tick(spin(0.7));
    yaw.update(rpy_from_rotation(loop.plant.truth().base.R_WB).yaw);
    farthest = std::max(farthest, (loop.plant.truth().p_WG - start.p_WG).head<2>().norm());
  }
  EXPECT_LT(farthest, 0.02);
  EXPECT_NEAR(yaw.value(), 0.7 * 10.0, 0.25);  // less the ramp up to speed, 0.16 rad
}

}  // namespace
}  // namespace pirouette
