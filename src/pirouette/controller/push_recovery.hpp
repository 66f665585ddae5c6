// Detection of pushes.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/gait/gait_config.hpp"

namespace pirouette {

/// Recovery begins when the CoM's velocity error exceeds gait.recovery_speed and ends when it has
/// not done so for gait.recovery_time. Early steps during it keep the displacement small.
class PushRecovery {
 public:
  explicit PushRecovery(const GaitConfig& config) : config_(config) {}  ///< not recovering

  /// True while recovering. `v_error` (m/s) is the CoM's horizontal velocity minus its reference;
  /// `dt` in s.
  bool update(const Vec2& v_error, double dt) noexcept {
    const bool pushed = v_error.norm() > config_.recovery_speed;
    time_left_ = pushed ? config_.recovery_time : std::max(0.0, time_left_ - dt);
    return time_left_ > 0.0;
  }

  void reset() noexcept { time_left_ = 0.0; }  ///< not recovering

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
