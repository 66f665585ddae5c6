// Parameters of the attitude filter, the leg-odometry Kalman filter and the creep model.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Values of creep.mode.
enum class CreepModelMode { kOff, kStored, kOnline };
template <>
struct EnumNames<CreepModelMode> {
  static constexpr std::array<std::string_view, 3> kNames = {"off", "stored", "online"};
};

/// Values of estimation.source.
enum class EstimatorSource { kKalman, kTruth };
template <>
struct EnumNames<EstimatorSource> {
  static constexpr std::array<std::string_view, 2> kNames = {"kalman", "truth"};
};

/// Parameters `estimation.*`.
struct EstimationConfig {
  EstimatorSource source = EstimatorSource::kKalman;
  double process_position = 1e-9;
  double process_velocity = 1e-5;
  double process_foot = 1e-8;
  double measurement_position = 4e-8;
  double measurement_velocity = 1e-3;
  double measurement_height = 1e-6;
  double swing_noise_factor = 100.0;
  double trust_window = 0.02;
  double velocity_jump = 0.1;
  double attitude_time_constant = 4.0;
  double gyro_bias_time_constant = 60.0;
  double gyro_rest_time = 1.2;
  double gyro_bias_prior = 2e-4;
  double tilt_bias_time = 20.0;
  double contact_debounce_time = 0.006;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.source, "source", "kalman: sensors only; truth: the simulator's state, for studies.");
    v(s.process_position, "process_position", "m^2/s", Range{1e-12, 100.0},
      "Process noise of the position.");
    v(s.process_velocity, "process_velocity", "(m/s)^2/s", Range{1e-12, 100.0},
      "Process noise of the velocity.");
    v(s.process_foot, "process_foot", "m^2/s", Range{1e-12, 100.0},
      "Process noise of a foot on the ground.");
    v(s.measurement_position, "measurement_position", "m^2", Range{1e-12, 100.0},
      "Variance of a foot's measured position relative to the body, of readings at 500 Hz: it "
      "grows "
      "with control.rate.");
    v(s.measurement_velocity, "measurement_velocity", "(m/s)^2", Range{1e-12, 100.0},
      "Variance of the body velocity that a foot reports, at 500 Hz.");
    v(s.measurement_height, "measurement_height", "m^2", Range{1e-12, 100.0},
      "Variance of a foot's height above the terrain estimate, at 500 Hz.");
    v(s.swing_noise_factor, "swing_noise_factor", "1", Range{1.0, 1e6},
      "Added noise of a foot whose trust is only beginning or ending, as a multiple.");
    v(s.trust_window, "trust_window", "1", Range{0.0, 0.5},
      "Share of the stance at each end over which a foot's trust ramps.");
    v(s.velocity_jump, "velocity_jump", "m/s", Range{0.01, 100.0},
      "When all fully trusted feet agree that the velocity is off by more, it was a push: the "
      "filter "
      "follows them at once.");
    v(s.attitude_time_constant, "attitude_time_constant", "s", Range{0.1, 1000.0},
      "Time constant with which gravity corrects roll and pitch.");
    v(s.gyro_bias_time_constant, "gyro_bias_time_constant", "s", Range{1.0, 1e5},
      "Time constant of the gyro-bias estimate while walking.");
    v(s.gyro_rest_time, "gyro_rest_time", "s", Range{0.0, 2000.0},
      "Time at rest that the prior of no gyro bias is worth: density of the noise over variance "
      "of the bias.");
    v(s.gyro_bias_prior, "gyro_bias_prior", "rad/s", Range{0.0, 10.0},
      "Deviation of that prior. A first rest whose bias is many of it, and of the noise, from none "
      "is believed without the prior.");
    v(s.tilt_bias_time, "tilt_bias_time", "s", Range{0.0, 1000.0},
      "Memory of the tilt error that turns with the trunk, seen against the terrain plane; 0: "
      "off.");
    v(s.contact_debounce_time, "contact_debounce_time", "s", Range{0.0, 0.2},
      "A contact flag counts when it has been the same for this long, to the nearest control "
      "tick; at least one.");
  }
};

/// Parameters `creep.*`.
struct CreepConfig {
  CreepModelMode mode = CreepModelMode::kOnline;
  double calibrated_friction = 0.75;
  double calibrated_torsion = 0.004;
  double patch_ratio = 0.0;
  double averaging_time = 6.0;
  double max_torsional_friction = 0.03;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.mode, "mode",
      "Slip of twisting feet down a slope. off: none; stored: creep.calibrated_friction and "
      "creep.calibrated_torsion hold; online: torsional friction from the stance forces.");
    v(s.calibrated_friction, "calibrated_friction", "1", Range{0.05, 2.0},
      "Sliding friction of the feet, calibrated.");
    v(s.calibrated_torsion, "calibrated_torsion", "m", Range{0.0, 0.1},
      "Torsional friction of the feet: stored value, and prior of the online estimate.");
    v(s.patch_ratio, "patch_ratio", "m", Range{0.0, 0.1},
      "Torsional over sliding friction, calibrated; with the online estimate it replaces "
      "creep.calibrated_friction. 0: not known.");
    v(s.averaging_time, "averaging_time", "s", Range{0.1, 600.0},
      "Time constant of the online estimate.");
    v(s.max_torsional_friction, "max_torsional_friction", "m", Range{0.0, 0.2},
      "Bound of the online estimate.");
  }
};

}  // namespace pirouette
