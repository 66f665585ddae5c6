// Parameters of the trot and its footholds.
#pragma once

#include <algorithm>
#include <cmath>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Parameters `gait.*`.
struct GaitConfig {
  double period = 0.5;
  double duty = 0.6;
  double stand_time = 1.0;
  double swing_height = 0.05;
  double early_contact_progress = 0.6;
  double max_turn_per_stride = 1.05;
  double min_period = 0.18;
  bool adapt = true;
  double step_duty = 0.7;
  double step_clearance = 0.05;
  double max_swing_height = 0.16;
  double recovery_speed = 0.15;
  double recovery_period = 0.26;
  double recovery_time = 0.6;

  /// s, least time in which a leg lifts, moves and lands.
  static constexpr double kMinSwingTime = 0.05;

  /// Stride (s) whose swing takes kMinSwingTime.
  double shortest_stride() const { return kMinSwingTime / (1.0 - duty); }

  /// Stride (s) at a commanded yaw rate (rad/s): shorter than `period` where the trunk would turn
  /// by more than max_turn_per_stride.
  double period_at(double yaw_rate) const {
    if (std::abs(yaw_rate) * period <= max_turn_per_stride) return period;
    return std::max({std::min(min_period, period), max_turn_per_stride / std::abs(yaw_rate),
                     shortest_stride()});
  }
  /// Duty factor on stepped ground, with a stride of `stride` (s).
  double step_duty_at(double stride) const {
    return std::max(duty, std::min(step_duty, 1.0 - kMinSwingTime / stride));
  }
  /// Stride (s) after a push, at a commanded yaw rate (rad/s).
  double recovery_period_at(double yaw_rate) const {
    return std::min(period_at(yaw_rate), std::max(recovery_period, shortest_stride()));
  }

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.period, "period", "s", Range{0.15, 2.0}, "Duration of one stride of the trot.");
    v(s.duty, "duty", "1", Range{0.4, 0.9}, "Share of the stride that a foot is on the ground.");
    v(s.stand_time, "stand_time", "s", Range{0.0, 60.0},
      "Standing time before the gait starts; gyro and accelerometer are calibrated in it.");
    v(s.swing_height, "swing_height", "m", Range{0.005, 0.2}, "Apex of the swing above its ends.");
    v(s.early_contact_progress, "early_contact_progress", "1", Range{0.0, 1.0},
      "From this share of the swing on, a measured contact ends the swing early.");
    v(s.max_turn_per_stride, "max_turn_per_stride", "rad", Range{0.1, 10.0},
      "The stride is shortened below gait.period where the commanded yaw rate would turn the trunk "
      "by more.");
    v(s.min_period, "min_period", "s", Range{0.1, 2.0}, "Lower limit of that rule.");
    v(s.adapt, "adapt",
      "Duty and swing height follow the ground that the feet have met, the stride follows pushes.");
    v(s.step_duty, "step_duty", "1", Range{0.4, 0.9}, "Duty on stepped ground, if more than duty.");
    v(s.step_clearance, "step_clearance", "m", Range{0.0, 0.2},
      "On stepped ground the swing's apex is this far above the highest step met.");
    v(s.max_swing_height, "max_swing_height", "m", Range{0.005, 0.3}, "Upper limit of that rule.");
    v(s.recovery_speed, "recovery_speed", "m/s", Range{0.01, 100.0},
      "The robot counts as pushed when the CoM's velocity is off its reference by more. Not on "
      "stepped ground.");
    v(s.recovery_period, "recovery_period", "s", Range{0.1, 2.0},
      "Stride of a robot that was pushed, if shorter than gait.period; at once.");
    v(s.recovery_time, "recovery_time", "s", Range{0.0, 60.0},
      "That stride lasts until the velocity has been within recovery_speed for this long.");
  }
};

/// Parameters `foothold.*`.
struct FootholdConfig {
  bool feedback = true;
  double velocity_gain = 0.03;
  double max_offset = 0.25;
  bool rolling_compensation = true;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.feedback, "feedback", "Correct footholds by the velocity error; false: pure geometry, E1.");
    v(s.velocity_gain, "velocity_gain", "s", Range{0.0, 0.5},
      "Foothold shift per velocity error (Raibert).");
    v(s.max_offset, "max_offset", "m", Range{0.01, 0.4},
      "Largest horizontal distance of a foothold from its nominal point below the hip.");
    v(s.rolling_compensation, "rolling_compensation",
      "With foot.model rolling: aim half the expected contact travel back, so that the mean "
      "contact is nominal.");
  }
};

}  // namespace pirouette
