// What a robot's file holds, for a user to look over before the robot walks.
#pragma once

#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/controller/standing_load.hpp"
#include "pirouette/types/leg_geometry.hpp"
#include "pirouette/types/robot_scale.hpp"

namespace pirouette {

/// Everything that was found, mended and assumed of a robot, and how it stands.
struct RobotCheck {
  RobotDescription description;      ///< complete
  std::vector<std::string> notes;    ///< what was mended, left out or assumed
  std::vector<std::string> remarks;  ///< what would surprise
  Errors problems;                   ///< why it cannot walk
  double mass = 0.0;                 ///< kg
  RobotScale scale;                  ///< of the defaults
  double height = 0.0;               ///< m, body.height
  PerLeg<LegGeometry> legs{};        ///< lengths and limits
  StandingLoad standing;             ///< at `height`
};

/// The robot that `robot` names (Config::robot), with the parameters that it has by default. The
/// errors are those of a file that cannot be read.
Result<RobotCheck> check_robot(const std::string& robot);

/// The text of an MJCF file with the robot that `robot` names as the controller and the plant read
/// it (model/robot_reader.hpp).
Result<std::string> read_robot_mjcf(const std::string& robot);

/// The check as a text with a table of joints.
std::string robot_check_text(const RobotCheck& check);

/// The check as JSON, with points of the standing robot in trunk axes for a picture.
std::string robot_check_json(const RobotCheck& check);

}  // namespace pirouette
