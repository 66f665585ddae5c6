// What a loop asks of a controller, whoever wrote it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Wall-clock cost of the last tick; kept out of TickTrace, which must be reproducible.
struct TickTiming {
  double mpc_us = 0.0;  ///< 0 in ticks that did not solve the MPC
  double wbc_us = 0.0;
};

/// Sensor readings and a motion command in, joint commands out.
class Controller {
 public:
  virtual ~Controller() = default;

  /// Forgets what it has learnt and starts from the pose `start`.
  virtual void reset(const BasePose& start) = 0;

  /// One control period. No exception, no I/O.
  virtual const JointCommand& tick(const SensorReading& sensors,
                                   const MotionCommand& command) noexcept = 0;

  virtual ControllerStatus status() const noexcept = 0;

  /// Where the controller believes the robot to be; nullptr for one that does not estimate.
  virtual const RobotState* estimate() const noexcept { return nullptr; }

  /// All that the controller remembers, for restore(); empty for one that cannot tell.
  virtual std::vector<std::byte> snapshot() const { return {}; }

  /// Puts the controller where the one was that gave `snapshot`, which has the same configuration
  /// and version. False: it does not fit; the controller is then as it was.
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
