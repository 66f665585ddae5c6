// Stride period and duty factor by rule, and the gait clock that uses them.
#pragma once

#include <optional>

#include "pirouette/controller/push_recovery.hpp"
#include "pirouette/gait/gait_clock.hpp"
#include "pirouette/gait/gait_config.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/motion_command.hpp"

namespace pirouette {

/// Input of GaitTiming::update(). `last_...`: of the tick before.
struct GaitTimingInput {
  const MotionCommand& command;              ///< of this tick
  const Vec3& v_WG_W;                        ///< m/s, estimated velocity of the CoM, world axes
  const Vec3& last_reference_v_WG_W;         ///< m/s, its reference, world axes
  std::optional<double> last_path_yaw_rate;  ///< rad/s; absent: the command's yaw rate is used
  bool last_walking = false;                 ///< the gait ran
  bool last_stepped = false;                 ///< the ground has steps
};

/// Output of GaitTiming::update().
struct GaitTimingOutput {
  GaitPhase gait;           ///< phase of each leg
  bool recovering = false;  ///< from a push
};

/// A high yaw rate shortens the stride and steps raise the duty factor, both from the next
/// touchdown on. A push shortens the stride at once.
class GaitTiming {
 public:
  /// Starts standing.
  explicit GaitTiming(const GaitConfig& config)
      : config_(config), push_recovery_(config), clock_(config) {}

  /// Phases `dt` (s) after the previous call.
  GaitTimingOutput update(const GaitTimingInput& in, double dt) noexcept;
  void reset() noexcept;  ///< standing, no recovery

  const GaitClock& clock() const { return clock_; }  ///< for predictions

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
