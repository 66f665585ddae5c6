// Faults of sensors, motors and wiring, and pushes, at their configured times.
#pragma once

#include <cstdint>
#include <optional>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/random.hpp"
#include "pirouette/plant/fault_config.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// What the motors can give, as shares of what they should.
struct MotorHealth {
  PerLeg<Vec3> torque = PerLeg<Vec3>::filled(Vec3::Ones());  ///< abad, hip, knee
  double torque_limit = 1.0;
};

/// Draws from its own random streams, so that a fault shifts no other noise of the same seed.
class Faults {
 public:
  /// Ticks last `period` (s).
  Faults(const FaultConfig& config, std::uint64_t seed, double period);

  /// Spoils `reading`, sample by sample; its time never falls.
  void spoil(SensorReading& reading);

  MotorHealth motors(double time) const;

  /// Whether the joint command of this tick is lost on its way; call once a tick.
  bool loses_command(double time);

  /// m/s, world axes: the push in the tick that begins at `time`, if there is one. `yaw` (rad) is
  /// the trunk's heading.
  std::optional<Vec3> push(double time, double yaw) const;

 private:
  bool active(double time) const;
  bool concerns(int joint) const;
  void spoil_encoder(SensorReading& reading) const;
  void spoil_imu(SensorReading& reading);
  Vec3 spike(double size);

  FaultConfig config_;
  double period_;  ///< s
  RandomStream spikes_;
  RandomStream losses_;
  std::optional<SensorReading> last_good_;  ///< the reading before the faults began
};

}  // namespace pirouette
