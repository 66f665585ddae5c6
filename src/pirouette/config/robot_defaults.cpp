#include "pirouette/config/robot_defaults.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <regex>
#include <sstream>

#include "pirouette/base/fit_to_scale.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/controller/robot_defaults.hpp"

namespace pirouette {
namespace {

/// What of the simulated world follows the robot: its feet, and what they feel.
constexpr std::array<std::string_view, 4> kOfTheFeet = {
    "plant.torsional_friction", "plant.rolling_friction", "plant.contact_time_constant",
    "plant.sensors.contact_threshold"};

std::optional<UnitLaw> world_law(std::string_view key, std::string_view unit) {
  if (std::count(kOfTheFeet.begin(), kOfTheFeet.end(), key) == 0) return std::nullopt;
  return unit_law(unit);
}

}  // namespace

std::optional<UnitLaw> parameter_law(std::string_view key, std::string_view unit) {
  const bool is_of_trial = key.rfind("plant.", 0) == 0 || key.rfind("run.", 0) == 0;
  return is_of_trial ? world_law(key, unit) : controller_law(key, unit);
}

std::string terrain_in_metres(const std::string& terrain, double height) {
  static const std::regex kPercentage(R"(([0-9]+\.?[0-9]*)%)");
  std::string text;
  auto rest = terrain.cbegin();
  for (std::sregex_iterator at(terrain.begin(), terrain.end(), kPercentage), end; at != end; ++at) {
    text.append(rest, (*at)[0].first);
    std::ostringstream metres;
    metres << std::setprecision(4) << 0.01 * std::stod((*at)[1].str()) * height;
    text += metres.str();
    rest = (*at)[0].second;
  }
  return text.append(rest, terrain.cend());
}

Errors fit_to_robot(Config& config) {
  const Result<RobotDescription> description = resolve_robot(config);
  if (!description) return description.errors();
  Result<RobotModel> robot = RobotModel::load(description.value());
  if (!robot) return robot.errors();
  fit_to_robot(config, robot.value());
  const RobotScale scale = robot.value().scale();
  WorldConfig::fields(config.plant, FitToScale("plant.", scale.length, scale.mass, world_law));
  return {};
}

}  // namespace pirouette
