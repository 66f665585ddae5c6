// Tells when the robot has been pushed.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/gait/gait_config.hpp"

namespace pirouette {

/// A robot that moves much faster than it should must step soon: the shorter the time to the next
/// foothold, the less way the push makes. Recovering begins when the CoM's velocity is off by
/// gait.recovery_speed, and ends when that has not been so for gait.recovery_time.
class PushRecovery {
 public:
  explicit PushRecovery(const GaitConfig& config) : config_(config) {}

  /// True while recovering. `v_error` (m/s): the CoM's horizontal velocity less its reference.
  bool update(const Vec2& v_error, double dt) noexcept {
    const bool pushed = v_error.norm() > config_.recovery_speed;
    time_left_ = pushed ? config_.recovery_time : std::max(0.0, time_left_ - dt);
    return time_left_ > 0.0;
  }

  void reset() noexcept { time_left_ = 0.0; }

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, time_left] = self;
    visit(time_left);
  }

 private:
  GaitConfig config_;
  double time_left_ = 0.0;  ///< s
};

}  // namespace pirouette
