// Noise and biases on what the plant truly does.
#pragma once

#include <cstdint>

#include "pirouette/config/config.hpp"
#include "pirouette/plant/random.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

class Sensors {
 public:
  /// Draws the biases of this `seed`.
  Sensors(const SensorConfig& config, std::uint64_t seed);

  /// One sample of every sensor. `normal_force` (N) is what presses on each foot.
  SensorReading sample(const PlantTruth& truth, const PerLeg<double>& normal_force);

 private:
  SensorConfig config_;  ///< with noise and biases of zero if the sensors are ideal
  RandomStream noise_;
  Vec3 accelerometer_bias_B_;  ///< m/s^2
  Vec3 gyro_bias_B_;           ///< rad/s
};

}  // namespace pirouette
