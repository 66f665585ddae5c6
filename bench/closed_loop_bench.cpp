// What the controller costs, held against one physics step of the marching robot in the same run.
//
// A march is deterministic, so it is run several times and each piece of work counts with its
// quickest time: what remains is the work, not what else the machine was doing. The slowest time is
// shown as well. google-benchmark filters and reports (--benchmark_filter, --benchmark_out); the
// times are the recorded ones.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "march.hpp"

namespace pirouette::bench {
namespace {

const std::array kScenarios = {
    Scenario{"flat", "flat"},
    Scenario{"flat, N = 10", "flat", 10},
    Scenario{"slope:15", "slope:15"},
    Scenario{"stairs:0.05x0.20", "stairs:0.05x0.20"},
    Scenario{"flat, pushed", "flat", 16, 0.6},
};

const March& cached(const Scenario& scenario) {
  static std::map<std::string, March> marches;
  const auto found = marches.find(scenario.name);
  if (found != marches.end()) return found->second;
  std::fprintf(stderr, "marching: %s\n", scenario.name.c_str());
  return marches.emplace(scenario.name, march(scenario)).first->second;
}

template <class T>
double mean(const std::vector<T>& samples) {
  const double sum = std::accumulate(samples.begin(), samples.end(), 0.0,
                                     [](double s, const T& x) { return s + x.quickest_us; });
  return sum / static_cast<double>(samples.size());
}

template <class T>
void summarise(benchmark::State& state, const std::vector<T>& samples, double step_us) {
  std::vector<double> sorted;
  double slowest = 0.0;
  for (const T& sample : samples) {
    sorted.push_back(sample.quickest_us);
    slowest = std::max(slowest, sample.slowest_us);
  }
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    state.SetIterationTime(1e-6 * sorted[i++ % samples.size()]);
  }
  std::sort(sorted.begin(), sorted.end());
  const auto quantile = [&](double q) {
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  };
  state.counters["samples"] = static_cast<double>(samples.size());
  state.counters["mean"] = mean(samples);
  state.counters["steps"] = mean(samples) / step_us;
  state.counters["p50"] = quantile(0.5);
  state.counters["p99.9"] = quantile(0.999);
  state.counters["max"] = sorted.back();
  state.counters["slowest"] = slowest;
}

template <class Part>
void add(const Scenario& scenario, const char* name, Part part) {
  benchmark::RegisterBenchmark((scenario.name + "/" + name).c_str(),
                               [&scenario, part](benchmark::State& state) {
                                 const March& m = cached(scenario);
                                 summarise(state, m.*part, mean(m.physics_step));
                               })
      ->UseManualTime()
      ->MinTime(1e-6);
}

void add_mpc(const Scenario& scenario) {
  benchmark::RegisterBenchmark(
      (scenario.name + "/mpc").c_str(),
      [&scenario](benchmark::State& state) {
        const March& m = cached(scenario);
        summarise(state, m.mpc, mean(m.physics_step));
        state.counters["constrained"] = static_cast<double>(
            std::count_if(m.mpc.begin(), m.mpc.end(), [](const auto& s) { return s.constrained; }));
      })
      ->UseManualTime()
      ->MinTime(1e-6);
}

/// The results as one table; prose before and after comes from `main`.
class Table : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override {
    std::printf("%-36s%7s%9s%9s%9s%9s%10s%9s%13s\n", "", "steps", "mean", "p50", "p99.9", "max",
                "slowest", "samples", "constrained");
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const auto counter = [&](const char* key) { return run.counters.at(key).value; };
      std::string name = run.benchmark_name();
      name = name.substr(0, name.rfind("/min_time"));
      std::printf("%-36s%7.2f%9.1f%9.1f%9.1f%9.1f%10.0f%9.0f", name.c_str(), counter("steps"),
                  counter("mean"), counter("p50"), counter("p99.9"), counter("max"),
                  counter("slowest"), counter("samples"));
      if (run.counters.contains("constrained")) std::printf("%13.0f", counter("constrained"));
      std::printf("\n");
    }
  }
};

void print_histogram(const Scenario& scenario) {
  constexpr std::array kEdges = {0.0,   10.0,  15.0,  20.0,  30.0,   50.0,   70.0,  100.0,
                                 150.0, 200.0, 300.0, 500.0, 1000.0, 2000.0, 5000.0};
  constexpr double kWidth = 50.0;
  const std::vector<MpcSample>& samples = cached(scenario).mpc;
  int iterations = 0;
  for (const MpcSample& s : samples) iterations = std::max(iterations, s.iterations);
  std::printf("\nMPC solutions, %s: %zu, at most %d iterations\n%17s%15s%13s\n",
              scenario.name.c_str(), samples.size(), iterations, "us", "unconstrained",
              "constrained");
  for (std::size_t i = 0; i < kEdges.size(); ++i) {
    const double from = kEdges[i], to = i + 1 < kEdges.size() ? kEdges[i + 1] : 1e12;
    int free = 0, constrained = 0;
    for (const MpcSample& s : samples) {
      if (s.quickest_us >= from && s.quickest_us < to) ++(s.constrained ? constrained : free);
    }
    if (free + constrained == 0) continue;
    const double share = static_cast<double>(free + constrained) / samples.size();
    std::printf("%7.0f%s%7.0f%15d%13d  %s\n", from, to < 1e12 ? " - " : " on", to < 1e12 ? to : 0.0,
                free, constrained, std::string(1 + share * kWidth, '#').c_str());
  }
}

void print_speed(const Scenario& scenario) {
  const March& m = cached(scenario);
  const double closed = 1e6 * m.simulated_s / (mean(m.period) * m.period.size());
  const double alone =
      1e6 * m.simulated_s / (mean(m.replayed_step) * m.replayed_step.size() * m.steps_per_period);
  std::printf("  %-20s %5.1f x real time, MuJoCo with the controller off %5.1f x: %.0f %%\n",
              scenario.name.c_str(), closed, alone, 100.0 * closed / alone);
}

void register_all() {
  for (const Scenario& scenario : kScenarios) {
    add_mpc(scenario);
    if (scenario.horizon != 16) continue;
    add(scenario, "wbc", &March::wbc);
    add(scenario, "whole tick", &March::tick);
    add(scenario, "physics step", &March::physics_step);
  }
}

}  // namespace
}  // namespace pirouette::bench

int main(int argc, char** argv) {
  using namespace pirouette::bench;
  register_all();
  benchmark::Initialize(&argc, argv);
  std::printf(
      "The robot spins at 0.7 rad/s for 40 s, three times alike. Times in us.\n"
      "  steps        mean, in units of the mean physics step (1 ms simulated) of the same march\n"
      "  mean .. max  of the quickest of the three times that each piece of work took\n"
      "  slowest      of all times: on a busy machine, mostly how long others had the processor\n"
      "  constrained  solutions that met a friction or force limit\n"
      "mpc: one solution, about every twelfth tick, N = 16 steps unless said; pushed: the trunk's\n"
      "velocity jumps by 0.6 m/s, once per second.\n\n");
  Table table;
  if (benchmark::RunSpecifiedBenchmarks(&table) < kScenarios.size()) return 0;  // a filter
  for (const Scenario& scenario : kScenarios) {
    if (scenario.name != "flat, N = 10") print_histogram(scenario);
  }
  std::printf("\nClosed loop, one thread\n");
  for (const Scenario& scenario : kScenarios) print_speed(scenario);
}
