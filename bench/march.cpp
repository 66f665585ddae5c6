#include "march.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "pirouette/base/stopwatch.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/runtime/control_loop.hpp"
#include "pirouette/study/configured_trial.hpp"

namespace pirouette::bench {

namespace {

constexpr int kRepetitions = 3;
constexpr int kWarmUpTicks = 1500;
constexpr int kTimedTicks = 20000;
constexpr int kTicksBetweenPushes = 500;
constexpr double kGoldenAngle = 2.39996;  // rad, so that pushes come from all sides

Config make_config(const Scenario& scenario) {
  Config config;
  config.plant.terrain = scenario.terrain;
  config.mpc.horizon = scenario.horizon;
  return config;
}

std::string robot_file(const Config& config) {
  return (data_dir() / "robots" / config.robot / (config.robot + ".xml")).string();
}

/// Sample `i` of `samples` took `us` this time.
template <class T>
T& note(std::vector<T>& samples, std::size_t i, double us) {
  if (i == samples.size()) samples.emplace_back().quickest_us = us;
  T& sample = samples[i];
  sample.quickest_us = std::min(sample.quickest_us, us);
  sample.slowest_us = std::max(sample.slowest_us, us);
  return sample;
}

/// The robot of a scenario, pushed once a second from all sides, its parts timed.
class TimedWorld final : public World {
 public:
  TimedWorld(const Scenario& scenario, const Config& config)
      : push_speed_(scenario.push_speed),
        plant_(Plant::create(config.plant, plant_setup(config, robot_file(config))).value()) {}

  double period() const override { return plant_.period(); }
  std::optional<SensorReading> sense() override {
    push();
    const Stopwatch watch;
    SensorReading reading = plant_.sense();
    sense_us = watch.microseconds();
    return reading;
  }
  void send(const JointCommand& command) override {
    const Stopwatch watch;
    plant_.advance(command);
    send_us = watch.microseconds();
    ++tick_;
  }
  const PlantTruth* truth() const override { return &plant_.truth(); }

  void push() {
    if (push_speed_ == 0.0 || tick_ < 0 || tick_ % kTicksBetweenPushes != 0) return;
    const double direction = kGoldenAngle * tick_ / kTicksBetweenPushes;
    plant_.push(push_speed_ * Vec3(std::cos(direction), std::sin(direction), 0.0));
  }

  double sense_us = 0.0, send_us = 0.0;  ///< of the last call

 private:
  double push_speed_;
  Plant plant_;
  int tick_ = -kWarmUpTicks;
};

/// Closed loop; leaves the joint commands in `commands`.
void run_closed_loop(const Config& config, TimedWorld& world, March& out,
                     std::vector<JointCommand>& commands) {
  SpinController controller = SpinController::create(config, robot_file(config)).value();
  const BaseTruth& start = world.truth()->base;
  controller.reset({start.p_WB, start.R_WB});
  MotionCommand command;
  command.walk = true;
  command.yaw_rate = config.run.rate;
  ControlLoop loop(world, controller);
  std::size_t solution = 0;
  for (int tick = -kWarmUpTicks; tick < kTimedTicks; ++tick) {
    const double tick_us = loop.tick(command)->tick_us;
    commands.push_back(controller.trace().command);
    loop.send();
    if (is_stood_down(controller.status())) throw std::runtime_error("march: the robot fell");
    if (tick < 0) continue;
    const auto i = static_cast<std::size_t>(tick);
    note(out.physics_step, i, world.send_us / out.steps_per_period);
    note(out.tick, i, tick_us);
    note(out.period, i, world.sense_us + tick_us + world.send_us);
    note(out.wbc, i, controller.timing().wbc_us);
    if (controller.timing().mpc_us == 0.0) continue;
    MpcSample& mpc = note(out.mpc, solution++, controller.timing().mpc_us);
    mpc.constrained = controller.trace().mpc.status == SolveStatus::kConstrained;
    mpc.iterations = controller.trace().mpc.iterations;
  }
}

/// The plant alone, driven by `commands`.
void replay(TimedWorld& world, March& out, const std::vector<JointCommand>& commands) {
  for (int tick = -kWarmUpTicks; tick < kTimedTicks; ++tick) {
    world.push();
    world.send(commands[static_cast<std::size_t>(tick + kWarmUpTicks)]);
    if (tick < 0) continue;
    note(out.replayed_step, static_cast<std::size_t>(tick), world.send_us / out.steps_per_period);
  }
}

}  // namespace

March march(const Scenario& scenario) {
  const Config config = make_config(scenario);
  March out;
  out.steps_per_period =
      static_cast<int>(std::lround(1.0 / (config.control.rate * config.plant.timestep)));
  out.simulated_s = kTimedTicks / config.control.rate;
  std::vector<JointCommand> commands;
  commands.reserve(kWarmUpTicks + kTimedTicks);
  for (int i = 0; i < kRepetitions; ++i) {
    commands.clear();
    TimedWorld closed_loop(scenario, config), plant_alone(scenario, config);
    run_closed_loop(config, closed_loop, out, commands);
    replay(plant_alone, out, commands);
    if (closed_loop.truth()->base.p_WB != plant_alone.truth()->base.p_WB) {
      throw std::runtime_error("march: the replayed commands led elsewhere");
    }
  }
  return out;
}

}  // namespace pirouette::bench
