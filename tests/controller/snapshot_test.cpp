// A controller that is restored from a snapshot goes on as the one it was taken of, bit for bit.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <vector>

#include "support/closed_loop.hpp"

namespace pirouette {
namespace {

using test::ClosedLoop;
using test::make_controller;
using test::spin;
using test::stand_still;

using Bytes = std::vector<std::byte>;

template <class T>
void append(std::vector<double>& row, const T& value) {
  if constexpr (std::is_arithmetic_v<T>) {
    row.push_back(static_cast<double>(value));
  } else if constexpr (requires { value.values; }) {
    for (const auto& of_leg : value) append(row, of_leg);
  } else {
    row.insert(row.end(), value.data(), value.data() + value.size());
  }
}

/// Every column of the trace.
std::vector<double> columns(const TickTrace& trace) {
  std::vector<double> row;
  TickTrace::columns(
      trace, [&](const char*, const char*, const char*, const auto& value) { append(row, value); });
  return row;
}

/// Bit for bit, so that NaN equals itself.
bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

struct Scenario {
  const char* name;
  std::function<void(Config&)> configure;
  std::function<std::optional<Path>()> path = [] { return std::nullopt; };
  std::function<MotionCommand(int)> command;  ///< of tick
  std::function<void(int, ClosedLoop&, SensorReading&)> disturb = [](int, ClosedLoop&,
                                                                     SensorReading&) {};
  int snapshot_at;  ///< tick
  /// The snapshot is worth taking: what the scenario is for is in it.
  std::function<bool(const TickTrace&)> reached = [](const TickTrace&) { return true; };
};

std::ostream& operator<<(std::ostream& out, const Scenario& scenario) {
  return out << scenario.name;
}

MotionCommand walk_then_stop(int tick) {
  return tick < 300 || tick > 6000 ? stand_still() : spin(0.7);
}

/// Along a path at 0.2 m/s.
MotionCommand along(int tick) {
  MotionCommand command = spin(0.0);
  command.walk = tick > 300;
  command.v_H.x() = 0.2;
  command.hold_heading = tick > 3000;
  return command;
}

std::optional<Path> wavy_path() {
  const std::vector<Vec2> points = {{0, 0}, {0.3, 0.2}, {0.7, -0.1}, {1.0, 0.3}, {1.3, 0.0}};
  return Path::spline(points, false);
}

const std::array<Scenario, 11> kScenarios = {{
    {.name = "BeforeItsFirstReading",
     .configure = [](Config&) {},
     .command = walk_then_stop,
     .snapshot_at = 0},
    {.name = "AtRest", .configure = [](Config&) {}, .command = walk_then_stop, .snapshot_at = 200},
    {.name = "WithFootholdsOnStairs",
     .configure = [](Config& c) { c.plant.terrain = "stairs:0.05x0.20"; },
     .command = walk_then_stop,
     .snapshot_at = 5000,
     .reached = [](const TickTrace& t) { return t.remembered_treads >= 2 && t.ground.stepped; }},
    {.name = "OnASlopeWithTiltBias",
     .configure =
         [](Config& c) {
           c.plant.terrain = "slope:12";
           c.creep.mode = CreepModelMode::kOnline;
         },
     .command = walk_then_stop,
     .snapshot_at = 5000,
     .reached =
         [](const TickTrace& t) {
           return t.tilt_bias_H.norm() > 0.0 && t.creep.torsional_friction > 0.0;
         }},
    {.name = "RecoveringFromAPush",
     .configure = [](Config&) {},
     .command = walk_then_stop,
     .disturb =
         [](int tick, ClosedLoop& loop, SensorReading&) {
           if (tick == 1500) loop.plant.push(Vec3(0.0, 0.8, 0.0));
         },
     .snapshot_at = 1530,
     .reached =
         [](const TickTrace& t) {
           return t.gait.stance_duration + t.gait.swing_duration < Config{}.gait.period - 0.01;
         }},
    {.name = "WithAPositionAid",
     .configure =
         [](Config& c) {
           c.aid.enabled = true;
           c.plant.sensors.aid_rate = 10.0;
           c.plant.sensors.aid_delay = 0.05;
         },
     .command = walk_then_stop,
     .snapshot_at = 1500,
     .reached = [](const TickTrace& t) { return t.aid_offset.norm() > 0.0; }},
    {.name = "OnACircle",
     .configure = [](Config&) {},
     .path = [] { return Path::circle(Vec2::Zero(), 0.0, 0.5); },
     .command = along,
     .snapshot_at = 1500,
     .reached = [](const TickTrace& t) { return t.path.arc_length > 0.2; }},
    {.name = "OnASpline",
     .configure = [](Config&) {},
     .path = wavy_path,
     .command = along,
     .snapshot_at = 1500,
     .reached = [](const TickTrace& t) { return t.path.arc_length > 0.2; }},
    {.name = "WithAStuckEncoder",
     .configure = [](Config&) {},
     .command = walk_then_stop,
     .disturb =
         [](int tick, ClosedLoop&, SensorReading& sensors) {
           if (tick >= 1200) sensors.joint_position[Leg::kFL] = Vec3(0.0, 0.8, -1.6);
         },
     .snapshot_at = 1320,
     .reached = [](const TickTrace& t) { return t.encoder_stuck[Leg::kFL]; }},
    {.name = "BetweenBadReadings",
     .configure = [](Config&) {},
     .command = walk_then_stop,
     .disturb =
         [](int tick, ClosedLoop&, SensorReading& sensors) {
           if (tick >= 1198 && tick < 1203) sensors.w_WB_B.x() = std::nan("");
           if (tick > 1220 && tick < 1223) sensors.w_WB_B.x() = 90.0;  // a spike
           // Chatter of one flag.
           if (tick > 1190 && tick < 1300) (*sensors.foot_contact)[Leg::kRR] = tick % 3 > 0;
         },
     .snapshot_at = 1200},
    {.name = "StoodDown",
     .configure = [](Config&) {},
     .command = walk_then_stop,
     .disturb =
         [](int tick, ClosedLoop& loop, SensorReading&) {
           if (tick == 1000) loop.plant.push(Vec3(0.0, 6.0, 1.5));
         },
     .snapshot_at = 2500,
     .reached = [](const TickTrace& t) { return t.status == ControllerStatus::kFallen; }},
}};

class Snapshot : public testing::TestWithParam<Scenario> {};

INSTANTIATE_TEST_SUITE_P(Taken, Snapshot, testing::ValuesIn(kScenarios),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(Snapshot, IsGoneOnFromBitForBit) {
  const Scenario& scenario = GetParam();
  Config config;
  scenario.configure(config);
  ClosedLoop loop(config);
  loop.controller.follow(scenario.path());
  SpinController restored = make_controller(config);
  // What it holds before must not matter.
  for (int i = 0; i < 100; ++i) restored.tick(loop.plant.sense(), spin(-0.4));

  const auto reading = [&](int tick) {
    SensorReading sensors = loop.plant.sense();
    scenario.disturb(tick, loop, sensors);
    return sensors;
  };
  int tick = 0;
  for (; tick < scenario.snapshot_at; ++tick) {
    loop.tick(reading(tick), scenario.command(tick));
  }
  ASSERT_TRUE(scenario.reached(loop.controller.trace()));
  ASSERT_TRUE(restored.restore(loop.controller.snapshot()));
  EXPECT_TRUE(same_bits(columns(restored.trace()), columns(loop.controller.trace())));

  const int end = scenario.snapshot_at + 2500;  // 5 s: ten strides, and the rest of a recovery
  for (; tick < end; ++tick) {
    const SensorReading sensors = reading(tick);
    const MotionCommand command = scenario.command(tick);
    restored.tick(sensors, command);
    loop.tick(sensors, command);
    ASSERT_TRUE(same_bits(columns(restored.trace()), columns(loop.controller.trace()))) << tick;
  }
  EXPECT_EQ(restored.snapshot(), loop.controller.snapshot());
}

TEST(SnapshotOfAController, IsRefusedWhenDamagedAndThenChangesNothing) {
  ClosedLoop loop(Config{});
  loop.run(0.5, stand_still());
  loop.run(1.0, spin(0.7));
  const Bytes good = loop.controller.snapshot();
  SpinController controller = make_controller(Config{});
  const Bytes before = controller.snapshot();

  EXPECT_FALSE(controller.restore({}));
  for (const std::size_t size : {std::size_t{1}, good.size() / 2, good.size() - 1}) {
    EXPECT_FALSE(controller.restore(std::span(good).first(size)));
  }
  Bytes longer = good;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(controller.restore(longer));
  for (std::size_t at = 0; at < good.size(); at += 97) {
    Bytes flipped = good;
    flipped[at] ^= std::byte{4};
    EXPECT_FALSE(controller.restore(flipped)) << at;
  }
  EXPECT_EQ(controller.snapshot(), before);
  EXPECT_TRUE(controller.restore(good));
  EXPECT_EQ(controller.snapshot(), good);
}

}  // namespace
}  // namespace pirouette
