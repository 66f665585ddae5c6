// Files that a Config refers to by name: robots, bundles, profiles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_description.hpp"

namespace pirouette {

struct Config;

/// The folder that holds config/, experiments/ and robots/. The first of these that exists:
/// PIROUETTE_DATA_DIR of the environment; share/pirouette in the prefix of the program or shared
/// library; for a program in the build tree the source tree; the place of installation; the source
/// tree.
std::filesystem::path data_dir();

/// The robot of `config.robot`: robots/<robot>/robot.toml of the data folder, else
/// robots/<robot>/<robot>.xml, or the file itself (is_robot_file). An error for a robot that does
/// not exist lists the known ones.
Result<RobotDescription> resolve_robot(const Config& config);

/// Names under robots/ of the data folder, sorted.
std::vector<std::string> known_robots();
std::vector<std::string> known_controllers();  ///< under config/controllers/, sorted
std::vector<std::string> known_profiles();     ///< under config/plants/, sorted

/// Names of the TOML files in `folder` without their extension, sorted.
std::vector<std::string> toml_stems(const std::filesystem::path& folder);

}  // namespace pirouette
