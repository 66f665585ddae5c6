#include "pirouette/plant/faults.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pirouette/base/rotation.hpp"
#include "support/mini_cheetah.hpp"

namespace pirouette {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr std::uint64_t kSeed = 1;

/// A reading in which every sample differs from that of any other time.
SensorReading reading_at(double time) {
  SensorReading reading;
  reading.time = time;
  reading.joint_position = PerLeg<Vec3>::filled(Vec3(1.0, 2.0, 3.0) + Vec3::Constant(time));
  reading.joint_velocity = PerLeg<Vec3>::filled(Vec3(4.0, 5.0, 6.0) + Vec3::Constant(time));
  reading.specific_force_B = Vec3(time, 0.0, kGravity);
  reading.w_WB_B = Vec3(0.0, time, 0.7);
  reading.foot_contact = PerLeg<bool>{{true, false, true, false}};
  return reading;
}

bool same(const SensorReading& a, const SensorReading& b) {
  bool equal = a.specific_force_B == b.specific_force_B && a.w_WB_B == b.w_WB_B;
  for (const Leg leg : kLegs) {
    equal = equal && a.joint_position[leg] == b.joint_position[leg] &&
            a.joint_velocity[leg] == b.joint_velocity[leg] &&
            (*a.foot_contact)[leg] == (*b.foot_contact)[leg];
  }
  return equal;
}

/// Broken in every way from 1 s to 1.5 s.
FaultConfig broken() {
  FaultConfig config;
  config.start = 1.0;
  config.duration = 0.5;
  config.leg = Leg::kRR;
  config.joint = FaultyJoint::kHip;
  config.encoder = EncoderFault::kStuck;
  config.imu = ImuFault::kStuck;
  config.contact = ContactFault::kStuckOff;
  config.motor_strength = 0.5;
  config.torque_limit_scale = 0.25;
  config.command_loss = 1.0;
  config.push_speed = 0.5;
  config.push_period = 0.1;
  return config;
}

SensorReading spoilt(Faults& faults, double time) {
  SensorReading reading = reading_at(time);
  faults.spoil(reading);
  return reading;
}

TEST(Faults, HappenFromTheirStartForTheirDuration) {
  Faults faults(broken(), kSeed, kTick);
  for (int tick = 0; tick < 1000; ++tick) {
    const double time = tick * kTick;
    const bool within = tick >= 500 && tick < 750;
    EXPECT_EQ(same(spoilt(faults, time), reading_at(time)), !within) << time;
    EXPECT_EQ(faults.motors(time).torque_limit, within ? 0.25 : 1.0) << time;
    EXPECT_EQ(faults.loses_command(time), within) << time;
    EXPECT_EQ(faults.push(time, 0.0).has_value(), within && tick % 50 == 0) << time;
  }
}

TEST(Faults, LastToTheEndWithoutADuration) {
  FaultConfig config = broken();
  config.duration = 0.0;
  EXPECT_EQ(Faults(config, kSeed, kTick).motors(1e5).torque_limit, 0.25);
}

TEST(Faults, AreNoneByDefault) {
  Faults faults(FaultConfig{}, kSeed, kTick);
  for (const double time : {0.0, 9.0, 11.0, 1000.0}) {
    EXPECT_TRUE(same(spoilt(faults, time), reading_at(time)));
    EXPECT_FALSE(faults.loses_command(time));
    EXPECT_FALSE(faults.push(time, 0.0).has_value());
    const MotorHealth motors = faults.motors(time);
    EXPECT_EQ(motors.torque_limit, 1.0);
    for (const Vec3& share : motors.torque) EXPECT_EQ(share, Vec3::Ones());
  }
}

TEST(StuckEncoder, RepeatsItsAngleAndReadsNoVelocity) {
  Faults faults(broken(), kSeed, kTick);
  spoilt(faults, 0.998);
  const SensorReading reading = spoilt(faults, 1.2);
  const Vec3 last = reading_at(0.998).joint_position[Leg::kRR];
  const SensorReading healthy = reading_at(1.2);
  EXPECT_EQ(reading.joint_position[Leg::kRR], Vec3(healthy.joint_position[Leg::kRR].x(), last.y(),
                                                   healthy.joint_position[Leg::kRR].z()));
  EXPECT_EQ(reading.joint_velocity[Leg::kRR].y(), 0.0);
  EXPECT_EQ(reading.joint_position[Leg::kRL], healthy.joint_position[Leg::kRL]);
}

TEST(StuckEncoder, SticksAtItsFirstValueWhenBrokenFromTheBeginning) {
  FaultConfig config = broken();
  config.start = 0.0;
  config.joint = FaultyJoint::kAll;
  Faults faults(config, kSeed, kTick);
  EXPECT_EQ(spoilt(faults, 0.0).joint_position[Leg::kRR], reading_at(0.0).joint_position[Leg::kRR]);
  EXPECT_EQ(spoilt(faults, 0.1).joint_position[Leg::kRR], reading_at(0.0).joint_position[Leg::kRR]);
}

TEST(DeadSensors, ReadNoNumber) {
  FaultConfig config = broken();
  config.encoder = EncoderFault::kNan;
  config.imu = ImuFault::kNan;
  Faults faults(config, kSeed, kTick);
  const SensorReading reading = spoilt(faults, 1.0);
  EXPECT_TRUE(std::isnan(reading.joint_position[Leg::kRR].y()));
  EXPECT_TRUE(std::isnan(reading.joint_velocity[Leg::kRR].y()));
  EXPECT_TRUE(std::isfinite(reading.joint_position[Leg::kRR].x()));
  EXPECT_TRUE(reading.w_WB_B.array().isNaN().all());
  EXPECT_TRUE(reading.specific_force_B.array().isNaN().all());
}

TEST(StuckImu, RepeatsItsLastSample) {
  Faults faults(broken(), kSeed, kTick);
  spoilt(faults, 0.998);
  const SensorReading reading = spoilt(faults, 1.3);
  EXPECT_EQ(reading.w_WB_B, reading_at(0.998).w_WB_B);
  EXPECT_EQ(reading.specific_force_B, reading_at(0.998).specific_force_B);
}

TEST(ImuSpikes, HaveTheirSizeAndProbability) {
  FaultConfig config;
  config.start = 0.0;
  config.imu = ImuFault::kSpikes;
  config.spike_probability = 0.1;
  Faults faults(config, kSeed, kTick);
  constexpr int kSamples = 10000;
  int spikes = 0;
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const SensorReading healthy = reading_at(i * kTick), reading = spoilt(faults, i * kTick);
    const Vec3 off = reading.w_WB_B - healthy.w_WB_B;
    if (off.isZero(0.0)) continue;
    ++spikes;
    sum += off;
    ASSERT_NEAR(off.norm(), config.gyro_spike, 1e-9);
    ASSERT_NEAR((reading.specific_force_B - healthy.specific_force_B).norm(),
                config.accelerometer_spike, 1e-9);
  }
  // Five standard deviations of 10000 draws of probability 0.1; and of a mean of random directions.
  EXPECT_NEAR(spikes, 1000, 150);
  EXPECT_LT(sum.norm() / spikes, 5.0 * config.gyro_spike / std::sqrt(spikes));
}

TEST(ImuBias, ComesOnTopOfEveryAxis) {
  FaultConfig config;
  config.start = 1.0;
  config.gyro_bias = 0.01;
  config.accelerometer_bias = -0.1;
  Faults faults(config, kSeed, kTick);
  EXPECT_TRUE(same(spoilt(faults, 0.5), reading_at(0.5)));
  EXPECT_EQ(spoilt(faults, 1.5).w_WB_B, Vec3(reading_at(1.5).w_WB_B.array() + 0.01));
  EXPECT_EQ(spoilt(faults, 1.5).specific_force_B,
            Vec3(reading_at(1.5).specific_force_B.array() - 0.1));
}

TEST(StuckContactFlag, ReadsTheSameWhateverTheFootDoes) {
  for (const ContactFault fault : {ContactFault::kStuckOn, ContactFault::kStuckOff}) {
    FaultConfig config;
    config.start = 0.0;
    config.contact = fault;
    for (const Leg leg : kLegs) {
      config.leg = leg;
      Faults faults(config, kSeed, kTick);
      const SensorReading reading = spoilt(faults, 0.0);
      for (const Leg other : kLegs) {
        const bool expected =
            other == leg ? fault == ContactFault::kStuckOn : (*reading_at(0.0).foot_contact)[other];
        EXPECT_EQ((*reading.foot_contact)[other], expected);
      }
    }
  }
}

TEST(WeakMotor, GivesItsShareOfTheTorqueFromTheStart) {
  Config config = ideal_config();
  config.plant.faults = broken();
  config.plant.faults.command_loss = config.plant.faults.push_speed = 0.0;
  config.plant.faults.start = 2 * kTick;
  Plant plant = make_plant(config);
  JointCommand command;
  command[Leg::kRR].tau = Vec3(1.0, 2.0, 3.0);
  command[Leg::kFL].tau = Vec3(0.0, 0.0, 20.0);
  for (int i = 0; i < 2; ++i) plant.advance(command);
  EXPECT_EQ(plant.truth().joint_torque[Leg::kRR], Vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(plant.truth().joint_torque[Leg::kFL].z(), 20.0);
  plant.advance(command);
  EXPECT_EQ(plant.truth().joint_torque[Leg::kRR], Vec3(1.0, 1.0, 3.0));
  EXPECT_EQ(plant.truth().joint_torque[Leg::kFL].z(), 7.0);  // a quarter of 28 N m
}

TEST(LostCommand, LeavesTheLastOneInForce) {
  Config config = ideal_config();
  config.plant.faults.start = 0.0;
  config.plant.faults.command_loss = 0.3;
  Plant plant = make_plant(config);
  constexpr int kTicks = 1000;
  int lost = 0;
  for (int i = 0; i < kTicks; ++i) {
    const double before = plant.truth().joint_torque[Leg::kFR].x();
    JointCommand command;
    command[Leg::kFR].tau.x() = 1.0 + 1e-3 * i;
    plant.advance(command);
    const double torque = plant.truth().joint_torque[Leg::kFR].x();
    if (torque == command[Leg::kFR].tau.x()) continue;
    EXPECT_EQ(torque, before) << i;
    ++lost;
  }
  EXPECT_NEAR(lost, 300, 75);  // five standard deviations
}

TEST(Push, SetsTheWholeRobotInMotionInTheDirectionOfItsHeading) {
  for (const double direction_deg : {0.0, 90.0, 225.0}) {
    for (const double yaw : {0.0, 1.0}) {
      Config config = ideal_config();
      config.plant.faults.start = 2 * kTick;
      config.plant.faults.push_speed = 0.5;
      config.plant.faults.push_direction_deg = direction_deg;
      Plant pushed = make_plant(config, Vec2::Zero(), yaw);
      Plant by_hand = make_plant(ideal_config(), Vec2::Zero(), yaw);
      const JointCommand command = hold(pushed.truth());
      for (int i = 0; i < 2; ++i) {
        pushed.advance(command);
        by_hand.advance(command);
      }
      EXPECT_EQ(pushed.truth().p_WG, by_hand.truth().p_WG);
      const double heading = rpy_from_rotation(by_hand.truth().base.R_WB).yaw;
      by_hand.push(rot_z(heading + radians(direction_deg)) * Vec3(0.5, 0.0, 0.0));
      pushed.advance(command);
      by_hand.advance(command);
      EXPECT_EQ(pushed.truth().v_WG_W, by_hand.truth().v_WG_W);
    }
  }
}

TEST(Payload, AddsItsMassWhereItLies) {
  Config config = ideal_config();
  const PlantTruth empty = make_plant(config).truth();
  config.plant.payload = 2.0;
  config.plant.payload_position = {0.1, -0.02, 0.05};
  Plant plant = make_plant(config);
  const PlantTruth truth = plant.truth();
  constexpr double kMass = 8.912;
  const auto com_B = [](const PlantTruth& t) -> Vec3 {
    return t.base.R_WB.transpose() * (t.p_WG - t.base.p_WB);
  };
  const Vec3 expected = (kMass * com_B(empty) + 2.0 * Vec3(0.1, -0.02, 0.05)) / (kMass + 2.0);
  // The start puts the heavier CoM at the same height, so that the legs bend a little more.
  EXPECT_NEAR((com_B(truth) - expected).norm(), 0.0, 1e-3);
  stand(plant, 2.0);
  Vec3 ground_force = Vec3::Zero();
  for (const Vec3& f : plant.truth().f_W) ground_force += f;
  EXPECT_NEAR(ground_force.z(), (kMass + 2.0) * kGravity, 0.02 * (kMass + 2.0) * kGravity);
}

TEST(TrunkErrors, ScaleItsMassAndShiftItsCom) {
  Config config = ideal_config();
  const PlantTruth nominal = make_plant(config).truth();
  config.plant.trunk_com_offset = {0.03, 0.02, -0.01};
  const PlantTruth shifted = make_plant(config).truth();
  constexpr double kMass = 8.912, kTrunk = 3.3 + 4 * 0.055;  // with the abad rotors, kg
  const auto com_B = [](const PlantTruth& t) -> Vec3 {
    return t.base.R_WB.transpose() * (t.p_WG - t.base.p_WB);
  };
  const Vec3 expected = kTrunk / kMass * Vec3(0.03, 0.02, -0.01);
  EXPECT_NEAR((com_B(shifted) - com_B(nominal) - expected).norm(), 0.0, 1e-3);

  config = ideal_config();
  config.plant.trunk_mass_scale = 1.5;
  Plant plant = make_plant(config);
  stand(plant, 2.0);
  Vec3 ground_force = Vec3::Zero();
  for (const Vec3& f : plant.truth().f_W) ground_force += f;
  const double weight = (kMass + 0.5 * kTrunk) * kGravity;
  EXPECT_NEAR(ground_force.z(), weight, 0.02 * weight);
}

TEST(PlantWithFaults, DrawsTheSameNoiseAsWithoutThem) {
  Config config = ideal_config();
  config.plant.sensors.ideal = false;
  Plant healthy = make_plant(config);
  config.plant.faults.start = 0.0;
  config.plant.faults.imu = ImuFault::kSpikes;
  config.plant.faults.command_loss = 0.5;
  Plant faulty = make_plant(config);
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(healthy.sense().joint_position[Leg::kFL], faulty.sense().joint_position[Leg::kFL]);
    faulty.advance(JointCommand{});
    healthy.advance(JointCommand{});
  }
}

}  // namespace
}  // namespace pirouette
