#include "pirouette/controller/tick_clock.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

TEST(TickClock, MeasuresTheTimeBetweenReadingsWithinBounds) {
  TickClock clock(0.002);
  EXPECT_EQ(clock.update(5.0), 0.002);  // nothing to measure from
  EXPECT_DOUBLE_EQ(clock.update(5.003), 5.003 - 5.0);
  EXPECT_EQ(clock.update(5.003), 0.001);  // the same stamp twice
  EXPECT_EQ(clock.update(4.0), 0.001);    // back in time
  EXPECT_EQ(clock.update(6.0), 0.02);     // a gap
}

TEST(TickClock, StartsAfresh) {
  TickClock clock(0.002);
  clock.update(5.0);
  clock.reset();
  EXPECT_EQ(clock.update(7.0), 0.002);
}

}  // namespace
}  // namespace pirouette
