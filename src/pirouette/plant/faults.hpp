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

/// Share of their nominal torque that the motors give.
struct MotorHealth {
  /// Share of each motor: abad, hip, knee.
  PerLeg<Vec3> torque = PerLeg<Vec3>::filled(Vec3::Ones());
  double torque_limit = 1.0;  ///< share of the robot file's torque limits
};

/// Faults of a run. Draws from its own random streams, so that a fault does not shift other noise
/// of the same seed.
class Faults {
 public:
  /// `period` (s) of a control tick.
  Faults(const FaultConfig& config, std::uint64_t seed, double period);

  /// Applies the faults to `reading`; call it once a tick, with times that never fall.
  void spoil(SensorReading& reading);

  /// State of the motors at `time` (s).
  MotorHealth motors(double time) const;

  /// True when the joint command of the tick at `time` (s) is lost; call it once a tick.
  bool loses_command(double time);

  /// Change of velocity (m/s, world axes) by a push in the tick that begins at `time` (s); absent:
  /// none. `yaw` (rad) is the trunk's heading.
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
