// Parameters of the path reference, the tracker and the position aid.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Values of path.reference.
enum class PathReferenceMode { kVelocity, kIntegrated, kAnchored };
template <>
struct EnumNames<PathReferenceMode> {
  static constexpr std::array<std::string_view, 3> kNames = {"velocity", "integrated", "anchored"};
};

/// Values of path.tracker.
enum class PathTracker { kNone, kLqr, kLqi };
template <>
struct EnumNames<PathTracker> {
  static constexpr std::array<std::string_view, 3> kNames = {"none", "lqr", "lqi"};
};

/// Parameters `path.*`.
struct PathConfig {
  PathReferenceMode reference = PathReferenceMode::kAnchored;
  PathTracker tracker = PathTracker::kLqi;
  std::array<double, 3> state_weight = {4.0, 4.0, 4.0};
  std::array<double, 3> input_weight = {1.0, 1.0, 1.0};
  double integral_gain = 2.0;
  double integral_limit = 0.08;
  double max_velocity_correction = 0.15;
  double max_yaw_rate_correction = 0.5;
  double max_correction_rate = 1.0;
  double max_position_lead = 0.03;
  double max_integrated_lead = 0.10;
  double max_yaw_lead = 0.5;
  double max_path_lead = 0.1;
  double max_acceleration = 0.5;
  double max_yaw_acceleration = 1.5;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.reference, "reference",
      "velocity: follow the twist only; integrated: the set-point integrates the command near the "
      "robot "
      "(MIT); anchored: a point or path fixed in the world.");
    v(s.tracker, "tracker", "none; lqr: E21-E23; lqi: with an integrator in the body frame.");
    v(s.state_weight, "state_weight", "1/m^2, 1/m^2, 1/rad^2", Range{0.0, 1e6},
      "LQR weight Q of the errors x, y, yaw.");
    v(s.input_weight, "input_weight", "s^2/m^2, s^2/m^2, s^2/rad^2", Range{1e-6, 1e6},
      "LQR weight R of the corrections vx, vy, yaw rate.");
    v(s.integral_gain, "integral_gain", "1/s^2", Range{0.0, 100.0},
      "Gain of the body-frame integrator of the position error.");
    v(s.integral_limit, "integral_limit", "m/s", Range{0.0, 1.0},
      "Limit of the integrator's velocity (anti-windup).");
    v(s.max_velocity_correction, "max_velocity_correction", "m/s", Range{0.0, 2.0},
      "Limit of the tracker's velocity correction.");
    v(s.max_yaw_rate_correction, "max_yaw_rate_correction", "rad/s", Range{0.0, 5.0},
      "Limit of the tracker's yaw-rate correction.");
    v(s.max_correction_rate, "max_correction_rate", "m/s^2", Range{0.01, 100.0},
      "Rate limit of the velocity correction.");
    v(s.max_position_lead, "max_position_lead", "m", Range{0.001, 1.0},
      "Anchored: the MPC's position reference stays this close to the CoM.");
    v(s.max_integrated_lead, "max_integrated_lead", "m", Range{0.001, 1.0},
      "Integrated: the set-point stays this close to the CoM.");
    v(s.max_yaw_lead, "max_yaw_lead", "rad", Range{0.01, 3.0},
      "The yaw reference stays this close to the yaw (wind-up limit).");
    v(s.max_path_lead, "max_path_lead", "m", Range{0.005, 10.0},
      "On a path from a file the reference waits for the robot when this far ahead of it.");
    v(s.max_acceleration, "max_acceleration", "m/s^2", Range{0.01, 20.0},
      "Ramp of the commanded velocity.");
    v(s.max_yaw_acceleration, "max_yaw_acceleration", "rad/s^2", Range{0.01, 50.0},
      "Ramp of the commanded yaw rate.");
  }
};

/// Parameters `aid.*`.
struct AidConfig {
  bool enabled = true;
  double time_constant = 4.0;
  double ramp_time = 5.0;
  double timeout = 2.0;
  double max_offset = 0.5;

  /// Poses that are remembered; a measurement may be as old as the oldest of them.
  static constexpr std::size_t kHistory = 512;
  static constexpr double kMinSpacing = 0.0019;  ///< s, from one of them to the next

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.enabled, "enabled", "Use position measurements from outside where there are any.");
    v(s.time_constant, "time_constant", "s", Range{0.1, 100.0},
      "Low-pass filter of the odometry's offset from the aid.");
    v(s.ramp_time, "ramp_time", "s", Range{0.0, 100.0},
      "After its first measurement the aid gains influence over this time.");
    v(s.timeout, "timeout", "s", Range{0.01, 100.0},
      "After a longer gap the aid is ramped in again.");
    v(s.max_offset, "max_offset", "m", Range{0.0, 10.0},
      "A measurement further from the odometry than this beyond the offset is an outlier.");
  }
};

}  // namespace pirouette
