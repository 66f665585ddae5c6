// What the controller costs, held against one physics step of the marching robot in the same run.
//
// Every benchmark marches the closed loop; the clock runs only for the part that it names. The
// counter `steps` is that part's mean in units of the mean physics step of its own run, so that a
// noisy machine disturbs both alike. p50, p99.9 and max are microseconds.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "pirouette/config/validate.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/plant/plant.hpp"

namespace pirouette {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

class March {
 public:
  explicit March(const std::string& terrain, int horizon)
      : config_(make_config(terrain, horizon)),
        mjcf_(data_dir() / "robots" / config_.robot / (config_.robot + ".xml")),
        plant_(Plant::create(config_, mjcf_.string()).value()),
        controller_(SpinController::create(config_, mjcf_.string()).value()) {
    const BaseTruth& start = plant_.truth().base;
    controller_.reset({start.p_WB, start.R_WB});
    command_.walk = true;
    command_.yaw_rate = config_.run.rate;
    for (int i = 0; i < kWarmUpTicks; ++i) tick();
  }

  void tick() {
    const auto t0 = Clock::now();
    const SensorReading sensors = plant_.sense();
    const auto t1 = Clock::now();
    const JointCommand& joints = controller_.tick(sensors, command_);
    const auto t2 = Clock::now();
    plant_.advance(joints);
    tick_s = seconds(t2 - t1);
    loop_s = seconds(Clock::now() - t0);
    physics_step_s = seconds(Clock::now() - t2) * config_.plant.timestep * config_.control.rate;
  }

  const TickTiming& timing() const { return controller_.timing(); }
  double period() const { return 1.0 / config_.control.rate; }

  double tick_s = 0.0, loop_s = 0.0, physics_step_s = 0.0;  ///< of the last tick

 private:
  static constexpr int kWarmUpTicks = 1500;

  static Config make_config(const std::string& terrain, int horizon) {
    Config config;
    config.plant.terrain = terrain;
    config.mpc.horizon = horizon;
    return config;
  }

  Config config_;
  std::filesystem::path mjcf_;
  Plant plant_;
  SpinController controller_;
  MotionCommand command_;
};

/// Times what `cost` (s) returns after each tick; 0 means that the tick had no such part.
template <class Cost>
void run(benchmark::State& state, const std::string& terrain, int horizon, Cost&& cost) {
  March march(terrain, horizon);
  std::vector<double> costs;
  double physics = 0.0;
  std::size_t ticks = 0;
  for ([[maybe_unused]] auto _ : state) {
    double spent = 0.0;
    while (spent == 0.0) {
      march.tick();
      physics += march.physics_step_s;
      ++ticks;
      spent = cost(march);
    }
    costs.push_back(spent);
    state.SetIterationTime(spent);
  }
  const double mean = std::accumulate(costs.begin(), costs.end(), 0.0) / costs.size();
  std::sort(costs.begin(), costs.end());
  const auto quantile = [&](double q) {
    return 1e6 * costs[static_cast<std::size_t>(q * static_cast<double>(costs.size() - 1))];
  };
  state.counters["steps"] = mean / (physics / static_cast<double>(ticks));
  state.counters["p50"] = quantile(0.5);
  state.counters["p99.9"] = quantile(0.999);
  state.counters["max"] = quantile(1.0);
}

void register_all() {
  const auto add = [](const std::string& name, const std::string& terrain, int horizon, auto cost) {
    benchmark::RegisterBenchmark(
        (name + "/" + terrain).c_str(),
        [=](benchmark::State& state) { run(state, terrain, horizon, cost); })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  };
  const auto mpc = [](const March& m) { return 1e-6 * m.timing().mpc_us; };
  add("PhysicsStep", "flat", 16, [](const March& m) { return m.physics_step_s; });
  add("Mpc, N = 10", "flat", 10, mpc);
  for (const char* terrain : {"flat", "slope:15", "stairs:0.05x0.20"}) {
    add("Mpc, N = 16", terrain, 16, mpc);
    add("WholeBodyControl", terrain, 16, [](const March& m) { return 1e-6 * m.timing().wbc_us; });
    add("WholeTick", terrain, 16, [](const March& m) { return m.tick_s; });
  }
  add("ClosedLoopPeriod", "flat", 16, [](const March& m) { return m.loop_s; });
}

}  // namespace
}  // namespace pirouette

int main(int argc, char** argv) {
  pirouette::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
