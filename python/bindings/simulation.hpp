// Plant and controller in a closed loop, one control tick after the other.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "pirouette/base/result.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/plant/simulated_world.hpp"
#include "pirouette/plant/terrain.hpp"
#include "pirouette/runtime/control_loop.hpp"
#include "pirouette/trial/trace_file.hpp"

namespace pirouette {

/// The world, robot and controller of a Config, without a trial's duration, path and metrics. The
/// robot stands for gait.stand_time, then does what `command` says.
class Simulation {
 public:
  static Result<Simulation> create(const Config& config);

  /// Back to the start, in the world as configured; `command` stays.
  Errors reset();
  void step(std::int64_t ticks);

  /// The present moment: the controller's tick and the truth that belong together.
  TraceRow row() const { return {controller().trace(), robot_->plant.truth(), yaw_.value()}; }
  double time() const { return robot_->plant.truth().time; }
  const Config& config() const { return config_; }
  const SpinController& controller() const { return robot_->controller; }
  Plant& plant() { return robot_->plant; }
  /// m, of the ground.
  double height(const Vec2& xy) const { return terrain_.height(xy); }

  MotionCommand command;  ///< in force from the next tick on

 private:
  /// What the loop refers to stays where it is.
  struct Robot {
    Robot(Plant in, SpinController by) : plant(std::move(in)), controller(std::move(by)) {}
    Plant plant;
    SpinController controller;
    SimulatedWorld world{plant};
    ControlLoop loop{world, controller};
  };

  Simulation(Config config, RobotDescription description, Terrain terrain,
             std::unique_ptr<Robot> robot);

  void begin();
  void tick();

  Config config_;
  RobotDescription description_;
  Terrain terrain_;
  std::unique_ptr<Robot> robot_;
  YawUnwrapper yaw_;
  std::int64_t standing_ticks_;
};

}  // namespace pirouette
