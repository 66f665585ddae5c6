// Which gait the robot walks now: stride and duty by rule, and the clock that runs them.
#pragma once

#include <optional>

#include "pirouette/controller/push_recovery.hpp"
#include "pirouette/gait/gait_clock.hpp"
#include "pirouette/gait/gait_config.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/motion_command.hpp"

namespace pirouette {

/// `last_...`: of the tick before.
struct GaitTimingInput {
  const MotionCommand& command;
  const Vec3& v_WG_W;                        ///< m/s
  const Vec3& last_reference_v_WG_W;         ///< m/s
  std::optional<double> last_path_yaw_rate;  ///< rad/s; absent: the command's counts
  bool last_walking = false;
  bool last_stepped = false;  ///< the ground has steps
};

struct GaitTimingOutput {
  GaitPhase gait;
  bool recovering = false;  ///< from a push
};

/// The yaw rate shortens the stride, steps lengthen the stance; both take effect at the next
/// touchdown. A push shortens the stride at once.
class GaitTiming {
 public:
  explicit GaitTiming(const GaitConfig& config)
      : config_(config), push_recovery_(config), clock_(config) {}

  GaitTimingOutput update(const GaitTimingInput& in, double dt) noexcept;
  void reset() noexcept;

  const GaitClock& clock() const { return clock_; }

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, push_recovery, clock] = self;
    visit(push_recovery, clock);
  }

 private:
  GaitConfig config_;
  PushRecovery push_recovery_;
  GaitClock clock_;
};

}  // namespace pirouette
