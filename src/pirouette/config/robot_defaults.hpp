// Default parameters for a robot of any size.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "pirouette/base/result.hpp"
#include "pirouette/base/unit_law.hpp"

namespace pirouette {

struct Config;

/// The law of the parameter `key` with `unit` (one of a list's); absent: its default is the same
/// for every robot.
std::optional<UnitLaw> parameter_law(std::string_view key, std::string_view unit);

/// `terrain` (plant.terrain) with its percentages as lengths (m): shares of `height` (m), to four
/// digits. "stairs:11%x74%" -> "stairs:0.0297x0.1998".
std::string terrain_in_metres(const std::string& terrain, double height);

/// Turns `config`, written for the Mini Cheetah, into that of the robot that it names. The errors
/// are those of the robot's file.
Errors fit_to_robot(Config& config);

}  // namespace pirouette
