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
#include "pirouette/model/robot_description.hpp"
#include "pirouette/path/path.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/sensor_reading.hpp"
#include "pirouette/types/tick_trace.hpp"

namespace pirouette {

/// Controller for accurate turns. docs/architecture.md#one-tick
class SpinController final : public Controller {
 public:
  /// Reads the robot (RobotModel::load). Readings and commands are in the joints of its file. The
  /// errors name the file and what it lacks, or why the robot cannot carry itself
  /// (check_standing).
  static Result<SpinController> create(const ControllerConfig& config,
                                       const RobotDescription& robot);

  SpinController(SpinController&&) noexcept;             ///< moves
  SpinController& operator=(SpinController&&) noexcept;  ///< moves
  ~SpinController() override;

  /// Discards all state but the path and starts the estimator from `start`.
  void reset(const BasePose& start) override;

  /// Follows `path` from now on. The path has its own frame and begins where walking begins: at
  /// MotionCommand::point and heading, else at the robot. Absent: no path, the command's twist. May
  /// allocate: not for use within the control loop.
  void follow(std::optional<Path> path);

  /// Joint command of one control period, valid until the next call. No exception, no allocation,
  /// no I/O. After a failure that latches (is_stood_down) every further command is the damped
  /// stand-down until reset().
  const JointCommand& tick(const SensorReading& sensors,
                           const MotionCommand& command) noexcept override;

  /// State that coming ticks depend on besides arguments, configuration and robot: the stages'
  /// memory, the path, trace(). In the machine's byte order.
  std::vector<std::byte> snapshot() const override;

  /// Restores a snapshot() of a controller with the same configuration and robot: coming ticks are
  /// equal bit for bit. Returns false and changes nothing when it is damaged or of another version.
  bool restore(std::span<const std::byte> snapshot) override;

  ControllerStatus status() const noexcept override;     ///< after the last tick
  const RobotState* estimate() const noexcept override;  ///< never nullptr
  const TickTrace& trace() const;                        ///< values of the last tick
  const TickTiming& timing() const;                      ///< of the last tick

 private:
  struct Impl;
  explicit SpinController(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pirouette
