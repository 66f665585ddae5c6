// Check of the inputs at the beginning of a tick.
#pragma once

#include "pirouette/controller/safety_config.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Checked inputs of a tick.
struct GuardedInput {
  SensorReading sensors;         ///< last good values where this reading has none
  MotionCommand command;         ///< last good one where this one is not finite
  PerLeg<bool> encoder_stuck{};  ///< the leg's joint angles are not used
};

/// Bridges short failures of the inputs and reports lasting ones:
///  - a value that is not finite: replaced by the last good inputs, one control period later;
///  - an IMU sample that differs too much from the one before: replaced by that one;
///  - a gyro or an accelerometer whose sample repeats to the last bit while the robot walks:
///    dead;
///  - an encoder whose angle repeats to the last bit while its joint is commanded to move: stuck.
class SensorGuard {
 public:
  /// `period` in s, nominal
  SensorGuard(const SafetyConfig& config, double period) : config_(config), period_(period) {}

  /// Returns false when the inputs have been bad for too long, or none has been good yet. `sent` is
  /// the joint command of the tick before; `walking`: the gait runs.
  bool update(const SensorReading& sensors, const MotionCommand& command, const JointCommand& sent,
              bool walking) noexcept;
  void reset() noexcept;  ///< no good input yet

  /// Checked inputs; valid after an update that returned true.
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
