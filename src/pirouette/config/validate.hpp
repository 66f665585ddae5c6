// What a Config refers to outside itself, and what ranges of single parameters cannot express.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"

namespace pirouette {

/// Relations between parameters, and the files of robot and path. Part of load_config; call it
/// after changing a Config in code. Empty: all is well.
Errors validate(const Config& config);

/// Path of the robot's MJCF: robots/<robot>/<robot>.xml of the data folder, or config.robot itself
/// when that ends in .xml.
Result<std::string> resolve_robot(const Config& config);

/// Where config/ and robots/ are: the environment's PIROUETTE_DATA_DIR, else the source tree, else
/// the installed share/pirouette.
std::filesystem::path data_dir();

/// Names under robots/, config/controllers/ and config/plants/ of the data folder, sorted.
std::vector<std::string> known_robots();
std::vector<std::string> known_controllers();
std::vector<std::string> known_profiles();

/// Names of the TOML files in `folder` without their extension, sorted.
std::vector<std::string> toml_stems(const std::filesystem::path& folder);

}  // namespace pirouette
