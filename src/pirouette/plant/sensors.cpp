#include "pirouette/plant/sensors.hpp"

#include <cmath>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

constexpr double kRounding = 1e-9;  ///< s, of a time that counts control periods

/// What acts at samples every `period` (s). An inertial sensor averages between two readings: of
/// its white noise the density is given, not the deviation.
SensorConfig effective(SensorConfig config, double period) {
  constexpr double kNoisePeriod = 0.002;  // s, for which the deviations are given
  const double scale = std::sqrt(kNoisePeriod / period);
  config.accelerometer_noise *= scale;
  config.gyro_noise *= scale;
  if (!config.ideal) return config;
  config.encoder_noise = config.joint_velocity_noise = 0.0;
  config.accelerometer_noise = config.accelerometer_bias = 0.0;
  config.gyro_noise = config.gyro_bias = 0.0;
  config.contact_error = config.foot_force_noise = 0.0;
  config.aid_noise = config.aid_yaw_noise = 0.0;
  return config;
}

}  // namespace

ContactFlags::ContactFlags(const SensorConfig& config, std::uint64_t seed)
    : threshold_(config.contact_threshold),
      delay_(config.contact_delay),
      error_(config.contact_error),
      random_(seed, RandomPurpose::kContactErrors) {}

PerLeg<bool> ContactFlags::sample(double time, const PerLeg<double>& normal_force) {
  Sample& now = recent_.emplace_back(Sample{time, {}});
  for (const Leg leg : kLegs) {
    const bool touches = normal_force[leg] > threshold_;
    const bool wrong = random_.uniform() < error_;
    now.flags[leg] = touches != wrong;
  }
  const double newest = time - delay_ + kRounding;
  while (recent_.size() > 1 && recent_[1].time <= newest) recent_.pop_front();
  return recent_.front().flags;
}

PositionAidSource::PositionAidSource(const SensorConfig& config, std::uint64_t seed)
    : rate_(config.aid_rate),
      noise_(config.aid_noise),
      yaw_noise_(config.aid_yaw_noise),
      delay_(config.aid_delay),
      dropout_(config.aid_dropout),
      lost_after_(config.aid_lost_after),
      random_(seed, RandomPurpose::kPositionAid) {}

void PositionAidSource::measure(double time, const BaseTruth& truth) {
  PositionAid aid;
  aid.p_WB = truth.p_WB + random_.gaussian3(noise_);
  aid.yaw = wrap_angle(rpy_from_rotation(truth.R_WB).yaw + yaw_noise_ * random_.gaussian());
  aid.time = time;
  const bool dropped = random_.uniform() < dropout_;
  const bool lost = lost_after_ > 0.0 && time > lost_after_;
  if (!dropped && !lost) under_way_.push_back(aid);
}

std::optional<PositionAid> PositionAidSource::sample(double time, const BaseTruth& truth) {
  if (rate_ > 0.0 && static_cast<double>(next_) / rate_ <= time + kRounding) {
    next_ = std::llround(std::floor((time + kRounding) * rate_)) + 1;
    measure(time, truth);
  }
  std::optional<PositionAid> arrived;
  while (!under_way_.empty() && under_way_.front().time + delay_ <= time + kRounding) {
    arrived = under_way_.front();
    under_way_.pop_front();
  }
  return arrived;
}

Sensors::Sensors(const SensorConfig& config, std::uint64_t seed, double period)
    : config_(effective(config, period)),
      noise_(seed, RandomPurpose::kSensorNoise),
      contact_flags_(config_, seed),
      foot_force_noise_(seed, RandomPurpose::kFootForces),
      aid_(config_, seed) {
  for (const Leg leg : kLegs)
    foot_force_scale_[leg] = config_.foot_force_scale * (0.5 + foot_force_noise_.uniform());
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
  if (config_.contact_flags) reading.foot_contact = contact_flags_.sample(truth.time, normal_force);
  if (config_.foot_forces) {
    reading.foot_force.emplace();
    for (const Leg leg : kLegs) {
      (*reading.foot_force)[leg] = config_.foot_force_offset +
                                   foot_force_scale_[leg] * normal_force[leg] +
                                   config_.foot_force_noise * foot_force_noise_.gaussian();
    }
  }
  reading.aid = aid_.sample(truth.time, truth.base);
  return reading;
}

}  // namespace pirouette
