#include "simulation.hpp"

#include <cmath>
#include <utility>

#include "pirouette/config/data_folders.hpp"
#include "pirouette/study/configured_trial.hpp"

namespace pirouette {
namespace {

Result<Plant> create_plant(const Config& config, const RobotDescription& robot) {
  return Plant::create(config.plant, plant_setup(config, robot));
}

}  // namespace

Result<Simulation> Simulation::create(const Config& config) {
  const Result<RobotDescription> description = resolve_robot(config);
  if (!description) return description.errors();
  Result<SpinController> controller = SpinController::create(config, description.value());
  if (!controller) return controller.errors();
  Result<Plant> plant = create_plant(config, description.value());
  if (!plant) return plant.errors();
  // The plant has read the same text.
  const Terrain terrain(parse_terrain(config.plant.terrain).value(),
                        static_cast<std::uint64_t>(config.run.seed));
  return Simulation(
      config, description.value(), terrain,
      std::make_unique<Robot>(std::move(plant).value(), std::move(controller).value()));
}

Simulation::Simulation(Config config, RobotDescription description, Terrain terrain,
                       std::unique_ptr<Robot> robot)
    : config_(std::move(config)),
      description_(std::move(description)),
      terrain_(std::move(terrain)),
      robot_(std::move(robot)),
      standing_ticks_(std::llround(config_.gait.stand_time * config_.control.rate)) {
  command.walk = true;
  command.v_H = Vec2(config_.run.velocity[0], config_.run.velocity[1]);
  command.yaw_rate = config_.run.rate;
  begin();
}

Errors Simulation::reset() {
  Result<Plant> plant = create_plant(config_, description_);
  if (!plant) return plant.errors();
  robot_ = std::make_unique<Robot>(std::move(plant).value(), std::move(robot_->controller));
  begin();
  return {};
}

void Simulation::begin() {
  const BaseTruth& start = robot_->plant.truth().base;
  robot_->controller.reset({start.p_WB, start.R_WB});
  yaw_.reset(rpy_from_rotation(start.R_WB).yaw);
  tick();
}

void Simulation::step(std::int64_t ticks) {
  for (; ticks > 0; --ticks) {
    robot_->loop.send();
    tick();
  }
}

void Simulation::tick() {
  yaw_.update(rpy_from_rotation(robot_->plant.truth().base.R_WB).yaw);
  ControlLoop& loop = robot_->loop;
  loop.tick(loop.ticks() < standing_ticks_ ? MotionCommand{} : command);
}

}  // namespace pirouette
