// What finding a point of a path costs: as much on a path of kilometres as on one of metres.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "pirouette/path/path.hpp"

namespace pirouette::bench {
namespace {

/// Closed ring of `length` (m) through points about a metre apart, at most 10,000.
Path ring(double length) {
  const auto count = static_cast<int>(std::clamp(length, 8.0, 10000.0));
  const double radius = length / (2.0 * kPi);
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * i / count;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return Path::spline(points, true).value();
}

constexpr double kWindow = 0.2;   // m, as the path's reference uses it
constexpr double kStride = 1e-3;  // m, from tick to tick

void path_nearest(benchmark::State& state) {
  const Path path = ring(static_cast<double>(state.range(0)));
  double s = 0.3 * path.length();
  for ([[maybe_unused]] auto _ : state) {
    s = path.nearest(path.at(s + kStride).p + Vec2(0.01, 0.0), s, kWindow);
    benchmark::DoNotOptimize(s);
  }
}

void path_at(benchmark::State& state) {
  const Path path = ring(static_cast<double>(state.range(0)));
  double s = 0.3 * path.length();
  for ([[maybe_unused]] auto _ : state) {
    s += kStride;
    benchmark::DoNotOptimize(path.at(s));
  }
}

BENCHMARK(path_nearest)->ArgName("length_m")->Arg(10)->Arg(1000)->Arg(5700);
BENCHMARK(path_at)->ArgName("length_m")->Arg(10)->Arg(1000)->Arg(5700);

}  // namespace
}  // namespace pirouette::bench

BENCHMARK_MAIN();
