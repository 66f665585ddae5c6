// The metrics of ten hours: `make soak`, not part of `make test`.
#include "support/metrics_memory.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

TEST(MetricsMemory, OfTenHoursIsThatOfOne) {
  for (const double yaw_rate : {0.7, 0.001, 0.0}) {
    EXPECT_LT(test::memory_of_metrics(yaw_rate, 10.0), 20.0) << yaw_rate << " rad/s";
  }
}

}  // namespace
}  // namespace pirouette
