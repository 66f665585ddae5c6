// The metrics in one pass against those from whole lists (support/two_pass_metrics.hpp), and their
// memory.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "pirouette/metrics/metric_values.hpp"
#include "support/metrics_memory.hpp"
#include "support/synthetic_motion.hpp"
#include "support/two_pass_metrics.hpp"

namespace pirouette {
namespace {

using test::kRate;
using test::Motion;
using test::walking_motion;

/// Every number that the whole lists give, within `bound` of its size; `others` are those with a
/// bound of their own.
void expect_near(const Metrics& found, const Metrics& exact, double bound,
                 const std::map<std::string, double>& others = {}) {
  MetricValues numbers = metric_values(found);
  int compared = 0;
  for (const auto& [key, value] : metric_values(exact)) {
    if (!value || *value == 0.0) continue;  // not part of the oracle
    ASSERT_TRUE(numbers.at(key)) << key;
    const auto other = others.find(key);
    const double share = other == others.end() ? bound : other->second;
    EXPECT_NEAR(*numbers.at(key), *value, share * std::abs(*value)) << key;
    ++compared;
  }
  EXPECT_EQ(compared, 32) << "numbers of the oracle";
}

TEST(OnePassMetrics, OfMinutesAreThoseOfTheWholeListsToRounding) {
  constexpr double kRounding = 1e-9;  // of sums of 100 000 numbers and differences of them
  for (const double yaw_rate : {0.7, -0.7, 0.1, 4.0}) {
    SCOPED_TRACE(yaw_rate);
    const CommandedMotion commanded{Vec2(0.2, -0.1), Vec2::Zero(), yaw_rate};
    const Motion motion = walking_motion(yaw_rate, 4.0);
    // The trunk sways back and forth over the end of the last half turn: a few samples more or
    // less.
    expect_near(test::measure(motion, commanded, kRate),
                test::two_pass_metrics(motion, commanded, kRate), kRounding,
                {{"com.distance_to_average_mean_mm", 1e-5}});
  }
}

/// 40 min: past what the point cloud, the quantiles and, at 0.02 rad/s, the last turn keep whole.
TEST(OnePassMetrics, OfALongMotionStayWithinTheirBounds) {
  for (const double yaw_rate : {0.7, -0.7, 0.02}) {
    SCOPED_TRACE(yaw_rate);
    const CommandedMotion commanded{Vec2(0.2, -0.1), Vec2::Zero(), yaw_rate};
    const Motion motion = walking_motion(yaw_rate, 40.0);
    expect_near(test::measure(motion, commanded, kRate),
                test::two_pass_metrics(motion, commanded, kRate), 1e-9,
                {{"com.distance_to_point_p95_mm", RunningQuantiles::kResolution},
                 {"com.radius_mean_mm", 1e-8},
                 {"com.radius_max_mm", 2e-5},
                 {"com.radius_variance_mm2", 1e-6},
                 {"com.circle_radius_mm", 1e-8},
                 {"com.circle_variance_mm2", 1e-6},
                 {"com.drift_per_turn_mm", 1e-4},
                 {"com.distance_to_average_mean_mm", 5e-5},
                 {"estimator.position_drift_per_turn_mm", 1e-4}});
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// Past what anything keeps whole; ten hours of it: tests/soak/metrics_memory_test.cpp. Turning,
/// turning slowly, and not turning at all: a last turn that never ends.
TEST(OnePassMetrics, OfAnHourTakeLessThanTwentyMegabytes) {
  for (const double yaw_rate : {0.7, 0.001, 0.0}) {
    EXPECT_LT(test::memory_of_metrics(yaw_rate, 1.0), 20.0) << yaw_rate << " rad/s";
  }
}
#endif

}  // namespace
}  // namespace pirouette
