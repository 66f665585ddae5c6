// Clock of the trot: FR with RL, and FL with RR half a stride later.
#pragma once

#include <algorithm>

#include "pirouette/base/legs.hpp"
#include "pirouette/gait/gait_config.hpp"
#include "pirouette/types/gait_phase.hpp"

namespace pirouette {

/// A leg's stride begins with its touchdown. The gait starts at the touchdown of FR and RL: with
/// duty > 0.5 all four feet are down then. A foot that is scheduled to swing at the start
/// stays down until its first lift-off. When the walk ends, feet in the air land on schedule and no
/// other foot lifts. A foot that stays down reports mid-stance.
class GaitClock {
 public:
  /// Starts standing.
  explicit GaitClock(const GaitConfig& config);

  /// Phase `dt` (s) after the previous call; the first call with `walk` is the start itself.
  GaitPhase update(bool walk, double dt) noexcept;

  void reset() noexcept;  ///< standing

  /// The leg's phase `t_ahead` >= 0 (s) after the last update, if the robot goes on walking,
  /// stopping or standing as now, with the current timing.
  LegPhase phase_at(Leg leg, double t_ahead) const noexcept;

  /// Sets the period (s) from the next start of the stride on and the duty factor in (0, 1) of each
  /// leg from its next touchdown on, so that no swing changes; while standing, both at once.
  void set_timing(double period, double duty) noexcept;

  /// Applies a new period at once if it is shorter than the present one: the progress of every
  /// stance and swing stays, and the rest of it is faster.
  void hurry() noexcept { period_ = std::min(period_, next_period_); }

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [initial_period, initial_duty, period, next_period, next_duty, walking, stopping, cycle,
           legs] = self;
    visit(period, next_period, next_duty, walking, stopping, cycle, legs);
  }

 private:
  struct LegState {
    double duty = 0.5;       ///< of the current stride
    bool scheduled = false;  ///< follows the schedule; false: rests on the ground
    int stride = 0;
  };

  double leg_cycle(Leg leg) const noexcept;
  bool in_stance(Leg leg) const noexcept;
  void start() noexcept;
  void advance(double dt) noexcept;
  void follow_or_rest() noexcept;
  void adopt_timing() noexcept;
  GaitPhase current() const noexcept;

  double initial_period_;
  double initial_duty_;
  double period_ = 0.0;
  double next_period_ = 0.0;
  double next_duty_ = 0.0;
  bool walking_ = false;
  bool stopping_ = false;
  double cycle_ = 0.0;  ///< in [0, 1), of FR and RL
  PerLeg<LegState> legs_;
};

}  // namespace pirouette
