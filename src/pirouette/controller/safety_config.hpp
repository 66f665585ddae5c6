// Limits at which the controller stands down.
#pragma once

#include <array>
#include <string_view>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Which parts of the self-check run: StandingCheck.
enum class SelfCheckMode { kNone, kStill, kTurn };
template <>
struct EnumNames<SelfCheckMode> {
  static constexpr std::array<std::string_view, 3> kNames = {"none", "still", "turn"};
};

/// Parameters `safety.*`.
struct SafetyConfig {
  SelfCheckMode self_check = SelfCheckMode::kTurn;
  double max_tilt = 0.8;
  double min_height_share = 0.4;
  double max_bad_reading_time = 0.02;
  int max_solver_failures = 10;
  double max_hold_time = 0.02;
  double max_gyro_step = 3.0;
  double max_accelerometer_step = 80.0;
  double max_repeat_time = 0.1;
  double max_blind_travel = 0.05;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.self_check, "self_check",
      "Before the first step, for 0.9 s of standing: still: clock, joint angles, accelerometer and "
      "the "
      "torque that holds the robot are checked; turn: and the trunk turns by 0.02 rad about each "
      "axis, "
      "which gyro and legs have to agree about; none: nothing is checked.");
    v(s.max_tilt, "max_tilt", "rad", Range{0.1, 3.2},
      "The robot counts as fallen when the trunk's axis leaves the ground normal by more.");
    v(s.min_height_share, "min_height_share", "1", Range{0.0, 1.0},
      "The robot counts as fallen when the CoM is lower than this share of body.height.");
    v(s.max_bad_reading_time, "max_bad_reading_time", "s", Range{0.0, 20.0},
      "Non-finite sensor values or commands are bridged by the last good ones for this long, then "
      "the controller stands down.");
    v(s.max_solver_failures, "max_solver_failures", "1", Range{0, 10000},
      "The MPC's last good forces are held over this many failed solutions in a row, then the "
      "controller stands down.");
    v(s.max_hold_time, "max_hold_time", "s", Range{0.0, 20.0},
      "The last joint command is held for this long while the whole-body control finds no "
      "solution, then the controller stands down.");
    v(s.max_gyro_step, "max_gyro_step", "rad/s", Range{0.01, 1e6},
      "An IMU sample whose gyro differs from the last good one by more is a spike: the last good "
      "one is used instead, for up to max_bad_reading_time.");
    v(s.max_accelerometer_step, "max_accelerometer_step", "m/s^2", Range{0.1, 1e6},
      "The same for its accelerometer.");
    v(s.max_repeat_time, "max_repeat_time", "s", Range{0.0, 200.0},
      "A gyro or an accelerometer that repeats its sample to the last bit while walking is dead "
      "after this time, and "
      "the controller stands down.");
    v(s.max_blind_travel, "max_blind_travel", "rad", Range{0.001, 100.0},
      "An encoder that repeats its angle to the last bit over this much commanded travel is stuck: "
      "its leg is not used as odometry. With two such legs the controller stands down.");
  }
};

}  // namespace pirouette
