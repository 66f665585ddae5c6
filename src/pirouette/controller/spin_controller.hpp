// The whole controller: sensor readings and a motion command in, joint commands out.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/controller/controller.hpp"
#include "pirouette/controller/controller_config.hpp"
#include "pirouette/path/path.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/sensor_reading.hpp"
#include "pirouette/types/tick_trace.hpp"

namespace pirouette {

class SpinController final : public Controller {
 public:
  /// Loads the robot's own model from `mjcf`.
  static Result<SpinController> create(const ControllerConfig& config, const std::string& mjcf);

  SpinController(SpinController&&) noexcept;
  SpinController& operator=(SpinController&&) noexcept;
  ~SpinController() override;

  /// Forgets everything but the path and starts the estimator from `start`.
  void reset(const BasePose& start) override;

  /// From now on commands are followed along `path`, given in a frame of its own: where walking
  /// begins (MotionCommand::point and heading, else where the robot stands) the path begins.
  /// Absent: no path, the command's twist. Not for use within the control loop: it may allocate.
  void follow(std::optional<Path> path);

  /// One control period. No exception, no allocation, no I/O. After a failure that latches
  /// (is_stood_down) every further command is the damped stand-down until reset().
  const JointCommand& tick(const SensorReading& sensors,
                           const MotionCommand& command) noexcept override;

  /// Everything that coming ticks depend on besides their arguments, configuration and robot: the
  /// stages' memory, the path, trace(). In the machine's own byte order.
  std::vector<std::byte> snapshot() const override;

  /// Goes on bit for bit as the controller did of which `snapshot` was taken, with the same
  /// configuration and robot. False, and nothing has changed: it is damaged, or of another version.
  bool restore(std::span<const std::byte> snapshot) override;

  ControllerStatus status() const noexcept override;
  const RobotState* estimate() const noexcept override;
  const TickTrace& trace() const;
  const TickTiming& timing() const;

 private:
  struct Impl;
  explicit SpinController(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pirouette
