// Parameters of the faults of the simulated robot.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"
#include "pirouette/base/legs.hpp"

namespace pirouette {

template <>
struct EnumNames<Leg> {
  static constexpr std::array<std::string_view, kLegCount> kNames = kLegNames;
};

/// Values of plant.faults.joint.
enum class FaultyJoint { kAbad, kHip, kKnee, kAll };
template <>
struct EnumNames<FaultyJoint> {
  static constexpr std::array<std::string_view, 4> kNames = {"abad", "hip", "knee", "all"};
};

/// Values of plant.faults.encoder.
enum class EncoderFault { kNone, kStuck, kNan };
template <>
struct EnumNames<EncoderFault> {
  static constexpr std::array<std::string_view, 3> kNames = {"none", "stuck", "nan"};
};

/// Values of plant.faults.imu.
enum class ImuFault { kNone, kStuck, kNan, kSpikes };
template <>
struct EnumNames<ImuFault> {
  static constexpr std::array<std::string_view, 4> kNames = {"none", "stuck", "nan", "spikes"};
};

/// Values of plant.faults.contact.
enum class ContactFault { kNone, kStuckOn, kStuckOff };
template <>
struct EnumNames<ContactFault> {
  static constexpr std::array<std::string_view, 3> kNames = {"none", "stuck_on", "stuck_off"};
};

/// Parameters `plant.faults.*`.
struct FaultConfig {
  double start = 10.0;
  double duration = 0.0;
  Leg leg = Leg::kFR;
  FaultyJoint joint = FaultyJoint::kKnee;
  EncoderFault encoder = EncoderFault::kNone;
  ImuFault imu = ImuFault::kNone;
  double spike_probability = 0.05;
  double gyro_spike = 10.0;
  double accelerometer_spike = 100.0;
  double gyro_bias = 0.0;
  double accelerometer_bias = 0.0;
  ContactFault contact = ContactFault::kNone;
  double motor_strength = 1.0;
  double torque_limit_scale = 1.0;
  double command_loss = 0.0;
  double push_speed = 0.0;
  double push_direction_deg = 0.0;
  double push_period = 0.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.start, "start", "s", Range{0.0, 1e6}, "The faults below begin at this simulated time.");
    v(s.duration, "duration", "s", Range{0.0, 1e6}, "They last this long; 0: to the end.");
    v(s.leg, "leg", "Leg of encoder, contact flag and weak motor.");
    v(s.joint, "joint", "Joint of encoder and weak motor; all: the leg's three.");
    v(s.encoder, "encoder",
      "stuck: the angle repeats its last value and the velocity reads 0; nan: both are no number.");
    v(s.imu, "imu",
      "stuck: gyro and accelerometer repeat their last values; nan: they are no number; spikes: "
      "single samples are off by gyro_spike and accelerometer_spike in a random direction.");
    v(s.spike_probability, "spike_probability", "1", Range{0.0, 1.0},
      "Probability that a sample is a spike.");
    v(s.gyro_spike, "gyro_spike", "rad/s", Range{0.0, 1e4}, "Size of a gyro spike.");
    v(s.accelerometer_spike, "accelerometer_spike", "m/s^2", Range{0.0, 1e5},
      "Size of an accelerometer spike.");
    v(s.gyro_bias, "gyro_bias", "rad/s", Range{-10.0, 10.0},
      "Added to every axis of the gyro, on top of plant.sensors.gyro_bias.");
    v(s.accelerometer_bias, "accelerometer_bias", "m/s^2", Range{-100.0, 100.0},
      "Added to every axis of the accelerometer, likewise.");
    v(s.contact, "contact",
      "The leg's contact flag reads true (stuck_on) or false (stuck_off), its force sensor what it "
      "read before or 0.");
    v(s.motor_strength, "motor_strength", "1", Range{0.0, 2.0},
      "Torque of the weak motor as a share of what it should give.");
    v(s.torque_limit_scale, "torque_limit_scale", "1", Range{0.0, 1.0},
      "Torque limit of every motor as a share of the robot file's.");
    v(s.command_loss, "command_loss", "1", Range{0.0, 1.0},
      "Probability that a tick's joint command does not arrive; the motors hold the last one.");
    v(s.push_speed, "push_speed", "m/s", Range{0.0, 10.0},
      "A push adds this to the velocity of the whole robot at once; 0: none.");
    v(s.push_direction_deg, "push_direction_deg", "deg", Range{-360.0, 360.0},
      "Direction of the push from the trunk's heading at that moment: 90 is to the left.");
    v(s.push_period, "push_period", "s", Range{0.0, 1e6},
      "The push repeats after this time; 0: a single push.");
  }
};

}  // namespace pirouette
