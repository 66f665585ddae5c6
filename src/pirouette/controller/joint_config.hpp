// Joint-level gains and limits.
#pragma once

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Parameters `joint.*`.
struct JointConfig {
  double kp_stance = 10.0;
  double kd_stance = 1.0;
  double kp_swing = 30.0;
  double kd_swing = 1.0;
  double kd_stand = 2.0;
  double filter_time = 0.0005;
  double friction_compensation = 1.0;
  double max_torque_rate = 20000.0;
  double max_position_rate = 60.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.kp_stance, "kp_stance", "N m/rad", Range{0.0, 1e3}, "Joint stiffness of a stance leg.");
    v(s.kd_stance, "kd_stance", "N m s/rad", Range{0.0, 100.0}, "Joint damping of a stance leg.");
    v(s.kp_swing, "kp_swing", "N m/rad", Range{0.0, 1e3}, "Joint stiffness of a swing leg.");
    v(s.kd_swing, "kd_swing", "N m s/rad", Range{0.0, 100.0}, "Joint damping of a swing leg.");
    v(s.kd_stand, "kd_stand", "N m s/rad", Range{0.0, 100.0},
      "Joint damping in the stand-down, the safe state.");
    v(s.filter_time, "filter_time", "s", Range{0.0, 0.1},
      "Time constant of the low-pass filter of the feed-forward torque; 0: none.");
    v(s.friction_compensation, "friction_compensation", "1", Range{0.0, 1.0},
      "Share of the robot file's joint friction and damping that the feed-forward torque "
      "overcomes.");
    v(s.max_torque_rate, "max_torque_rate", "N m/s", Range{1.0, 1e7},
      "Rate limit of the feed-forward torque.");
    v(s.max_position_rate, "max_position_rate", "rad/s", Range{0.1, 1e4},
      "Rate limit of the commanded joint angle.");
  }
};

}  // namespace pirouette
