#include "pirouette/metrics/running_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "pirouette/base/random.hpp"
#include "pirouette/metrics/statistics.hpp"
#include "support/two_pass_metrics.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

constexpr double kRounding = 1e-12;              // of a few thousand additions of numbers of size 1
constexpr double kRate = 500.0, kCutoff = 20.0;  // Hz

std::vector<Vec2> arc(const Vec2& centre, double radius, double from, double to, int count) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = from + (to - from) * i / (count - 1);
    points.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

std::optional<Circle> fit_circle(const std::vector<Vec2>& points) {
  CircleFit fit;
  for (const Vec2& p : points) fit.add(p);
  return fit.circle();
}

PointCloud cloud_of(const std::vector<Vec2>& points) {
  PointCloud cloud;
  for (const Vec2& p : points) cloud.add(p);
  return cloud;
}

std::vector<Vec2> resample(const std::vector<double>& time, const std::vector<Vec2>& points,
                           double rate) {
  Resampler<2> resampler(rate);
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < time.size(); ++i) {
    resampler.add(time[i], points[i], [&](const Vec2& p) { out.push_back(p); });
  }
  return out;
}

std::vector<double> zero_phase_lowpass(const std::vector<double>& x, double rate, double cutoff) {
  ZeroPhaseLowpass filter(rate, cutoff);
  std::vector<double> out;
  for (const double value : x) {
    for (const double y : filter.add(value)) out.push_back(y);
  }
  for (const double y : filter.finish()) out.push_back(y);
  return out;
}

TEST(RunningMoments, AreThoseOfTheList) {
  const std::vector<double> x = {1e3 + 1.0, 1e3 + 2.0, 1e3 + 3.0, 1e3 + 4.0};
  RunningMoments moments;
  EXPECT_FALSE(moments.mean());
  for (const double value : x) {
    moments.add(value);
    EXPECT_EQ(moments.variance().has_value(), moments.count() > 1.0);
  }
  EXPECT_DOUBLE_EQ(*moments.mean(), *mean(x));
  EXPECT_NEAR(*moments.variance(), *variance(x), kRounding);
}

TEST(RunningMoments, OfGroupsAreThoseOfAllTheirNumbers) {
  RunningMoments all, left, right, merged;
  for (const double x : {1.0, 5.0, 2.0}) all.add(x), left.add(x);
  for (const double x : {-3.0, 8.0}) all.add(x), right.add(x);
  for (const RunningMoments& m : {left, right}) {
    merged.add(m.count(), *m.mean(), *m.variance() * (m.count() - 1.0));
  }
  EXPECT_NEAR(*merged.mean(), *all.mean(), kRounding);
  EXPECT_NEAR(*merged.variance(), *all.variance(), kRounding);
}

/// Spread over decades, as tick times are.
std::vector<double> long_tailed(std::size_t count) {
  std::mt19937_64 generator(1);
  std::vector<double> x;
  for (std::size_t i = 0; i < count; ++i) {
    const double uniform = unit_interval(generator()) + 0x1p-54;
    x.push_back(50.0 / std::sqrt(uniform));
  }
  return x;
}

TEST(RunningQuantiles, AreExactWhileTheyKeepAllSamples) {
  const std::vector<double> x = long_tailed(RunningQuantiles::kExact);
  RunningQuantiles running;
  EXPECT_FALSE(running.quantile(0.5));
  for (const double value : x) running.add(value);
  for (const double share : {0.0, 0.5, 0.99}) {
    EXPECT_EQ(running.quantile(share), quantile(x, share)) << share;
  }
}

TEST(RunningQuantiles, StayWithinTheirResolutionForever) {
  const std::vector<double> x = long_tailed(20 * RunningQuantiles::kExact);
  RunningQuantiles running;
  for (const double value : x) running.add(value);
  for (const double share : {0.0, 0.05, 0.5, 0.95, 0.99, 0.9999, 1.0}) {
    const double exact = *quantile(x, share);
    EXPECT_NEAR(*running.quantile(share), exact, RunningQuantiles::kResolution * exact) << share;
  }
  EXPECT_EQ(running.largest(), maximum(x));
}

TEST(RunningQuantiles, HoldZerosAndWhatIsNotANumber) {
  RunningQuantiles running;
  for (std::size_t i = 0; i <= RunningQuantiles::kExact; ++i) running.add(0.0);
  EXPECT_EQ(running.quantile(0.5), 0.0);
  running.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(running.quantile(0.5));
  EXPECT_FALSE(running.largest());
}

TEST(WindowRange, IsTheMeanOverWholeWindows) {
  const auto range = [](const std::vector<double>& x, std::size_t length) {
    WindowRange windows(length);
    for (const double value : x) windows.add(value);
    return windows.mean();
  };
  const std::vector<double> x = {0.0, 1.0, 0.0, 3.0, 100.0};
  EXPECT_EQ(range(x, 2), 2.0) << "the last, incomplete window is left out";
  EXPECT_EQ(range(x, 50), 100.0);
  EXPECT_FALSE(range({}, 2));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(*range({0.0, nan, 1.0}, 2)));
  EXPECT_TRUE(std::isnan(*range({0.0, nan, 1.0}, 50)));
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
    const PointCloud::Distances rho = *cloud_of(points).distances(fit->centre);
    EXPECT_NEAR(rho.mean, c.at("rho_mean").get<double>(), tolerance);
    EXPECT_NEAR(*rho.variance, c.at("rho_var").get<double>(), tolerance);
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

TEST(FilteredSlope, OfALineIsItsSlopeAndOfAParabolaALine) {
  FilteredSlopeVariance line(kRate, kCutoff);
  FilteredSlopeVariance parabola(kRate, kCutoff);
  constexpr int kCount = 10000;
  for (int i = 0; i < kCount; ++i) {
    line.add(0.7 * i / kRate);
    parabola.add(square(i / kRate));
  }
  constexpr double kCancellation = 1e-9;  // differences of numbers of size 10, times the rate
  EXPECT_NEAR(*line.moments().mean(), 0.7, kCancellation);
  EXPECT_NEAR(*line.moments().variance(), 0.0, kCancellation);
  const double range = 2.0 * kCount / kRate;  // of the slope, evenly spread
  EXPECT_NEAR(*parabola.moments().variance(), square(range) / 12.0, 1e-3 * square(range));
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

/// The blocks meet without a seam.
TEST(ZeroPhaseLowpass, InBlocksIsTheWholeRecords) {
  for (const double rate : {50.0, 100.0, 500.0, 2000.0}) {
    std::vector<double> x;
    std::mt19937_64 generator(1);
    for (std::size_t i = 0; i < 5 * ZeroPhaseLowpass::kBlock + 17; ++i) {
      x.push_back(unit_interval(generator()));
    }
    const std::vector<double> blocks = zero_phase_lowpass(x, rate, kCutoff);
    const std::vector<double> whole = test::filtfilt(x, rate, kCutoff);
    ASSERT_EQ(blocks.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) ASSERT_NEAR(blocks[i], whole[i], kRounding) << i;
  }
}

/// A thick ring about (0.3, -0.2) with a drift along x, in metres.
std::vector<Vec2> ring(std::size_t count, double radius, double thickness, double drift) {
  std::mt19937_64 generator(1);
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double uniform = unit_interval(generator());
    const double angle = 7e-3 * static_cast<double>(i);
    const double place = drift * static_cast<double>(i) / static_cast<double>(count);
    points.push_back(Vec2(0.3 + place, -0.2) + (radius + thickness * (uniform - 0.5)) *
                                                   Vec2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

TEST(PointCloud, IsExactWhileItKeepsAllPoints) {
  const std::vector<Vec2> points = ring(PointCloud::kCapacity, 0.02, 0.001, 0.01);
  const PointCloud cloud = cloud_of(points);
  EXPECT_EQ(cloud.cell(), 0.0);
  const std::vector<double> exact = test::distances(points, Vec2(0.31, -0.2));
  const PointCloud::Distances found = *cloud.distances(Vec2(0.31, -0.2));
  EXPECT_NEAR(found.mean, *mean(exact), kRounding);
  EXPECT_EQ(found.largest, *maximum(exact));
  EXPECT_NEAR(*found.variance, *variance(exact), kRounding);
}

/// An hour and more: rings as of a spin, spots, wide drifts; about a centre inside, on and far off
/// the points.
TEST(PointCloud, OfManyPointsStaysWithinTheBounds) {
  struct Case {
    double radius, thickness, drift;
  };
  for (const auto& [radius, thickness, drift] :
       {Case{0.02, 0.001, 0.0}, Case{0.02, 0.001, 0.01}, Case{0.0, 0.001, 0.0},
        Case{0.0003, 0.0005, 0.03}, Case{0.5, 0.01, 0.0}}) {
    const std::vector<Vec2> points = ring(400000, radius, thickness, drift);
    const PointCloud cloud = cloud_of(points);
    EXPECT_GT(cloud.cell(), 0.0);
    for (const Vec2& centre :
         {test::centroid(points), Vec2(0.3, -0.2), Vec2(0.3 + radius, -0.2), Vec2(-1.0, 0.0)}) {
      const std::vector<double> exact = test::distances(points, centre);
      const PointCloud::Distances found = *cloud.distances(centre);
      EXPECT_NEAR(found.mean, *mean(exact), 1e-5 * *mean(exact));
      EXPECT_NEAR(*found.variance, *variance(exact), 1e-4 * *variance(exact));
      EXPECT_LE(found.largest, *maximum(exact));
      EXPECT_GE(found.largest, std::cos(kPi / PointCloud::kDirections) * *maximum(exact));
    }
  }
}

TEST(PointCloud, HoldsEqualPointsAndWhatIsNotANumber) {
  PointCloud cloud;
  EXPECT_FALSE(cloud.distances(Vec2::Zero()));
  for (std::size_t i = 0; i < 3 * PointCloud::kCapacity; ++i) cloud.add(Vec2(3.0, 4.0));
  EXPECT_NEAR(cloud.distances(Vec2::Zero())->mean, 5.0, kRounding);
  EXPECT_EQ(cloud.distances(Vec2::Zero())->largest, 5.0);
  EXPECT_NEAR(*cloud.distances(Vec2::Zero())->variance, 0.0, kRounding);
  cloud.add(Vec2(std::numeric_limits<double>::quiet_NaN(), 0.0));
  EXPECT_FALSE(cloud.distances(Vec2::Zero()));
}

}  // namespace
}  // namespace pirouette
