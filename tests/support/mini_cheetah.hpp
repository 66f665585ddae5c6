// A simulated Mini Cheetah for tests.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "pirouette/study/configured_trial.hpp"

namespace pirouette::test {

inline const std::string kRobot = PIROUETTE_SOURCE_DIR "/robots/mini_cheetah/mini_cheetah.xml";
inline constexpr double kTick = 0.002;  ///< s

/// Perfect sensors, one control tick every kTick.
inline Config ideal_config(const std::string& terrain = "flat") {
  Config config;
  config.control.rate = 1.0 / kTick;
  config.plant.terrain = terrain;
  config.plant.sensors.ideal = true;
  return config;
}

/// `xy` (m) and `yaw` (rad): where the robot starts.
inline Result<Plant> create_plant(const Config& config, const std::string& mjcf = kRobot,
                                  const Vec2& xy = Vec2::Zero(), double yaw = 0.0) {
  PlantSetup setup = plant_setup(config, RobotDescription(mjcf));
  setup.start = xy;
  setup.start_yaw = yaw;
  return Plant::create(config.plant, setup);
}

inline Plant make_plant(const Config& config, const Vec2& xy = Vec2::Zero(), double yaw = 0.0) {
  Result<Plant> plant = create_plant(config, kRobot, xy, yaw);
  if (!plant) throw std::runtime_error(plant.errors().front().to_string());
  return std::move(plant).value();
}

/// Holds the joints where they are, stiffly.
inline JointCommand hold(const PlantTruth& truth) {
  JointCommand command;
  for (const Leg leg : kLegs) {
    command[leg].q = truth.joint_position[leg];
    command[leg].kp.setConstant(150.0);
    command[leg].kd.setConstant(2.0);
  }
  return command;
}

inline void stand(Plant& plant, double duration) {
  const JointCommand command = hold(plant.truth());
  const int ticks = static_cast<int>(std::lround(duration / kTick));
  for (int i = 0; i < ticks; ++i) plant.advance(command);
}

}  // namespace pirouette::test
