// All parameters of a run, as a TOML file holds them.
#pragma once

#include <string>

#include "pirouette/controller/controller_config.hpp"
#include "pirouette/plant/world_config.hpp"
#include "pirouette/trial/trial_config.hpp"

namespace pirouette {

/// The parameters of the controller, at the top level of the file, and those of the world and of
/// the trial. A SpinController takes its ControllerConfig, a Plant its WorldConfig.
struct Config : ControllerConfig {
  std::string robot = "mini_cheetah";
  std::string controller = "pirouette";
  std::string profile = "nominal";
  WorldConfig plant;
  TrialConfig run;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.robot, "robot",
      "Name of a folder under robots/, or path of an MJCF, URDF or robot.toml file.");
    v(s.controller, "controller", "Bundle of switches: mit, fkm, asc or pirouette.");
    v(s.profile, "profile", "Hardware and world: nominal or realistic.");
    ControllerConfig::fields(s, v);
    v(s.plant, "plant", "The simulated world, robot hardware and sensors.");
    v(s.run, "run", "One trial.");
  }
};

}  // namespace pirouette
