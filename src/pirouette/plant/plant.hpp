// The simulated world on MuJoCo: terrain, robot, motors and sensors.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/plant/world_config.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Of the physics engine in use, such as "4.0.0".
std::string physics_version();

/// What a Plant must know besides its world.
struct PlantSetup {
  std::string mjcf;           ///< path of the robot's file
  std::uint64_t seed = 1;     ///< of noise, biases and terrain
  double period = 0.002;      ///< s, from one joint command to the next
  double com_height = 0.0;    ///< m, of the standing robot above the ground
  Vec2 start = Vec2::Zero();  ///< m, of the trunk
  double start_yaw = 0.0;     ///< rad
  bool shows_truth = false;   ///< sensor readings carry the true state too
};

class Plant {
 public:
  /// Builds config.terrain around the robot and puts the robot on it, feet vertically below the
  /// hips.
  static Result<Plant> create(const WorldConfig& config, const PlantSetup& setup);

  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;
  ~Plant();

  /// The sensors at this moment, as the faults spoil them; draws noise, so call once a control
  /// tick.
  SensorReading sense();
  const PlantTruth& truth() const;

  /// Holds `command` for one period of the setup: physics steps with joint PD and
  /// torque limits in each. What the faults have for this moment happens: a push at its beginning,
  /// weak motors in it, or the command is lost and the last one stays in force.
  void advance(const JointCommand& command);

  /// Adds to the whole robot's velocity at once: a push. m/s, world axes.
  void push(const Vec3& delta_v_W);

  /// Sliding friction of feet and ground from now on, where the terrain has none of its own.
  void set_friction(double friction);

  double period() const;                  ///< s, of one advance()
  double physics_step_us_median() const;  ///< wall-clock cost of one physics step

 private:
  struct Impl;
  explicit Plant(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pirouette
