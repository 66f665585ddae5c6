// Wall-clock time.
#pragma once

#include <chrono>

namespace pirouette {

/// Time since its construction.
class Stopwatch {
 public:
  double seconds() const { return since<std::ratio<1>>(); }    ///< s
  double microseconds() const { return since<std::micro>(); }  ///< us

 private:
  using Clock = std::chrono::steady_clock;

  template <class Unit>
  double since() const {
    return std::chrono::duration<double, Unit>(Clock::now() - start_).count();
  }

  Clock::time_point start_ = Clock::now();
};

}  // namespace pirouette
