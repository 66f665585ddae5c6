// Plant and controller in a closed loop, one control tick after the other.
#pragma once

#include <cstdint>
#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/plant/terrain.hpp"
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
  TraceRow row() const { return {controller_.trace(), plant_.truth(), yaw_.value()}; }
  double time() const { return plant_.truth().time; }
  const Config& config() const { return config_; }
  const SpinController& controller() const { return controller_; }
  Plant& plant() { return plant_; }
  /// m, of the ground.
  double height(const Vec2& xy) const { return terrain_.height(xy); }

  MotionCommand command;  ///< in force from the next tick on

 private:
  Simulation(Config config, std::string mjcf, Terrain terrain, Plant plant,
             SpinController controller);

  void begin();
  void tick();

  Config config_;
  std::string mjcf_;
  Terrain terrain_;
  Plant plant_;
  SpinController controller_;
  YawUnwrapper yaw_;
  std::int64_t ticks_ = 0;
  std::int64_t standing_ticks_;
};

}  // namespace pirouette
