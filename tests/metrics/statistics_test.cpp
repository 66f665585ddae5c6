#include "pirouette/metrics/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

constexpr double kRounding = 1e-12;  // of a few thousand additions of numbers of size 1

std::vector<Vec2> arc(const Vec2& centre, double radius, double from, double to, int count) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = from + (to - from) * i / (count - 1);
    points.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

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

TEST(CircleFit, MatchesTheVectors) {
  const nlohmann::json& section = test::vectors("circle_fit");
  const double tolerance = section.at("tol");
  for (const nlohmann::json& c : section.at("cases")) {
    std::vector<Vec2> points;
    for (const nlohmann::json& p : c.at("points")) points.push_back(test::to_vec2(p));
    const auto fit = fit_circle(points);
    ASSERT_TRUE(fit);
    EXPECT_LT(test::distance(fit->centre, test::to_vec2(c.at("centre"))), tolerance);
    EXPECT_NEAR(fit->radius, c.at("radius_kasa").get<double>(), tolerance);
    EXPECT_NEAR(fit->mean_radius, c.at("rho_mean").get<double>(), tolerance);
    EXPECT_NEAR(fit->radius_variance, c.at("rho_var").get<double>(), tolerance);
  }
}

TEST(CircleFit, FindsTheCircleFromAnArcOfItFarFromTheOrigin) {
  const Vec2 centre(40.0, -7.0);
  const auto fit = fit_circle(arc(centre, 0.5, 0.3, 1.9, 50));
  ASSERT_TRUE(fit);
  constexpr double kTolerance =
      1e-11;  // 40 m against rounding of 1e-16, times the arc's conditioning
  EXPECT_LT((fit->centre - centre).norm(), kTolerance);
  EXPECT_NEAR(fit->radius, 0.5, kTolerance);
  EXPECT_NEAR(fit->radius_variance, 0.0, kTolerance);
}

TEST(CircleFit, IsAbsentWhereThereIsNoCircle) {
  EXPECT_FALSE(fit_circle({}));
  EXPECT_FALSE(fit_circle(std::vector{Vec2(0.0, 0.0), Vec2(1.0, 0.0)}));
  EXPECT_FALSE(fit_circle(std::vector<Vec2>(10, Vec2(1.0, 2.0))));
  EXPECT_FALSE(fit_circle(std::vector{Vec2(0.0, 0.0), Vec2(1.0, 1.0), Vec2(3.0, 3.0)}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fit_circle(std::vector{Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(nan, 3.0)}));
}

TEST(Resampling, OfALineAtAnotherRateStaysOnTheLine) {
  std::vector<double> time;
  std::vector<Vec2> points;
  for (int i = 0; i <= 333; ++i) {
    time.push_back(5.0 + i / 333.0);
    points.emplace_back(time.back(), -2.0 * time.back());
  }
  const std::vector<Vec2> out = resample(time, points, 100.0);
  ASSERT_EQ(out.size(), 101u);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double t = 5.0 + static_cast<double>(k) / 100.0;
    EXPECT_LT((out[k] - Vec2(t, -2.0 * t)).norm(), kRounding);
  }
}

TEST(Resampling, ByAWholeFactorPicksSamples) {
  std::vector<double> time;
  std::vector<Vec2> points;
  for (int i = 0; i < 500; ++i) {
    time.push_back(i / 500.0);
    points.emplace_back(i, i * i);
  }
  const std::vector<Vec2> out = resample(time, points, 100.0);
  ASSERT_EQ(out.size(), 100u);
  constexpr double kTolerance = 1e-6;  // of 500^2, from the rounding of the times
  for (std::size_t k = 0; k < out.size(); ++k) {
    EXPECT_LT((out[k] - points[5 * k]).norm(), kTolerance);
  }
}

TEST(CentralDifference, IsExactForAParabolaInside) {
  std::vector<double> x;
  for (int i = 0; i < 20; ++i) x.push_back(square(0.1 * i));
  const std::vector<double> slope = central_difference(x, 10.0);
  for (int i = 1; i < 19; ++i) EXPECT_NEAR(slope[static_cast<std::size_t>(i)], 0.2 * i, kRounding);
}

/// Amplitude of frequency `f` in the middle of the filtered unit sine, and its phase.
Vec2 response(double f, double rate, double cutoff) {
  const int count = static_cast<int>(8.0 * rate);
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(std::sin(2.0 * kPi * f * i / rate));
  const std::vector<double> y = zero_phase_lowpass(x, rate, cutoff);
  Vec2 sum = Vec2::Zero();
  const int from = count / 4, to = 3 * count / 4;  // 4 s: whole periods, far from the ends
  for (int i = from; i < to; ++i) {
    const double phase = 2.0 * kPi * f * i / rate;
    sum += y[static_cast<std::size_t>(i)] * Vec2(std::sin(phase), std::cos(phase));
  }
  return sum * 2.0 / (to - from);
}

TEST(ZeroPhaseLowpass, HasTheClosedFormGainAndNoPhase) {
  constexpr double kRate = 500.0, kCutoff = 20.0;
  for (const double f : {1.0, 5.0, 10.0, 20.0, 40.0, 80.0}) {
    const double ratio = std::tan(kPi * f / kRate) / std::tan(kPi * kCutoff / kRate);
    const Vec2 found = response(f, kRate, kCutoff);
    constexpr double kTransient = 1e-9;  // of the ends, 2 s away
    EXPECT_NEAR(found.x(), 1.0 / (1.0 + std::pow(ratio, 4)), kTransient) << f << " Hz";
    EXPECT_NEAR(found.y(), 0.0, kTransient) << f << " Hz";
  }
}

TEST(ZeroPhaseLowpass, LeavesAConstantAloneUpToTheEnds) {
  for (const double y : zero_phase_lowpass(std::vector<double>(50, 3.0), 500.0, 20.0)) {
    EXPECT_NEAR(y, 3.0, kRounding);
  }
}

TEST(ZeroPhaseLowpass, MatchesScipyOnAStep) {
  std::vector<double> step(20, 0.0);
  std::fill(step.begin() + 10, step.end(), 1.0);
  const std::vector<double> y = zero_phase_lowpass(step, 500.0, 20.0);
  // scipy.signal.filtfilt(*scipy.signal.butter(2, 20, fs=500), step)
  const std::vector<double> expected = {
      -0.011711608434638442, 0.005761169829399879, 0.030251109352809863, 0.06288561082817984,
      0.10465223958915665,   0.15626375917910645,  0.21798651991526563,  0.2894296481881028,
      0.36929438079734334,   0.45508564737777407,  0.543046408060363,    0.6288343019753909,
      0.7086999062317738,    0.780163382644625,    0.8419487808168724,   0.8936954911953329,
      0.9357072625697099,    0.9687407644156251,   0.9938328872968518,   1.0121640504079312};
  ASSERT_EQ(y.size(), expected.size());
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(y[i], expected[i], kRounding);
}

TEST(ZeroPhaseLowpass, IsEmptyWhereItMeansNothing) {
  EXPECT_TRUE(zero_phase_lowpass(std::vector<double>(9, 1.0), 500.0, 20.0).empty());
  EXPECT_TRUE(zero_phase_lowpass(std::vector<double>(100, 1.0), 30.0, 20.0).empty());
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
