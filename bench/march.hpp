// The closed loop, timed part by part.
#pragma once

#include <string>
#include <vector>

namespace pirouette::bench {

/// One timed piece of work.
struct Sample {
  double quickest_us = 0.0;  ///< of all repetitions: the work
  double slowest_us = 0.0;   ///< of all repetitions: the work and whatever else the machine did
};

struct MpcSample : Sample {
  bool constrained = false;
  int iterations = 0;
};

struct Scenario {
  std::string name;
  std::string terrain;
  int horizon = 16;
  double push_speed = 0.0;  ///< m/s, change of the trunk's velocity once per second; 0: none
};

/// Times of a march of the default robot that spins at the default rate.
struct March {
  std::vector<Sample> physics_step;   ///< mean over the steps of each control period
  std::vector<Sample> replayed_step;  ///< the same with nothing but the recorded joint commands
  std::vector<Sample> period;         ///< one control period: sensors, tick, physics
  std::vector<Sample> tick;
  std::vector<Sample> wbc;
  std::vector<MpcSample> mpc;
  int steps_per_period = 1;
  double simulated_s = 0.0;
};

/// Marches `scenario` a few times, identically.
March march(const Scenario& scenario);

}  // namespace pirouette::bench
