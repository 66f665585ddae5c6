// Period between sensor readings.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace pirouette {

/// Ticks of `period` (s) that are nearest to `time` (s).
inline int ticks_in(double time, double period) {
  return static_cast<int>(std::lround(time / period));
}

/// Measures the period from the readings' own times. A reading that is early, late or stamped
/// wrongly counts as half to ten nominal periods.
class TickClock {
 public:
  /// `nominal_period` in s.
  explicit TickClock(double nominal_period) : nominal_(nominal_period) {}

  /// s, from the reading before to the one at `time` (s); nominal for the first.
  double update(double time) noexcept {
    const double period =
        last_time_ ? std::clamp(time - *last_time_, 0.5 * nominal_, 10.0 * nominal_) : nominal_;
    last_time_ = time;
    return period;
  }

  void reset() noexcept { last_time_.reset(); }  ///< no reading yet

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [nominal, last_time] = self;
    visit(last_time);
  }

 private:
  double nominal_;
  std::optional<double> last_time_;  ///< s
};

}  // namespace pirouette
