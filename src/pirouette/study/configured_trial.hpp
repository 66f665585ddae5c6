// A trial described by a Config.
#pragma once

#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/trial/trial.hpp"

namespace pirouette {

/// The PlantSetup of `config` with `robot`.
PlantSetup plant_setup(const Config& config, const RobotDescription& robot);

/// The trial of `config`, with its robot and path files found and the path read.
Result<TrialSetup> set_up(const Config& config);

/// The errors of check_trial() that are found in microseconds, before the robot's file is read: of
/// the terrain, the path, and what the plant says of its settings.
Errors check_settings(const Config& config);

/// What the robot's file leaves out and what stands in for it, a sentence each.
std::vector<std::string> robot_assumptions(const Config& config);

/// Errors with which run_trial() would not start: the robot's file, its leg names, the terrain, the
/// path, a length of more than 10^6 s. Empty: none.
Errors check_trial(const Config& config);

/// run_trial() of set_up(config). The same config gives the same rows bit for bit.
Result<TrialResult> run_trial(const Config& config, const TrialOptions& options = {});

}  // namespace pirouette
