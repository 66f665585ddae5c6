// Interface between the control loop and a controller.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Wall-clock times of the last tick; not in TickTrace, which must be reproducible.
struct TickTiming {
  double mpc_us = 0.0;  ///< us, MPC solution; 0 in ticks without one
  double wbc_us = 0.0;  ///< us, whole-body control
};

/// Controller of a quadruped: sensor readings and a motion command in, joint commands out.
class Controller {
 public:
  virtual ~Controller() = default;

  /// Discards what it has learnt and starts from the pose `start`.
  virtual void reset(const BasePose& start) = 0;

  /// Joint command of one control period, valid until the next call. No exception, no I/O.
  virtual const JointCommand& tick(const SensorReading& sensors,
                                   const MotionCommand& command) noexcept = 0;

  /// Status after the last tick.
  virtual ControllerStatus status() const noexcept = 0;

  /// Estimated state of the robot; nullptr if the controller estimates none.
  virtual const RobotState* estimate() const noexcept { return nullptr; }

  /// State of the controller as bytes, for restore(); empty if it supports no snapshots.
  virtual std::vector<std::byte> snapshot() const { return {}; }

  /// Restores the state of a snapshot() of a controller with the same configuration and version.
  /// Returns false and changes nothing when `snapshot` does not fit.
  virtual bool restore(std::span<const std::byte> snapshot) {
    static_cast<void>(snapshot);
    return false;
  }

 protected:
  Controller() = default;
  Controller(const Controller&) = default;
  Controller(Controller&&) noexcept = default;
  Controller& operator=(const Controller&) = default;
  Controller& operator=(Controller&&) noexcept = default;
};

}  // namespace pirouette
