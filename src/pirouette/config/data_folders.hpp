// Where the files are that a Config refers to by name: robots, bundles, profiles.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"

namespace pirouette {

struct Config;

/// The folder that holds config/, experiments/ and robots/: the environment's PIROUETTE_DATA_DIR;
/// share/pirouette in the prefix of the program or shared library; of a program in the build tree
/// the source tree; as installed; the source tree: the first that exists.
std::filesystem::path data_dir();

/// Path of the robot's MJCF: robots/<robot>/<robot>.xml of the data folder, or config.robot itself
/// when that ends in .xml.
Result<std::string> resolve_robot(const Config& config);

/// Names under robots/, config/controllers/ and config/plants/ of the data folder, sorted.
std::vector<std::string> known_robots();
std::vector<std::string> known_controllers();
std::vector<std::string> known_profiles();

/// Names of the TOML files in `folder` without their extension, sorted.
std::vector<std::string> toml_stems(const std::filesystem::path& folder);

}  // namespace pirouette
