// First station of a tick: what of the inputs can be believed.
#pragma once

#include "pirouette/controller/safety_config.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

struct GuardedInput {
  SensorReading sensors;
  MotionCommand command;
  PerLeg<bool> encoder_stuck{};  ///< the leg's angles are not to be believed
};

/// Bridges what fails for a moment, and tells when a failure lasts:
///  - a value that is not finite: the last good inputs stand in, one control period on;
///  - an IMU sample that no trunk could follow: the one before stands in;
///  - a gyro or an accelerometer that repeats itself to the last bit while the robot walks, which a
///    live one does not;
///  - an encoder that repeats itself to the last bit while its joint is commanded to move.
class SensorGuard {
 public:
  SensorGuard(const SafetyConfig& config, double period) : config_(config), period_(period) {}

  /// False: the inputs have been bad for too long, or there has been no good one yet. `sent` is the
  /// joint command of the tick before; `walking`: the gait runs.
  bool update(const SensorReading& sensors, const MotionCommand& command, const JointCommand& sent,
              bool walking) noexcept;
  void reset() noexcept;

  /// Inputs to work with; good after an update that returned true.
  const GuardedInput& input() const { return input_; }

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, period, input, last_raw, started, bad_inputs, outliers, gyro_repeats,
           accelerometer_repeats, blind_travel] = self;
    visit(input, last_raw, started, bad_inputs, outliers, gyro_repeats, accelerometer_repeats,
          blind_travel);
  }

 private:
  void watch_imu(const SensorReading& sensors, bool walking) noexcept;
  void watch_encoders(const SensorReading& sensors, const JointCommand& sent) noexcept;
  bool is_outlier(const SensorReading& sensors) const noexcept;

  SafetyConfig config_;
  double period_;  ///< s, nominal
  GuardedInput input_;
  SensorReading last_raw_;
  bool started_ = false;
  int bad_inputs_ = 0;    ///< in a row
  int outliers_ = 0;      ///< in a row
  int gyro_repeats_ = 0;  ///< samples in a row
  int accelerometer_repeats_ = 0;
  PerLeg<Vec3> blind_travel_{};  ///< rad, commanded since the encoder's last change
};

}  // namespace pirouette
