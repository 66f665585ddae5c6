// The loop between a world and a controller. There is no other one in this tree.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pirouette/controller/controller.hpp"
#include "pirouette/runtime/world.hpp"

namespace pirouette {

/// One tick: what was read, asked and answered. It refers to the loop's own values, which last
/// until the next tick.
struct TickView {
  std::int64_t tick = 0;  ///< from 0
  const SensorReading& sensors;
  const MotionCommand& motion;
  const JointCommand& command;
  const PlantTruth* truth;  ///< at the moment of the reading; nullptr where nobody knows it
  double tick_us = 0.0;     ///< wall-clock cost of the controller's tick
};

/// Tells the robot what to do.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  /// The command of tick `tick`; `truth` is the world's before it. Absent: the run is over.
  virtual std::optional<MotionCommand> next(std::int64_t tick, const PlantTruth* truth) = 0;
};

/// Watches a run, after each tick and before its command is sent.
class Observer {
 public:
  virtual ~Observer() = default;
  /// False ends the run.
  virtual bool watch(const TickView& view) = 0;
};

/// Keeps the loop to a clock.
class Pacer {
 public:
  virtual ~Pacer() = default;
  /// Returns when tick `tick` is due.
  virtual void wait(std::int64_t tick) = 0;
};

/// The two halves of a tick, for programs that stop between them. World and controller must outlive
/// it.
class ControlLoop {
 public:
  ControlLoop(World& world, Controller& controller) : world_(world), controller_(controller) {}

  /// Reads, and lets the controller answer. Absent: the world has ended.
  std::optional<TickView> tick(const MotionCommand& motion);
  /// Sends the answer of the last tick().
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

/// Runs `controller` in `world` until one of them, `motion` or an observer ends it. Each tick waits
/// for `pacer`, where there is one; asks `motion`; reads; ticks the controller; shows the tick to
/// `observers` in their order; sends.
LoopEnd run(World& world, Controller& controller, MotionSource& motion,
            std::span<Observer* const> observers, Pacer* pacer = nullptr);

}  // namespace pirouette
