// Interface between the control loop and a world.
#pragma once

#include <optional>

#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// A simulator, a robot, or a recording of one of them.
class World {
 public:
  virtual ~World() = default;

  /// s, from one reading to the next; nominal on a robot.
  virtual double period() const = 0;

  /// The next reading; on a robot the call waits for it. Absent: the world has ended.
  virtual std::optional<SensorReading> sense() = 0;

  /// Applies the joint command that answers the last reading; a simulator advances by one period.
  virtual void send(const JointCommand& command) = 0;

  /// True state at the moment of the next reading; nullptr if the world does not know it.
  virtual const PlantTruth* truth() const { return nullptr; }

 protected:
  World() = default;
  World(const World&) = default;
  World(World&&) noexcept = default;
  World& operator=(const World&) = default;
  World& operator=(World&&) noexcept = default;
};

}  // namespace pirouette
