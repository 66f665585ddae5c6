// robot.toml, and what stands beside a robot's MJCF or URDF file.
#pragma once

#include <filesystem>
#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_description.hpp"

namespace pirouette {

/// True: the name is that of a robot's file, by its ending .xml, .urdf or .toml.
bool is_robot_file(const std::filesystem::path& path);

/// The robot of a file: of an MJCF; of a URDF, with the first pose of the SRDF file beside it or in
/// ../srdf; or as a robot.toml says. The errors name file, line and key.
Result<RobotDescription> load_robot_file(const std::filesystem::path& path);

/// `robot` as the text of a robot.toml, which load_robot_file reads as the same robot where the
/// text lies beside the robot's file.
std::string robot_toml(const RobotDescription& robot);

}  // namespace pirouette
