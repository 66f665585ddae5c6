#include "pirouette/runtime/control_loop.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace pirouette {
namespace {

/// Writes down who was called, in one list for all.
using Calls = std::vector<std::string>;

class ShortWorld final : public World {
 public:
  ShortWorld(Calls& calls, int readings) : calls_(calls), readings_(readings) {}
  double period() const override { return 0.01; }
  std::optional<SensorReading> sense() override {
    calls_.push_back("sense");
    if (readings_-- == 0) return std::nullopt;
    SensorReading reading;
    reading.time = ++senses_ * period();
    return reading;
  }
  void send(const JointCommand& command) override {
    calls_.push_back("send");
    sent.push_back(command[Leg::kFR].tau.x());
  }

  std::vector<double> sent;

 private:
  Calls& calls_;
  int readings_;
  int senses_ = 0;
};

/// Answers with the reading's time.
class Echo final : public Controller {
 public:
  explicit Echo(Calls& calls) : calls_(calls) {}
  void reset(const BasePose&) override {}
  const JointCommand& tick(const SensorReading& sensors, const MotionCommand&) noexcept override {
    calls_.push_back("tick");
    command_[Leg::kFR].tau.x() = sensors.time;
    return command_;
  }
  ControllerStatus status() const noexcept override { return ControllerStatus::kWalking; }

 private:
  Calls& calls_;
  JointCommand command_;
};

class Told final : public MotionSource {
 public:
  Told(Calls& calls, std::int64_t ticks) : calls_(calls), ticks_(ticks) {}
  std::optional<MotionCommand> next(std::int64_t tick, const PlantTruth*) override {
    calls_.push_back("motion");
    if (tick == ticks_) return std::nullopt;
    return MotionCommand{};
  }

 private:
  Calls& calls_;
  std::int64_t ticks_;
};

class Watcher final : public Observer {
 public:
  Watcher(Calls& calls, std::int64_t last) : calls_(calls), last_(last) {}
  bool watch(const TickView& view) override {
    calls_.push_back("watch");
    EXPECT_EQ(view.command[Leg::kFR].tau.x(), view.sensors.time);
    EXPECT_EQ(view.truth, nullptr);
    return view.tick != last_;
  }

 private:
  Calls& calls_;
  std::int64_t last_;
};

class Clock final : public Pacer {
 public:
  explicit Clock(Calls& calls) : calls_(calls) {}
  void wait(std::int64_t tick) override {
    calls_.push_back("wait");
    ticks.push_back(tick);
  }
  std::vector<std::int64_t> ticks;

 private:
  Calls& calls_;
};

constexpr std::int64_t kNever = -1;

TEST(ControlLoop, GoesThroughATickInItsOrder) {
  Calls calls;
  ShortWorld world(calls, 100);
  Echo controller(calls);
  Told motion(calls, 1);
  Watcher first(calls, kNever), second(calls, kNever);
  Clock clock(calls);
  Observer* const observers[] = {&first, &second};
  EXPECT_EQ(run(world, controller, motion, observers, &clock), LoopEnd::kMotion);
  EXPECT_EQ(calls,
            (Calls{"wait", "motion", "sense", "tick", "watch", "watch", "send", "wait", "motion"}));
  EXPECT_EQ(clock.ticks, (std::vector<std::int64_t>{0, 1}));
}

TEST(ControlLoop, SendsWhatTheControllerAnsweredToEachReading) {
  Calls calls;
  ShortWorld world(calls, 100);
  Echo controller(calls);
  Told motion(calls, 3);
  run(world, controller, motion, {});
  EXPECT_EQ(world.sent, (std::vector<double>{0.01, 0.02, 0.03}));
}

TEST(ControlLoop, EndsWithTheWorldBeforeTheController) {
  Calls calls;
  ShortWorld world(calls, 1);
  Echo controller(calls);
  Told motion(calls, kNever);
  EXPECT_EQ(run(world, controller, motion, {}), LoopEnd::kWorld);
  EXPECT_EQ(calls, (Calls{"motion", "sense", "tick", "send", "motion", "sense"}));
}

TEST(ControlLoop, EndsWhenAnObserverAsksForItBeforeTheCommandIsSent) {
  Calls calls;
  ShortWorld world(calls, 100);
  Echo controller(calls);
  Told motion(calls, kNever);
  Watcher watcher(calls, 1);
  Observer* const observers[] = {&watcher};
  EXPECT_EQ(run(world, controller, motion, observers), LoopEnd::kObserver);
  EXPECT_EQ(world.sent.size(), 1U);
}

}  // namespace
}  // namespace pirouette
