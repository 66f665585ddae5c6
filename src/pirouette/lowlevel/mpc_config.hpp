// Parameters of the convex MPC.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Parameters `mpc.*`.
struct MpcConfig {
  int horizon = 16;
  double solve_period = 0.024;
  double step_share = 0.0625;
  std::array<double, 3> weight_rpy = {3.0, 3.0, 10.0};
  std::array<double, 3> weight_position = {2.0, 2.0, 50.0};
  std::array<double, 3> weight_angular_velocity = {0.05, 0.05, 0.3};
  std::array<double, 3> weight_velocity = {0.2, 0.2, 0.1};
  double weight_force = 1e-5;
  double friction = 0.6;
  double max_normal_force = 150.0;
  double min_normal_force = 0.0;
  int max_iterations = 100;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.horizon, "horizon", "steps", Range{2, 24}, "Prediction horizon.");
    v(s.solve_period, "solve_period", "s", Range{0.0, 0.2},
      "Time between two solutions, to the nearest control tick; at least one.");
    v(s.step_share, "step_share", "1", Range{0.01, 0.5},
      "Length of a prediction step as a share of the gait period.");
    v(s.weight_rpy, "weight_rpy", "1/rad^2", Range{0.0, 1e6}, "Weight of roll, pitch, yaw.");
    v(s.weight_position, "weight_position", "1/m^2", Range{0.0, 1e6},
      "Weight of the CoM position.");
    v(s.weight_angular_velocity, "weight_angular_velocity", "s^2/rad^2", Range{0.0, 1e6},
      "Weight of the angular velocity.");
    v(s.weight_velocity, "weight_velocity", "s^2/m^2", Range{0.0, 1e6},
      "Weight of the CoM velocity.");
    v(s.weight_force, "weight_force", "1/N^2", Range{1e-9, 1.0}, "Weight of the forces.");
    v(s.friction, "friction", "1", Range{0.05, 2.0},
      "Friction coefficient assumed by MPC and WBC.");
    v(s.max_normal_force, "max_normal_force", "N", Range{1.0, 1e5},
      "Limit of a foot's normal force.");
    v(s.min_normal_force, "min_normal_force", "N", Range{0.0, 100.0},
      "Least normal force of a foot in contact.");
    v(s.max_iterations, "max_iterations", "1", Range{1, 10000},
      "Iteration cap of the active-set solver, MPC and WBC.");
  }
};

}  // namespace pirouette
