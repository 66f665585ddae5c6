// Ten minutes without a stop: place and memory. `make soak`, not part of `make test`.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <numbers>

#include "support/closed_loop.hpp"

namespace pirouette {
namespace {

/// Bytes of this process in memory, on Linux.
double resident_bytes() {
  double all_pages = 0.0, resident_pages = 0.0;
  std::ifstream("/proc/self/statm") >> all_pages >> resident_pages;
  return resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

TEST(LongSpin, SixtySevenTurnsStayWithinTheBoundsOfEightAndMemoryDoesNotGrow) {
  constexpr double kRate = 0.7;  // rad/s
  constexpr double kTurn = 2.0 * std::numbers::pi / kRate;
  const Config config;  // noise and biases on
  test::ClosedLoop loop(config);
  // The commanded point is where the CoM stands when the gait starts, as in the metrics.
  loop.run(config.gait.stand_time, test::spin(kRate));
  const Vec2 point = loop.plant.truth().p_WG.head<2>();
  loop.run(kTurn, test::spin(kRate));
  const double memory = resident_bytes();

  double sum = 0.0, largest = 0.0;
  const int ticks = static_cast<int>(66.0 * kTurn / test::kTick);
  for (int i = 0; i < ticks; ++i) {
    loop.tick(test::spin(kRate));
    const double distance = (loop.plant.truth().p_WG.head<2>() - point).norm();
    sum += distance;
    largest = std::max(largest, distance);
  }
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kWalking);
  EXPECT_LE(sum / ticks, 1.0e-3);
  EXPECT_LE(largest, 4.0e-3);
  ASSERT_GT(memory, 0.0);
  EXPECT_LE(resident_bytes() - memory, 100e3);
  std::printf("distance to the point: mean %.2f mm, largest %.2f mm; memory grew by %.0f bytes\n",
              1e3 * sum / ticks, 1e3 * largest, resident_bytes() - memory);
}

}  // namespace
}  // namespace pirouette
