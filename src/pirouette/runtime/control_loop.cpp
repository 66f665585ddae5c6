#include "pirouette/runtime/control_loop.hpp"

#include <utility>

#include "pirouette/base/stopwatch.hpp"

namespace pirouette {

std::optional<TickView> ControlLoop::tick(const MotionCommand& motion) {
  const PlantTruth* truth = world_.truth();
  std::optional<SensorReading> reading = world_.sense();
  if (!reading) return std::nullopt;
  sensors_ = std::move(*reading);
  motion_ = motion;
  const Stopwatch watch;
  command_ = &controller_.tick(sensors_, motion_);
  const double tick_us = watch.microseconds();
  return TickView{ticks_++, sensors_, motion_, *command_, truth, tick_us};
}

LoopEnd run(World& world, Controller& controller, MotionSource& motion,
            std::span<Observer* const> observers, Pacer* pacer) {
  ControlLoop loop(world, controller);
  while (true) {
    if (pacer != nullptr) pacer->wait(loop.ticks());
    const std::optional<MotionCommand> command = motion.next(loop.ticks(), world.truth());
    if (!command) return LoopEnd::kMotion;
    const std::optional<TickView> view = loop.tick(*command);
    if (!view) return LoopEnd::kWorld;
    for (Observer* observer : observers) {
      if (!observer->watch(*view)) return LoopEnd::kObserver;
    }
    loop.send();
  }
}

}  // namespace pirouette
