// Every terrain carries a spinning robot, and it stays near the point. Bounds: twice the mean
// distance measured with seed 1.
#include <gtest/gtest.h>

#include "support/trial.hpp"

namespace pirouette {
namespace {

struct Ground {
  const char* terrain;
  double distance_mm;  ///< largest mean distance of the CoM to the point
};

class SpinOnTerrain : public testing::TestWithParam<Ground> {};

TEST_P(SpinOnTerrain, ThreeTurnsNearThePointWithoutAFall) {
  const Metrics m =
      test::spin({std::string("plant.terrain=\"") + GetParam().terrain + "\"", "run.turns=3"});
  EXPECT_FALSE(m.fell);
  EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-3);
  EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), GetParam().distance_mm);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SpinOnTerrain,
                         testing::Values(Ground{"slope:10", 3.5}, Ground{"slope:20", 3.1},
                                         Ground{"stairs:0.03x0.20", 8.7},
                                         Ground{"stairs:0.03x0.20@30", 3.7},
                                         Ground{"rough:0.04", 16.0},
                                         Ground{"slope:10+rough:0.02", 4.1},
                                         Ground{"blocks:0.02", 12.2}, Ground{"patch:0.3x0.6", 9.1},
                                         Ground{"soft:0.04", 2.3}),
                         [](const auto& kind) { return "Terrain" + std::to_string(kind.index); });

}  // namespace
}  // namespace pirouette
