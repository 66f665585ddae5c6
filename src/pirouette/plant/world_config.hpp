// Parameters of the simulated world: terrain, robot hardware, sensors and faults.
#pragma once

#include <array>
#include <string>

#include "pirouette/base/fields.hpp"
#include "pirouette/plant/fault_config.hpp"
#include "pirouette/plant/sensor_config.hpp"

namespace pirouette {

/// Parameters `plant.*`.
struct WorldConfig {
  std::string terrain = "flat";
  double timestep = 0.001;
  double friction = 0.8;
  double torsional_friction = 0.005;
  double rolling_friction = 0.0001;
  double impratio = 10.0;
  double command_latency = 0.0;
  double torque_scale = 1.0;
  double torque_scale_spread = 0.0;
  double joint_friction_scale = 1.0;
  double joint_damping_scale = 1.0;
  double contact_time_constant = 0.005;
  double trunk_mass_scale = 1.0;
  std::array<double, 3> trunk_com_offset = {0.0, 0.0, 0.0};
  double payload = 0.0;
  std::array<double, 3> payload_position = {0.0, 0.0, 0.05};
  SensorConfig sensors;
  FaultConfig faults;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.terrain, "terrain",
      "flat, slope:DEGREES, slope:DEGREES+rough:HEIGHT, stairs:RISExRUN, stairs:RISExRUN@DEGREES, "
      "rough:HEIGHT, blocks:HEIGHT, patch:FRICTIONxSIDE or soft:TIME_CONSTANT; m and s, or lengths "
      "in % of body.height.");
    v(s.timestep, "timestep", "s", Range{1e-4, 5e-3}, "Physics step; divides the control period.");
    v(s.friction, "friction", "1", Range{0.0, 5.0}, "Sliding friction of feet and ground.");
    v(s.torsional_friction, "torsional_friction", "m", Range{0.0, 1.0},
      "Torsional friction of feet and ground.");
    v(s.rolling_friction, "rolling_friction", "m", Range{0.0, 1.0},
      "Rolling friction of feet and ground.");
    v(s.impratio, "impratio", "1", Range{0.1, 1e4},
      "Ratio of frictional to normal impedance of the contacts.");
    v(s.command_latency, "command_latency", "s", Range{0.0, 0.05},
      "Age of the joint command when it reaches the motors.");
    v(s.torque_scale, "torque_scale", "1", Range{0.1, 2.0},
      "Motor torque constant, relative to nominal.");
    v(s.torque_scale_spread, "torque_scale_spread", "1", Range{0.0, 0.5},
      "Each motor's torque constant is drawn per seed within this share of torque_scale, "
      "uniformly.");
    v(s.joint_friction_scale, "joint_friction_scale", "1", Range{0.0, 100.0},
      "Dry friction of the joints, as a multiple of the robot file's.");
    v(s.joint_damping_scale, "joint_damping_scale", "1", Range{0.0, 100.0},
      "Damping of the joints, as a multiple of the robot file's.");
    v(s.contact_time_constant, "contact_time_constant", "s", Range{0.002, 0.5},
      "Time constant of the feet's contact; the sink depth under a load grows with its square.");
    v(s.trunk_mass_scale, "trunk_mass_scale", "1", Range{0.1, 10.0},
      "Mass and inertia of the trunk, as a multiple of what the controller takes from the robot "
      "file.");
    v(s.trunk_com_offset, "trunk_com_offset", "m, m, m", Range{-0.2, 0.2},
      "The trunk's CoM from where the robot file has it, trunk axes.");
    v(s.payload, "payload", "kg", Range{0.0, 100.0},
      "Mass on the trunk, unknown to the controller: a ball of 5 cm radius.");
    v(s.payload_position, "payload_position", "m, m, m", Range{-1.0, 1.0},
      "Its centre, trunk frame.");
    v(s.sensors, "sensors", "Sensor noise; per control sample.");
    v(s.faults, "faults", "Faults and their times.");
  }
};

}  // namespace pirouette
