#include "pirouette/study/configured_trial.hpp"

#include <array>
#include <cstdint>
#include <filesystem>

#include "pirouette/base/version.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/path_file.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/trial/run_folder.hpp"

namespace pirouette {
namespace {

/// The commanded point is run.point in the world, not where the robot happens to stand.
bool has_fixed_point(const TrialConfig& run) {
  return run.fixed_point || run.start_offset != std::array{0.0, 0.0} || run.start_yaw_deg != 0.0;
}

/// Sets motion and path of `setup`.
Errors load_motion(const TrialConfig& run, TrialSetup& setup) {
  MotionCommand& command = setup.motion;
  command.walk = true;
  if (has_fixed_point(run)) {
    command.point = Vec2(run.point[0], run.point[1]);
    command.heading = 0.0;
  }
  if (run.path.empty()) {
    command.v_H = Vec2(run.velocity[0], run.velocity[1]);
    command.yaw_rate = run.rate;
    if (run.angle_deg * run.rate < 0.0) {  // the angle says which way
      command.v_H = -command.v_H;
      command.yaw_rate = -run.rate;
    }
    return {};
  }
  const Result<std::filesystem::path> name = resolve_path(run);
  if (!name) return name.errors();
  const Result<PathFile> file = load_path_file(name.value());
  if (!file) return file.errors();
  const double speed = run.path_speed > 0.0 ? run.path_speed : file.value().speed;
  command.v_H = rot2(file.value().travel_direction) * Vec2(speed, 0.0);
  command.hold_heading = file.value().hold_heading;
  setup.path = file.value().curve;
  return {};
}

RunContext describe_run(const Config& config, const MotionCommand& motion) {
  RunContext c;
  c.path = config.run.path;
  c.robot = config.robot;
  c.terrain = config.plant.terrain;
  c.controller = config.controller;
  c.profile = config.profile;
  c.estimator = enum_name(config.estimation.source);
  c.reference = enum_name(config.path.reference);
  c.tracker = enum_name(config.path.tracker);
  c.foot_model = enum_name(config.foot.model);
  c.com_planner = enum_name(config.com.planner);
  c.duty = config.gait.duty;
  c.period = config.gait.period_at(motion.yaw_rate);
  c.torsional_friction = config.plant.torsional_friction;
  c.friction = config.plant.friction;
  c.seed = config.run.seed;
  c.mujoco = physics_version();
  c.commit = commit();
  c.version = version();
  c.sensors = config.plant.sensors.ideal ? "ideal" : "noisy";
  c.yaw_rate = motion.yaw_rate;
  c.velocity_x = motion.v_H.x();
  c.velocity_y = motion.v_H.y();
  c.terrain_half_extent_m = kTerrainHalfExtent;
  c.terrain_pitch_m = kTerrainPitch;
  return c;
}

}  // namespace

PlantSetup plant_setup(const Config& config, const RobotDescription& robot) {
  PlantSetup setup;
  setup.robot = robot;
  setup.seed = static_cast<std::uint64_t>(config.run.seed);
  setup.period = 1.0 / config.control.rate;
  setup.com_height = config.body.height;
  setup.start = Vec2(config.run.start_offset[0], config.run.start_offset[1]);
  setup.start_yaw = radians(config.run.start_yaw_deg);
  setup.shows_truth = config.estimation.source == EstimatorSource::kTruth;
  return setup;
}

Result<TrialSetup> set_up(const Config& config) {
  const Result<RobotDescription> robot = resolve_robot(config);
  if (!robot) return robot.errors();
  TrialSetup setup;
  if (Errors errors = load_motion(config.run, setup); !errors.empty()) return errors;
  setup.controller = config;
  setup.world = config.plant;
  setup.plant = plant_setup(config, robot.value());
  setup.trial = config.run;
  setup.context = describe_run(config, setup.motion);
  return setup;
}

Errors check_settings(const Config& config) {
  TrialSetup setup;
  Errors errors = load_motion(config.run, setup);
  const Errors of_plant = Plant::check(config.plant, plant_setup(config, ""));
  errors.insert(errors.end(), of_plant.begin(), of_plant.end());
  return errors;
}

std::vector<std::string> robot_assumptions(const Config& config) {
  const Result<RobotDescription> robot = resolve_robot(config);
  if (!robot) return {};
  const Result<RobotModel> model = RobotModel::load(robot.value());
  if (!model) return {};
  std::vector<std::string> texts = model.value().notes();
  for (std::string& text : texts)
    text = std::filesystem::path(robot.value().file).filename().string() + ": " + text;
  return texts;
}

Errors check_trial(const Config& config) {
  const Result<TrialSetup> setup = set_up(config);
  return setup ? check_trial(setup.value()) : setup.errors();
}

Result<TrialResult> run_trial(const Config& config, const TrialOptions& options) {
  const Result<TrialSetup> setup = set_up(config);
  if (!setup) return setup.errors();
  return run_trial(setup.value(), options);
}

}  // namespace pirouette
