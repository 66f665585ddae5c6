#include "pirouette/config/data_folders.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "pirouette/config/config.hpp"
#include "pirouette/config/robot_file.hpp"
#include "pirouette/config/suggest.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

/// Sorted names of what `folder` holds, as `name_of` reads them from its entries.
template <class NameOf>
std::vector<std::string> names_in(const fs::path& folder, NameOf&& name_of) {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    if (const std::optional<std::string> name = name_of(entry.path())) names.push_back(*name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Of the shared library or program that holds this code; empty where nobody tells.
fs::path own_file() {
  std::error_code error;
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&data_dir), &info) != 0 &&
      fs::path(info.dli_fname).filename().string().find(".so") != std::string::npos) {
    return fs::canonical(info.dli_fname, error);
  }
  return fs::read_symlink("/proc/self/exe", error);
}

bool is_below(const fs::path& file, const fs::path& folder) {
  const fs::path relative = file.lexically_relative(folder);
  return !relative.empty() && *relative.begin() != "..";
}

bool holds_data(const fs::path& folder) {
  std::error_code none;
  return fs::is_directory(folder / "config", none);
}

}  // namespace

fs::path data_dir() {
  const char* given = std::getenv("PIROUETTE_DATA_DIR");
  if (given != nullptr && *given != '\0') return given;

  const fs::path source = PIROUETTE_SOURCE_DATA_DIR, installed = PIROUETTE_INSTALL_DATA_DIR;
  const fs::path file = own_file();
  // bin/program, lib/library or lib/<architecture>/library.
  fs::path prefix = file.parent_path();
  for (int up = 0; up < 2 && prefix.has_relative_path(); ++up) {
    prefix = prefix.parent_path();
    if (holds_data(prefix / "share" / "pirouette")) return prefix / "share" / "pirouette";
  }
  const bool prefers_source = is_below(file, PIROUETTE_BUILD_DIR) || !holds_data(installed);
  return prefers_source && holds_data(source) ? source : installed;
}

std::vector<std::string> known_robots() {
  return names_in(data_dir() / "robots", [](const fs::path& folder) -> std::optional<std::string> {
    const fs::path name = folder.filename();
    if (!fs::exists(folder / (name.string() + ".xml"))) return std::nullopt;
    return name.string();
  });
}

std::vector<std::string> known_controllers() {
  return toml_stems(data_dir() / "config" / "controllers");
}

std::vector<std::string> known_profiles() { return toml_stems(data_dir() / "config" / "plants"); }

std::vector<std::string> toml_stems(const fs::path& folder) {
  return names_in(folder, [](const fs::path& file) -> std::optional<std::string> {
    if (file.extension() != ".toml") return std::nullopt;
    return file.stem().string();
  });
}

Result<RobotDescription> resolve_robot(const Config& config) {
  const fs::path path = config.robot;
  if (is_robot_file(path)) {
    if (fs::is_regular_file(path)) return load_robot_file(path);
    return Error{"", 0, "robot", "given " + in_quotes(config.robot) + ": no such file"};
  }
  const std::vector<std::string> robots = known_robots();
  if (std::binary_search(robots.begin(), robots.end(), config.robot)) {
    const fs::path folder = data_dir() / "robots" / config.robot;
    if (fs::exists(folder / "robot.toml")) return load_robot_file(folder / "robot.toml");
    return load_robot_file(folder / (config.robot + ".xml"));
  }
  return Error{"", 0, "robot",
               unknown_name(config.robot, robots) +
                   "; or the path of an MJCF (.xml), URDF (.urdf) or robot.toml file"};
}

}  // namespace pirouette
