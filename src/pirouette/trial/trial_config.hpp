// Parameters of one trial.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Parameters `run.*`.
struct TrialConfig {
  double rate = 0.7;
  std::array<double, 2> velocity = {0.0, 0.0};
  std::string path;
  double path_speed = 0.0;
  double laps = 2.0;
  double turns = 8.0;
  double angle_deg = 0.0;
  double time_limit = 0.0;
  double settle_time = 5.0;
  std::int64_t seed = 1;
  bool fixed_point = false;
  std::array<double, 2> point = {0.0, 0.0};
  std::array<double, 2> start_offset = {0.0, 0.0};
  double start_yaw_deg = 0.0;
  double trace_rate = 100.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.rate, "rate", "rad/s", Range{-10.0, 10.0}, "Commanded yaw rate; positive turns left.");
    v(s.velocity, "velocity", "m/s, m/s", Range{-2.0, 2.0},
      "Commanded velocity, forwards and to the left; zero spins on the spot.");
    v(s.path, "path",
      "Path to follow instead of run.velocity and run.rate: a name under experiments/paths/ or a "
      "file ending in .toml; "
      "empty: none.");
    v(s.path_speed, "path_speed", "m/s", Range{0.0, 2.0},
      "Speed along run.path; 0: as its file says.");
    v(s.laps, "laps", "1", Range{0.01, 1e5},
      "Laps of a closed run.path to record after settling, up to 1e6 s in all.");
    v(s.turns, "turns", "1", Range{0.01, 1e5},
      "Turns to record after settling, up to 1e6 s in all; 10 s each without a yaw rate.");
    v(s.angle_deg, "angle_deg", "deg", Range{-36000.0, 36000.0},
      "Turn by this angle at run.rate, positive to the left, and stand; 0: turn on for run.turns.");
    v(s.time_limit, "time_limit", "s", Range{0.0, 1e6},
      "Longest recorded time, whether turns, laps or angle are done by then or not; 0: 10 s more "
      "than "
      "1.5 times what they need at the commanded speed.");
    v(s.settle_time, "settle_time", "s", Range{0.0, 600.0},
      "Time from the command to the first recorded sample.");
    v(s.seed, "seed", "1", Range{0, 9e15}, "Seed of noise, biases and terrain.");
    v(s.fixed_point, "fixed_point",
      "The commanded point is run.point and the heading 0, also when a start offset or yaw is "
      "given; "
      "false: where the CoM stands when the gait starts.");
    v(s.point, "point", "m, m", Range{-10.0, 10.0}, "The commanded point in the world.");
    v(s.start_offset, "start_offset", "m, m", Range{-10.0, 10.0},
      "Where the robot starts in the world; other than 0, 0 it is to go to run.point.");
    v(s.start_yaw_deg, "start_yaw_deg", "deg", Range{-180.0, 180.0},
      "Yaw at which the robot starts; other than 0 it is to turn to heading 0 first.");
    v(s.trace_rate, "trace_rate", "Hz", Range{1.0, 2000.0}, "Rows of trace.npy per second.");
  }
};

}  // namespace pirouette
