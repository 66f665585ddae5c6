// The simulated world on MuJoCo: terrain, robot, motors and sensors.
#pragma once

#include <memory>
#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Of the physics engine in use, such as "4.0.0".
std::string physics_version();

class Plant {
 public:
  /// Builds the terrain of config.plant.terrain around the robot of `mjcf` and puts the robot on
  /// it, feet vertically below the hips, at (`x`, `y`) and `yaw`.
  static Result<Plant> create(const Config& config, const std::string& mjcf,
                              const Vec2& xy = Vec2::Zero(), double yaw = 0.0);

  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;
  ~Plant();

  /// The sensors at this moment, as plant.faults spoils them; draws noise, so call once a control
  /// tick.
  SensorReading sense();
  const PlantTruth& truth() const;

  /// Holds `command` for one control period (1 / control.rate): physics steps with joint PD and
  /// torque limits in each. What plant.faults has for this moment happens: a push at its beginning,
  /// weak motors in it, or the command is lost and the last one stays in force.
  void advance(const JointCommand& command);

  /// Adds to the whole robot's velocity at once: a push. m/s, world axes.
  void push(const Vec3& delta_v_W);

  /// Sliding friction of feet and ground from now on, where the terrain has none of its own.
  void set_friction(double friction);

  double physics_step_us_median() const;  ///< wall-clock cost of one physics step

 private:
  struct Impl;
  explicit Plant(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pirouette
