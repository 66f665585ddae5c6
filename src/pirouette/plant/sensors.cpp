#include "pirouette/plant/sensors.hpp"

namespace pirouette {
namespace {

SensorConfig effective(SensorConfig config) {
  if (!config.ideal) return config;
  config.encoder_noise = config.joint_velocity_noise = 0.0;
  config.accelerometer_noise = config.accelerometer_bias = 0.0;
  config.gyro_noise = config.gyro_bias = 0.0;
  return config;
}

}  // namespace

Sensors::Sensors(const SensorConfig& config, std::uint64_t seed)
    : config_(effective(config)), noise_(seed, RandomPurpose::kSensorNoise) {
  RandomStream bias(seed, RandomPurpose::kSensorBias);
  accelerometer_bias_B_ = bias.gaussian3(config_.accelerometer_bias);
  gyro_bias_B_ = bias.gaussian3(config_.gyro_bias);
}

SensorReading Sensors::sample(const PlantTruth& truth, const PerLeg<double>& normal_force) {
  SensorReading reading;
  reading.time = truth.time;
  for (const Leg leg : kLegs) {
    reading.joint_position[leg] =
        truth.joint_position[leg] + noise_.gaussian3(config_.encoder_noise);
    reading.joint_velocity[leg] =
        truth.joint_velocity[leg] + noise_.gaussian3(config_.joint_velocity_noise);
  }
  const Vec3 specific_force_W = truth.a_WB_W + kGravity * Vec3::UnitZ();
  reading.specific_force_B = truth.base.R_WB.transpose() * specific_force_W +
                             accelerometer_bias_B_ + noise_.gaussian3(config_.accelerometer_noise);
  reading.w_WB_B = truth.base.w_WB_B + gyro_bias_B_ + noise_.gaussian3(config_.gyro_noise);
  if (config_.contact_flags) {
    PerLeg<bool>& flags = reading.foot_contact.emplace();
    for (const Leg leg : kLegs) flags[leg] = normal_force[leg] > config_.contact_threshold;
  }
  return reading;
}

}  // namespace pirouette
