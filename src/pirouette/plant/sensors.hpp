// Simulated sensors: the plant's true values with noise and biases.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "pirouette/base/random.hpp"
#include "pirouette/plant/sensor_config.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Contact flags with delay and errors.
class ContactFlags {
 public:
  /// Draws errors of this `seed`.
  ContactFlags(const SensorConfig& config, std::uint64_t seed);

  /// Flags at `time` (s, never falling); `normal_force` (N) on each foot.
  PerLeg<bool> sample(double time, const PerLeg<double>& normal_force);

 private:
  struct Sample {
    double time;  ///< s
    PerLeg<bool> flags;
  };

  double threshold_;           ///< N
  double delay_;               ///< s
  double error_;               ///< probability that a flag is wrong
  std::deque<Sample> recent_;  ///< oldest first; the first is the last one that is old enough
  RandomStream random_;
};

/// Poses of the trunk measured from outside: with rate, delay, noise and drop-outs.
class PositionAidSource {
 public:
  /// Draws noise of this `seed`.
  PositionAidSource(const SensorConfig& config, std::uint64_t seed);

  /// Measures if a measurement is due at `time` (s, never falling), and returns the newest one that
  /// arrives; absent: none.
  std::optional<PositionAid> sample(double time, const BaseTruth& truth);

 private:
  void measure(double time, const BaseTruth& truth);

  double rate_;                        ///< Hz; 0: none
  double noise_;                       ///< m
  double yaw_noise_;                   ///< rad
  double delay_;                       ///< s
  double dropout_;                     ///< probability that one is lost
  double lost_after_;                  ///< s; 0: never
  std::int64_t next_ = 0;              ///< number of the next measurement, due at next_ / rate_
  std::deque<PositionAid> under_way_;  ///< oldest first
  RandomStream random_;
};

/// All sensors of the robot.
class Sensors {
 public:
  /// Draws the biases of this `seed`. `period` (s) is that of sample().
  Sensors(const SensorConfig& config, std::uint64_t seed, double period);

  /// One sample of every sensor; time never falls from call to call. `normal_force` (N) on each
  /// foot.
  SensorReading sample(const PlantTruth& truth, const PerLeg<double>& normal_force);

 private:
  SensorConfig config_;  ///< as it acts: without noise, biases and errors if it is ideal
  RandomStream noise_;
  ContactFlags contact_flags_;
  RandomStream foot_force_noise_;
  PerLeg<double> foot_force_scale_{};  ///< per N
  PositionAidSource aid_;
  Vec3 accelerometer_bias_B_;  ///< m/s^2
  Vec3 gyro_bias_B_;           ///< rad/s
};

}  // namespace pirouette
