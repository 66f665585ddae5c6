// Wall-clock time since a moment.
#pragma once

#include <chrono>

namespace pirouette {

/// Runs from its construction on.
class Stopwatch {
 public:
  double seconds() const { return since<std::ratio<1>>(); }
  double microseconds() const { return since<std::micro>(); }

 private:
  using Clock = std::chrono::steady_clock;

  template <class Unit>
  double since() const {
    return std::chrono::duration<double, Unit>(Clock::now() - start_).count();
  }

  Clock::time_point start_ = Clock::now();
};

}  // namespace pirouette
