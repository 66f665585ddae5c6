// Keeps a loop to the wall clock, as a robot's control loop is.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pirouette/runtime/control_loop.hpp"

namespace pirouette::app {

/// Asks for what a loop in real time wants: the calling thread under SCHED_FIFO, the process's
/// memory locked. Returns what was refused, each with the system's reason.
std::vector<std::string> request_real_time();

/// Tick n is due n periods after the first one, whatever happened before. One thread.
class RealTimePacer final : public Pacer {
 public:
  explicit RealTimePacer(double period) : period_(period) {}  ///< s

  /// Returns when tick `tick` is due; at once when that time has passed, which is a missed
  /// deadline.
  void wait(std::int64_t tick) override;

  std::int64_t ticks() const { return ticks_; }
  std::int64_t missed() const { return missed_; }
  double worst_miss() const { return worst_miss_; }          ///< s, of a tick after its deadline
  double latest_wake_up() const { return latest_wake_up_; }  ///< s, of the system after its time

  /// Two lines for people; `refused` as from request_real_time().
  std::string summary(const std::vector<std::string>& refused) const;

 private:
  double period_;
  double start_ = 0.0;  ///< s, CLOCK_MONOTONIC
  std::int64_t ticks_ = 0;
  std::int64_t missed_ = 0;
  double worst_miss_ = 0.0;
  double latest_wake_up_ = 0.0;
};

}  // namespace pirouette::app
