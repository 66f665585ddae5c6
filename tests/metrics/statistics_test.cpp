#include "pirouette/metrics/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace pirouette {
namespace {

TEST(Statistics, OfNothingAreAbsent) {
  const std::vector<double> none;
  EXPECT_FALSE(mean(none));
  EXPECT_FALSE(maximum(none));
  EXPECT_FALSE(quantile(none, 0.5));
  EXPECT_FALSE(variance(std::vector{1.0}));
}

TEST(Statistics, VarianceIsUnbiased) {
  EXPECT_DOUBLE_EQ(*variance(std::vector{1.0, 2.0, 3.0, 4.0}), 5.0 / 3.0);
}

TEST(Statistics, QuantilesInterpolateBetweenOrderStatistics) {
  const std::vector<double> x = {4.0, 1.0, 3.0, 2.0, 5.0};
  EXPECT_DOUBLE_EQ(*quantile(x, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(*quantile(x, 0.5), 3.0);
  EXPECT_DOUBLE_EQ(*quantile(x, 0.95), 4.8);
  EXPECT_DOUBLE_EQ(*quantile(x, 1.0), 5.0);
}

/// [Newcombe98], table I, method 3.
TEST(Wilson, GivesThePublishedIntervals) {
  const auto expect = [](std::size_t count, std::size_t trials, double low, double high) {
    const std::optional<Interval> interval = wilson_interval(count, trials);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, low, 5e-5);  // printed with four digits
    EXPECT_NEAR(interval->high, high, 5e-5);
  };
  expect(81, 263, 0.2553, 0.3662);
  expect(15, 148, 0.0624, 0.1605);
  expect(0, 20, 0.0, 0.1611);
  expect(1, 29, 0.0061, 0.1718);
}

TEST(Wilson, MirrorsSuccessAndFailure) {
  const Interval falls = *wilson_interval(5, 1000), survived = *wilson_interval(995, 1000);
  EXPECT_NEAR(falls.low, 1.0 - survived.high, 1e-15);
  EXPECT_NEAR(falls.high, 1.0 - survived.low, 1e-15);
  EXPECT_FALSE(wilson_interval(0, 0));
}

}  // namespace
}  // namespace pirouette
