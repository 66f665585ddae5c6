// Parameters of the whole-body control.
#pragma once

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Parameters `wbc.*`.
struct WbcConfig {
  double orientation_kp = 100.0;
  double orientation_kd = 10.0;
  double position_kp_xy = 30.0;
  double position_kd_xy = 8.0;
  double position_kp_z = 100.0;
  double position_kd_z = 10.0;
  double swing_kp = 200.0;
  double swing_kd = 15.0;
  double weight_force = 1.0;
  double weight_acceleration = 0.1;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.orientation_kp, "orientation_kp", "1/s^2", Range{0.0, 1e4},
      "Trunk orientation, stiffness.");
    v(s.orientation_kd, "orientation_kd", "1/s", Range{0.0, 1e3}, "Trunk orientation, damping.");
    v(s.position_kp_xy, "position_kp_xy", "1/s^2", Range{0.0, 1e4}, "CoM x and y, stiffness.");
    v(s.position_kd_xy, "position_kd_xy", "1/s", Range{0.0, 1e3}, "CoM x and y, damping.");
    v(s.position_kp_z, "position_kp_z", "1/s^2", Range{0.0, 1e4}, "CoM z, stiffness.");
    v(s.position_kd_z, "position_kd_z", "1/s", Range{0.0, 1e3}, "CoM z, damping.");
    v(s.swing_kp, "swing_kp", "1/s^2", Range{0.0, 1e4}, "Swing foot, stiffness.");
    v(s.swing_kd, "swing_kd", "1/s", Range{0.0, 1e3}, "Swing foot, damping.");
    v(s.weight_force, "weight_force", "1/N^2", Range{1e-6, 1e6},
      "Weight of the change of the MPC's forces.");
    v(s.weight_acceleration, "weight_acceleration", "s^4/m^2", Range{1e-6, 1e6},
      "Weight of the change of the trunk's commanded acceleration.");
  }
};

}  // namespace pirouette
