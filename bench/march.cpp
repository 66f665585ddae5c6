#include "march.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "pirouette/base/rotation.hpp"
#include "pirouette/config/validate.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/study/configured_trial.hpp"

namespace pirouette::bench {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRepetitions = 3;
constexpr int kWarmUpTicks = 1500;
constexpr int kTimedTicks = 20000;
constexpr int kTicksBetweenPushes = 500;
constexpr double kGoldenAngle = 2.39996;  // rad, so that pushes come from all sides

double microseconds(Clock::duration d) {
  return std::chrono::duration<double, std::micro>(d).count();
}

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

class Repetition {
 public:
  Repetition(const Scenario& scenario, const Config& config)
      : config_(config),
        push_speed_(scenario.push_speed),
        plant_(Plant::create(config.plant, plant_setup(config, robot_file(config))).value()) {}

  /// Closed loop; leaves the joint commands in `commands`.
  void run(March& out, std::vector<JointCommand>& commands) {
    SpinController controller = SpinController::create(config_, robot_file(config_)).value();
    const BaseTruth& start = plant_.truth().base;
    controller.reset({start.p_WB, start.R_WB});
    MotionCommand command;
    command.walk = true;
    command.yaw_rate = config_.run.rate;
    std::size_t solution = 0;
    for (int tick = -kWarmUpTicks; tick < kTimedTicks; ++tick) {
      push(tick);
      const auto t0 = Clock::now();
      const SensorReading sensors = plant_.sense();
      const auto t1 = Clock::now();
      commands.push_back(controller.tick(sensors, command));
      const auto t2 = Clock::now();
      plant_.advance(commands.back());
      const auto t3 = Clock::now();
      if (is_stood_down(controller.status())) throw std::runtime_error("march: the robot fell");
      if (tick < 0) continue;
      const auto i = static_cast<std::size_t>(tick);
      note(out.physics_step, i, microseconds(t3 - t2) / out.steps_per_period);
      note(out.tick, i, microseconds(t2 - t1));
      note(out.period, i, microseconds(t3 - t0));
      note(out.wbc, i, controller.timing().wbc_us);
      if (controller.timing().mpc_us == 0.0) continue;
      MpcSample& mpc = note(out.mpc, solution++, controller.timing().mpc_us);
      mpc.constrained = controller.trace().mpc.status == SolveStatus::kConstrained;
      mpc.iterations = controller.trace().mpc.iterations;
    }
  }

  /// The plant alone, driven by `commands`.
  void replay(March& out, const std::vector<JointCommand>& commands) {
    for (int tick = -kWarmUpTicks; tick < kTimedTicks; ++tick) {
      push(tick);
      const auto begin = Clock::now();
      plant_.advance(commands[static_cast<std::size_t>(tick + kWarmUpTicks)]);
      const auto end = Clock::now();
      if (tick < 0) continue;
      note(out.replayed_step, static_cast<std::size_t>(tick),
           microseconds(end - begin) / out.steps_per_period);
    }
  }

  Vec3 position() const { return plant_.truth().base.p_WB; }

 private:
  void push(int tick) {
    if (push_speed_ == 0.0 || tick < 0 || tick % kTicksBetweenPushes != 0) return;
    const double direction = kGoldenAngle * tick / kTicksBetweenPushes;
    plant_.push(push_speed_ * Vec3(std::cos(direction), std::sin(direction), 0.0));
  }

  Config config_;
  double push_speed_;
  Plant plant_;
};

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
    Repetition closed_loop(scenario, config), plant_alone(scenario, config);
    closed_loop.run(out, commands);
    plant_alone.replay(out, commands);
    if (closed_loop.position() != plant_alone.position()) {
      throw std::runtime_error("march: the replayed commands led elsewhere");
    }
  }
  return out;
}

}  // namespace pirouette::bench
