// Every terrain carries a spinning robot for a while; how well it stays put is another matter.
#include <gtest/gtest.h>

#include "support/trial.hpp"

namespace pirouette {
namespace {

class SpinOnTerrain : public testing::TestWithParam<const char*> {};

TEST_P(SpinOnTerrain, ThreeTurnsWithoutAFall) {
  const Metrics m =
      test::spin({std::string("plant.terrain=\"") + GetParam() + "\"", "run.turns=3"});
  EXPECT_FALSE(m.fell);
  EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-2);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SpinOnTerrain,
                         testing::Values("slope:10", "slope:20", "stairs:0.03x0.20",
                                         "stairs:0.03x0.20@30", "rough:0.04", "slope:10+rough:0.02",
                                         "blocks:0.02", "patch:0.3x0.6", "soft:0.04"),
                         [](const auto& kind) { return "Terrain" + std::to_string(kind.index); });

}  // namespace
}  // namespace pirouette
