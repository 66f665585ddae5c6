#include "pirouette/config/validate.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "pirouette/config/config.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/path_file.hpp"

namespace pirouette {

Errors validate(const Config& config) {
  Errors errors;
  const auto require = [&](bool good, const char* key, const auto&... text) {
    if (good) return;
    std::ostringstream message;
    (message << ... << text);
    errors.push_back({"", 0, key, message.str()});
  };

  if (const auto robot = resolve_robot(config); !robot) errors = robot.errors();

  if (!config.run.path.empty()) {
    const Result<std::filesystem::path> path = resolve_path(config.run);
    if (!path) errors.insert(errors.end(), path.errors().begin(), path.errors().end());
  }

  constexpr double kRounding = 1e-9;  // of a ratio of two decimal fractions
  const double control_period = 1.0 / config.control.rate;
  const double steps = control_period / config.plant.timestep;
  require(steps > 1.0 - kRounding && std::abs(steps - std::round(steps)) < kRounding * steps,
          "plant.timestep", "given ", config.plant.timestep,
          " s; allowed: a whole fraction of the control period, 1/control.rate = ", control_period,
          " s");

  require(config.run.trace_rate <= config.control.rate, "run.trace_rate", "given ",
          config.run.trace_rate, " Hz; allowed: up to control.rate = ", config.control.rate, " Hz");

  require(config.run.angle_deg == 0.0 || (config.run.rate != 0.0 && config.run.path.empty()),
          "run.angle_deg", "given ", config.run.angle_deg,
          " deg; allowed: with a run.rate other than 0 and without run.path");

  constexpr double kMinSwingTime = GaitConfig::kMinSwingTime;
  const double swing_time = config.gait.period * (1.0 - config.gait.duty);
  require(swing_time > kMinSwingTime - kRounding, "gait.duty", "given ", config.gait.duty,
          " with gait.period = ", config.gait.period, " s: a swing of ", swing_time,
          " s; allowed: swings of ", kMinSwingTime, " s and longer");

  require(config.mpc.min_normal_force < config.mpc.max_normal_force, "mpc.min_normal_force",
          "given ", config.mpc.min_normal_force,
          " N; allowed: less than mpc.max_normal_force = ", config.mpc.max_normal_force, " N");

  require(config.terrain.step_residual_release <= config.terrain.step_residual,
          "terrain.step_residual_release", "given ", config.terrain.step_residual_release,
          " m; allowed: up to terrain.step_residual = ", config.terrain.step_residual, " m");

  const SensorConfig& sensors = config.plant.sensors;
  const double remembered = static_cast<double>(AidConfig::kHistory - 1) *
                            std::max(control_period, AidConfig::kMinSpacing);
  require(sensors.aid_rate == 0.0 || sensors.aid_delay <= remembered, "plant.sensors.aid_delay",
          "given ", sensors.aid_delay, " s; allowed: up to ", remembered,
          " s, as long as the controller remembers");

  const double horizon = config.mpc.horizon * config.mpc.step_share * config.gait.period;
  require(config.mpc.solve_period <= horizon, "mpc.solve_period", "given ", config.mpc.solve_period,
          " s; allowed: within the horizon of ", horizon,
          " s, mpc.horizon times mpc.step_share times gait.period");
  return errors;
}

}  // namespace pirouette
