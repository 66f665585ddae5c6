// What a loop asks of the world that a robot lives in.
#pragma once

#include <optional>

#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// A simulator, a robot, or a recording of either.
class World {
 public:
  virtual ~World() = default;

  /// s, from one reading to the next; nominal on a robot.
  virtual double period() const = 0;

  /// The next reading: a robot's world waits for it. Absent: the world has ended.
  virtual std::optional<SensorReading> sense() = 0;

  /// Takes the joint command that answers the last reading; a simulator advances by one period.
  virtual void send(const JointCommand& command) = 0;

  /// What is true at the moment of the next reading; nullptr where nobody knows it.
  virtual const PlantTruth* truth() const { return nullptr; }

 protected:
  World() = default;
  World(const World&) = default;
  World(World&&) noexcept = default;
  World& operator=(const World&) = default;
  World& operator=(World&&) noexcept = default;
};

}  // namespace pirouette
