#include "pirouette/plant/faults.hpp"

#include <cmath>
#include <limits>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

constexpr double kRounding = 1e-9;  ///< s, of a time that counts control periods
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Faults::Faults(const FaultConfig& config, std::uint64_t seed, double period)
    : config_(config),
      period_(period),
      spikes_(seed, RandomPurpose::kImuSpikes),
      losses_(seed, RandomPurpose::kLostCommands) {}

bool Faults::active(double time) const {
  const double since = time - config_.start + kRounding;
  return since >= 0.0 && (config_.duration == 0.0 || since < config_.duration);
}

bool Faults::concerns(int joint) const {
  return config_.joint == FaultyJoint::kAll || static_cast<int>(config_.joint) == joint;
}

void Faults::spoil(SensorReading& reading) {
  if (!active(reading.time)) {
    last_good_ = reading;
    return;
  }
  // What is broken from the beginning sticks at its first value.
  if (!last_good_) last_good_ = reading;
  spoil_encoder(reading);
  spoil_imu(reading);
  if (reading.foot_contact && config_.contact != ContactFault::kNone)
    (*reading.foot_contact)[config_.leg] = config_.contact == ContactFault::kStuckOn;
  if (reading.foot_force && config_.contact != ContactFault::kNone) {
    const double before = (*last_good_->foot_force)[config_.leg];
    (*reading.foot_force)[config_.leg] = config_.contact == ContactFault::kStuckOn ? before : 0.0;
  }
}

void Faults::spoil_encoder(SensorReading& reading) const {
  if (config_.encoder == EncoderFault::kNone) return;
  const bool stuck = config_.encoder == EncoderFault::kStuck;
  for (int joint = 0; joint < static_cast<int>(kJointsPerLeg); ++joint) {
    if (!concerns(joint)) continue;
    reading.joint_position[config_.leg][joint] =
        stuck ? last_good_->joint_position[config_.leg][joint] : kNoNumber;
    reading.joint_velocity[config_.leg][joint] = stuck ? 0.0 : kNoNumber;
  }
}

void Faults::spoil_imu(SensorReading& reading) {
  reading.w_WB_B.array() += config_.gyro_bias;
  reading.specific_force_B.array() += config_.accelerometer_bias;
  switch (config_.imu) {
    case ImuFault::kNone:
      return;
    case ImuFault::kStuck:
      reading.w_WB_B = last_good_->w_WB_B;
      reading.specific_force_B = last_good_->specific_force_B;
      return;
    case ImuFault::kNan:
      reading.w_WB_B.setConstant(kNoNumber);
      reading.specific_force_B.setConstant(kNoNumber);
      return;
    case ImuFault::kSpikes:
      if (spikes_.uniform() >= config_.spike_probability) return;
      reading.w_WB_B += spike(config_.gyro_spike);
      reading.specific_force_B += spike(config_.accelerometer_spike);
  }
}

Vec3 Faults::spike(double size) { return size * spikes_.gaussian3(1.0).normalized(); }

MotorHealth Faults::motors(double time) const {
  MotorHealth health;
  if (!active(time)) return health;
  for (int joint = 0; joint < static_cast<int>(kJointsPerLeg); ++joint) {
    if (concerns(joint)) health.torque[config_.leg][joint] = config_.motor_strength;
  }
  health.torque_limit = config_.torque_limit_scale;
  return health;
}

bool Faults::loses_command(double time) {
  return active(time) && losses_.uniform() < config_.command_loss;
}

std::optional<Vec3> Faults::push(double time, double yaw) const {
  if (config_.push_speed == 0.0 || !active(time)) return std::nullopt;
  const double since = time - config_.start + kRounding;
  const bool first = since < period_;
  const bool repeated =
      config_.push_period > 0.0 && std::fmod(since, config_.push_period) < period_;
  if (!first && !repeated) return std::nullopt;
  const Vec3 forwards = rot_z(yaw + radians(config_.push_direction_deg)) * Vec3::UnitX();
  return config_.push_speed * forwards;
}

}  // namespace pirouette
