// Parameters of the simulated sensors: noise and biases.
#pragma once

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Parameters `plant.sensors.*`.
struct SensorConfig {
  bool ideal = false;
  double encoder_noise = 5e-4;
  double joint_velocity_noise = 0.025;
  double accelerometer_noise = 0.05;
  double accelerometer_bias = 0.02;
  double gyro_noise = 0.005;
  double gyro_bias = 2e-4;
  bool contact_flags = true;
  double contact_threshold = 3.0;
  double contact_delay = 0.0;
  double contact_error = 0.0;
  bool foot_forces = false;
  double foot_force_scale = 1.0;
  double foot_force_offset = 0.0;
  double foot_force_noise = 0.0;
  double aid_rate = 0.0;
  double aid_noise = 0.005;
  double aid_yaw_noise = 0.01;
  double aid_delay = 0.0;
  double aid_dropout = 0.0;
  double aid_lost_after = 0.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.ideal, "ideal", "No noise, no bias and no wrong contact flag.");
    v(s.encoder_noise, "encoder_noise", "rad", Range{0.0, 1.0}, "Joint angle, white, per sample.");
    v(s.joint_velocity_noise, "joint_velocity_noise", "rad/s", Range{0.0, 10.0},
      "Joint velocity, white, per sample.");
    v(s.accelerometer_noise, "accelerometer_noise", "m/s^2", Range{0.0, 100.0},
      "Accelerometer, white, per axis and sample at 500 Hz; its density is the same at any "
      "control.rate.");
    v(s.accelerometer_bias, "accelerometer_bias", "m/s^2", Range{0.0, 10.0},
      "Accelerometer bias: standard deviation of the draw per seed and axis.");
    v(s.gyro_noise, "gyro_noise", "rad/s", Range{0.0, 10.0},
      "Gyro, white, per axis and sample at 500 Hz; its density is the same at any control.rate.");
    v(s.gyro_bias, "gyro_bias", "rad/s", Range{0.0, 1.0},
      "Gyro bias: standard deviation of the draw per seed and axis.");
    v(s.contact_flags, "contact_flags", "The feet report contact.");
    v(s.contact_threshold, "contact_threshold", "N", Range{0.0, 1e3},
      "Normal force above which a foot reports contact.");
    v(s.contact_delay, "contact_delay", "s", Range{0.0, 0.5}, "Age of the contact flags.");
    v(s.contact_error, "contact_error", "1", Range{0.0, 1.0},
      "Probability that a contact flag is wrong, per sample and foot.");
    v(s.foot_forces, "foot_forces",
      "The feet report their load as a raw number, from which the controller makes its own contact "
      "flags.");
    v(s.foot_force_scale, "foot_force_scale", "1/N", Range{0.0, 1e3},
      "Of that number, per normal force; each foot's is drawn per seed from half to one and a half "
      "of it.");
    v(s.foot_force_offset, "foot_force_offset", "1", Range{-1e4, 1e4},
      "Of that number: what a foot in the air reads.");
    v(s.foot_force_noise, "foot_force_noise", "1", Range{0.0, 1e4},
      "Of that number, white, per sample and foot.");
    v(s.aid_rate, "aid_rate", "Hz", Range{0.0, 2000.0},
      "Poses of the trunk measured from outside (motion capture) or by camera; 0: none.");
    v(s.aid_noise, "aid_noise", "m", Range{0.0, 1.0}, "Its position, white, per sample and axis.");
    v(s.aid_yaw_noise, "aid_yaw_noise", "rad", Range{0.0, 1.0}, "Its yaw, white, per sample.");
    v(s.aid_delay, "aid_delay", "s", Range{0.0, 5.0}, "From its measurement to its arrival.");
    v(s.aid_dropout, "aid_dropout", "1", Range{0.0, 1.0},
      "Probability that one of its samples does not arrive.");
    v(s.aid_lost_after, "aid_lost_after", "s", Range{0.0, 1e6},
      "No sample is measured after this time; 0: no limit.");
  }
};

}  // namespace pirouette
