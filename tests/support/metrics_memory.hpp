// How much memory the metrics of a long motion take.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "support/synthetic_motion.hpp"

namespace pirouette::test {

/// MB of this process in memory, on Linux.
inline double resident_megabytes() {
  double all_pages = 0.0, resident_pages = 0.0;
  std::ifstream("/proc/self/statm") >> all_pages >> resident_pages;
  return resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

/// MB: the most that the metrics and the tick times of `hours` at `yaw_rate` (rad/s) take.
inline double memory_of_metrics(double yaw_rate, double hours) {
  const Motion few = walking_motion(yaw_rate, 0.1);
  const double before = resident_megabytes();
  double largest = before;
  MotionMetrics metrics({Vec2(0.2, -0.1), Vec2::Zero(), yaw_rate}, kRate);
  TickTimes times;
  const int ticks = static_cast<int>(hours * 3600.0 * kRate);
  for (int i = 0; i < ticks; ++i) {
    MotionSample sample = few[static_cast<std::size_t>(i) % few.size()];
    sample.time = i / kRate;
    sample.yaw = yaw_rate * sample.time;
    sample.p_WG += Vec2(1e-9, 1e-9 * (i % 30011)) * i;  // ever new places
    metrics.add(sample);
    times.add(300.0 + i % 97, i % 5 == 0 ? 100.0 : 0.0, 50.0 + i % 31);
    if (i % 10000 == 0) largest = std::max(largest, resident_megabytes());
  }
  return largest - before;
}

}  // namespace pirouette::test
