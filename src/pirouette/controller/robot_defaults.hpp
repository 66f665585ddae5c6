// Default parameters of the controller for a robot of any size.
#pragma once

#include <optional>
#include <string_view>

#include "pirouette/base/unit_law.hpp"
#include "pirouette/controller/controller_config.hpp"
#include "pirouette/model/robot_model.hpp"

namespace pirouette {

/// The law of the parameter `key` of a ControllerConfig with `unit` (one of a list's); absent: its
/// default is the same for every robot.
std::optional<UnitLaw> controller_law(std::string_view key, std::string_view unit);

/// Turns `config`, written for the Mini Cheetah, into that of `robot`: every parameter with a
/// dimension follows its unit in length, mass and time, but for what belongs to sensors and clock;
/// body.height leaves the legs as bent as the Mini Cheetah's.
void fit_to_robot(ControllerConfig& config, RobotModel& robot);

/// The defaults for `robot`.
ControllerConfig default_config(RobotModel& robot);

}  // namespace pirouette
