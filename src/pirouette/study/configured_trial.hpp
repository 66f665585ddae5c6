// A trial as a Config describes it.
#pragma once

#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/trial/trial.hpp"

namespace pirouette {

/// What a Plant takes of `config` besides its world; `mjcf` is the path of the robot's file.
PlantSetup plant_setup(const Config& config, const std::string& mjcf);

/// The trial that `config` describes, its robot found and its path read.
Result<TrialSetup> set_up(const Config& config);

/// What would keep run_trial() from starting: the robot's file, its leg names, the terrain, the
/// path, a length of more than 10^6 s.
Errors check_trial(const Config& config);

/// run_trial() of set_up(config). The same config gives the same rows bit for bit.
Result<TrialResult> run_trial(const Config& config, const TrialOptions& options = {});

}  // namespace pirouette
