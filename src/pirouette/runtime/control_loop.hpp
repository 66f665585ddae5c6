// The loop between a world and a controller; the only one in this tree.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pirouette/controller/controller.hpp"
#include "pirouette/runtime/world.hpp"

namespace pirouette {

/// One tick: sensor reading, motion command, joint command. Refers to values of the loop, valid
/// until the next tick.
struct TickView {
  std::int64_t tick = 0;         ///< from 0
  const SensorReading& sensors;  ///< reading of the tick
  const MotionCommand& motion;   ///< motion command of the tick
  const JointCommand& command;   ///< the controller's answer
  const PlantTruth* truth;  ///< at the moment of the reading; nullptr if the world does not know it
  double tick_us = 0.0;     ///< wall-clock cost of the controller's tick
};

/// Source of the motion commands of a run.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  /// Command of tick `tick`. `truth` is the world's before it, nullptr if the world does not know
  /// it. Absent: the run ends.
  virtual std::optional<MotionCommand> next(std::int64_t tick, const PlantTruth* truth) = 0;
};

/// Observer of a run, called after each tick, before its joint command is sent.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Returns false to end the run.
  virtual bool watch(const TickView& view) = 0;
};

/// Clock of the loop.
class Pacer {
 public:
  virtual ~Pacer() = default;
  /// Returns when tick `tick` is due.
  virtual void wait(std::int64_t tick) = 0;
};

/// A tick in two halves, tick() and send(), for programs that do something in between. World and
/// controller must outlive it.
class ControlLoop {
 public:
  /// At tick 0. The controller must have been reset.
  ControlLoop(World& world, Controller& controller) : world_(world), controller_(controller) {}

  /// Reads the sensors and ticks the controller. Absent: the world has ended.
  std::optional<TickView> tick(const MotionCommand& motion);
  /// Sends the joint command of the last tick().
  void send() { world_.send(*command_); }

  std::int64_t ticks() const { return ticks_; }  ///< done so far

 private:
  World& world_;
  Controller& controller_;
  SensorReading sensors_;
  MotionCommand motion_;
  const JointCommand* command_ = nullptr;  ///< the controller's
  std::int64_t ticks_ = 0;
};

/// Why a run ended.
enum class LoopEnd {
  kMotion,    ///< the motion source had no further command
  kWorld,     ///< the world had no further reading
  kObserver,  ///< an observer asked for it
};

/// Runs `controller` in `world` until one of them, `motion` or an observer ends the run. Each tick
/// waits for `pacer`, if there is one; gets the command from `motion`; reads the sensors; ticks the
/// controller; shows the tick to the `observers` in their order; sends the joint command.
LoopEnd run(World& world, Controller& controller, MotionSource& motion,
            std::span<Observer* const> observers, Pacer* pacer = nullptr);

}  // namespace pirouette
