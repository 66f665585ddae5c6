// A Plant as a World of the control loop.
#pragma once

#include "pirouette/plant/plant.hpp"
#include "pirouette/runtime/world.hpp"

namespace pirouette {

/// World that never ends. `plant` must outlive it.
class SimulatedWorld final : public World {
 public:
  explicit SimulatedWorld(Plant& plant) : plant_(plant) {}  ///< at the present state of `plant`

  double period() const override { return plant_.period(); }
  std::optional<SensorReading> sense() override { return plant_.sense(); }
  void send(const JointCommand& command) override { plant_.advance(command); }
  const PlantTruth* truth() const override { return &plant_.truth(); }

 private:
  Plant& plant_;
};

}  // namespace pirouette
