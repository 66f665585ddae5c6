// The simulated world on MuJoCo: terrain, robot, motors and sensors.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_description.hpp"
#include "pirouette/plant/world_config.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Version of the physics engine in use, such as "4.0.0".
std::string physics_version();

/// What a Plant needs besides its WorldConfig.
struct PlantSetup {
  RobotDescription robot;     ///< what stands in the world
  std::uint64_t seed = 1;     ///< of noise, biases and terrain
  double period = 0.002;      ///< s, from one joint command to the next
  double com_height = 0.0;    ///< m, of the standing robot above the ground
  Vec2 start = Vec2::Zero();  ///< m, of the trunk
  double start_yaw = 0.0;     ///< rad
  bool shows_truth = false;   ///< sensor readings also carry the true state
};

/// Simulation of one robot in its world.
class Plant {
 public:
  /// Errors of the settings alone, found without building the world or reading the robot's file:
  /// the terrain's text, the start beyond its edge, times that are no whole number of steps.
  static Errors check(const WorldConfig& config, const PlantSetup& setup);

  /// Builds config.terrain with the robot standing on it, feet vertically below the hips, on
  /// stairs beside the risers. The
  /// errors name the robot's file, the terrain, or the leg that cannot reach the ground.
  static Result<Plant> create(const WorldConfig& config, const PlantSetup& setup);

  Plant(Plant&&) noexcept;             ///< moves
  Plant& operator=(Plant&&) noexcept;  ///< moves
  ~Plant();

  /// Sensor reading of this moment, with faults. Draws noise: call it once a control tick.
  SensorReading sense();
  /// True state at this moment.
  const PlantTruth& truth() const;

  /// Applies `command` for one period of the setup: physics steps with joint PD and torque limits
  /// in each. Faults act in it: a push at its beginning, weak motors, or a lost command, in whose
  /// place the last one is applied.
  void advance(const JointCommand& command);

  /// Adds `delta_v_W` (m/s, world axes) to the velocity of the whole robot at once.
  void push(const Vec3& delta_v_W);

  /// Sets the sliding friction of feet and ground, where the terrain has none of its own.
  void set_friction(double friction);

  double period() const;                  ///< s, of one advance()
  double physics_step_us_median() const;  ///< wall-clock cost of one physics step

 private:
  struct Impl;
  explicit Plant(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pirouette
