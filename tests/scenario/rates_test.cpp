// Control rates, and a gyro that is switched on with a large bias, in the real closed loop.
#include <gtest/gtest.h>

#include <cmath>

#include "support/trial.hpp"

namespace pirouette {
namespace {

struct Loop {
  const char* robot;
  const char* profile;
  int rate;  ///< Hz
};

Metrics spin(const Loop& loop, std::vector<std::string> overrides) {
  overrides.insert(overrides.end(),
                   {"control.rate=" + std::to_string(loop.rate), "run.rate=0.7", "run.turns=3"});
  ConfigSources sources;
  sources.robot = loop.robot;
  sources.profile = loop.profile;
  sources.overrides = std::move(overrides);
  const Result<Config> config = load_config(sources);
  if (!config) throw std::runtime_error(config.errors().front().to_string());
  return test::run(config.value());
}

class SpinAtRate : public testing::TestWithParam<Loop> {};

TEST_P(SpinAtRate, StaysOnThePoint) {
  for (const char* seed : {"run.seed=1", "run.seed=2"}) {
    const Metrics m = spin(GetParam(), {seed});
    EXPECT_FALSE(m.fell);
    EXPECT_GE(m.turns_done, 2.9);
    EXPECT_LE(m.com.radius_mean_mm.value_or(1e9), 1.5) << seed;
  }
}

std::string name_of(const testing::TestParamInfo<Loop>& of) {
  const auto& [robot, profile, rate] = of.param;
  return std::string(robot) + "_" + profile + "_" + std::to_string(rate) + "Hz";
}

INSTANTIATE_TEST_SUITE_P(Rates, SpinAtRate,
                         testing::Values(Loop{"mini_cheetah", "nominal", 100},
                                         Loop{"mini_cheetah", "realistic", 100},
                                         Loop{"mini_cheetah", "nominal", 200},
                                         Loop{"mini_cheetah", "nominal", 1000},
                                         Loop{"go1", "nominal", 100}, Loop{"go1", "realistic", 200},
                                         Loop{"go1", "realistic", 1000}),
                         name_of);

class BiasedGyro : public testing::TestWithParam<int> {};

TEST_P(BiasedGyro, CostsNothingAfterASecondOfStanding) {
  const Loop loop{"mini_cheetah", "nominal", GetParam()};
  constexpr int kSeeds = 4;
  double sum2 = 0.0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Metrics m = spin(loop, {"plant.faults.start=0", "plant.faults.gyro_bias=0.02",
                                  "run.seed=" + std::to_string(seed)});
    EXPECT_FALSE(m.fell);
    EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), 1.5);
    sum2 += square(m.yaw_rate_error.value_or(1.0));
  }
  // A second of the gyro's noise leaves 3.5e-4 (one deviation).
  EXPECT_LE(std::sqrt(sum2 / kSeeds), 5e-4);
}

INSTANTIATE_TEST_SUITE_P(Rates, BiasedGyro, testing::Values(500, 1000));

}  // namespace
}  // namespace pirouette
