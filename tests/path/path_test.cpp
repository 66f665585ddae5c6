#include "pirouette/path/path.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

Vec2 tangent(const PathSample& sample) {
  return {std::cos(sample.heading), std::sin(sample.heading)};
}

/// Figure of eight that crosses itself at its first waypoint.
std::vector<Vec2> figure_of_eight() {
  constexpr int kCount = 24;
  std::vector<Vec2> points;
  for (int i = 0; i < kCount; ++i) {
    const double a = 2.0 * kPi * i / kCount;
    points.emplace_back(0.6 * std::sin(a), 0.6 * std::sin(a) * std::cos(a));
  }
  return points;
}

std::vector<Vec2> ring(int count, double radius) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * kPi * i / count;
    points.emplace_back(radius * std::sin(a), radius * (1.0 - std::cos(a)));
  }
  return points;
}

std::vector<Path> every_kind() {
  const std::vector<Vec2> open = {{0.0, 0.0}, {0.4, 0.1}, {0.7, -0.2}, {1.2, 0.3}, {1.0, 0.8}};
  return {Path::line({1.0, 2.0}, 0.4), Path::circle({1.0, 2.0}, 0.4, 0.5),
          Path::circle({1.0, 2.0}, 2.9, -0.3), Path::spline(open, false).value(),
          Path::spline(figure_of_eight(), true).value()};
}

TEST(Path, ALineIsStraight) {
  const Path path = Path::line({1.0, 2.0}, radians(90.0));
  EXPECT_LT(distance(path.at(0.7).p, Vec2(1.0, 2.7)), 1e-15);
  EXPECT_EQ(path.at(0.7).curvature, 0.0);
  EXPECT_NEAR(path.nearest({5.0, 1.5}), -0.5, 1e-15);
  EXPECT_TRUE(std::isinf(path.length()));
  EXPECT_FALSE(path.closed());
}

TEST(Path, ACircleTurnsAboutItsCentreOnTheSideOfItsSign) {
  for (const double radius : {0.5, -0.5}) {
    const Path path = Path::circle({1.0, 0.0}, 0.0, radius);
    const Vec2 centre(1.0, radius);
    EXPECT_NEAR(path.length(), kPi, 1e-15);
    for (double s = -4.0; s < 9.0; s += 0.37) {
      const PathSample sample = path.at(s);
      EXPECT_NEAR((sample.p - centre).norm(), 0.5, 1e-14);
      EXPECT_NEAR(tangent(sample).dot(sample.p - centre), 0.0, 1e-14);
      EXPECT_EQ(sample.curvature, 1.0 / radius);
      // A projection stays on its lap.
      const Vec2 beside = centre + 1.3 * (sample.p - centre);
      EXPECT_NEAR(path.nearest(beside, s + 0.4, 1.0), s, 1e-12);
    }
  }
}

TEST(Path, TheCentreOfACircleIsNearestToWhereItWas) {
  EXPECT_EQ(Path::circle(Vec2::Zero(), 0.0, 0.5).nearest({0.0, 0.5}, 1.25, 1.0), 1.25);
}

TEST(Path, ArcLengthIsTheDistanceTravelledAndTheTangentItsDerivative) {
  constexpr double kStep = 1e-5;  // m: central differences leave h^2 of it
  for (const Path& path : every_kind()) {
    for (double s = 0.01; s < 1.5; s += 0.013) {
      const Vec2 derivative = (path.at(s + kStep).p - path.at(s - kStep).p) / (2.0 * kStep);
      EXPECT_NEAR(derivative.norm(), 1.0, 1e-8);
      EXPECT_LT(distance(derivative, tangent(path.at(s))), 1e-8);
    }
  }
}

TEST(Path, CurvatureIsTheRateOfTheHeading) {
  constexpr double kStep = 1e-5;
  for (const Path& path : every_kind()) {
    for (double s = 0.01; s < 1.5; s += 0.013) {
      const double turned = wrap_angle(path.at(s + kStep).heading - path.at(s - kStep).heading);
      // The third derivative of a spline jumps at its knots.
      EXPECT_NEAR(turned / (2.0 * kStep), path.at(s).curvature, 5e-3);
    }
  }
}

TEST(Path, ASplinePassesThroughItsWaypointsAndCloses) {
  const std::vector<Vec2> points = figure_of_eight();
  const Path path = Path::spline(points, true).value();
  for (const Vec2& point : points) {
    const double s = path.nearest(point);
    EXPECT_LT(distance(path.at(s).p, point), 1e-9);
  }
  const PathSample start = path.at(0.0), end = path.at(path.length()), later = path.at(7.0);
  EXPECT_LT(distance(start.p, end.p), 1e-12);
  EXPECT_NEAR(start.heading, end.heading, 1e-9);
  EXPECT_NEAR(start.curvature, end.curvature, 1e-6);
  EXPECT_LT(distance(later.p, path.at(7.0 - 2.0 * path.length()).p), 1e-12);
}

TEST(Path, ASplineThroughACircleIsNearlyThatCircle) {
  constexpr double kRadius = 0.4;
  const Path path = Path::spline(ring(24, kRadius), true).value();
  // Error of a cubic spline: (chord angle)^4 / 384 of the radius in position, squared in curvature.
  EXPECT_NEAR(path.length(), 2.0 * kPi * kRadius, 1e-4);
  for (double s = 0.0; s < path.length(); s += 0.01) {
    EXPECT_NEAR((path.at(s).p - Vec2(0.0, kRadius)).norm(), kRadius, 1e-5);
    EXPECT_NEAR(path.at(s).curvature, 1.0 / kRadius, 0.02);
  }
}

TEST(Path, ASplineThroughTwoPointsIsTheLineBetweenThem) {
  const Path path = Path::spline(std::vector<Vec2>{{1.0, 1.0}, {4.0, 5.0}}, false).value();
  EXPECT_NEAR(path.length(), 5.0, 1e-12);
  EXPECT_LT(distance(path.at(2.5).p, Vec2(2.5, 3.0)), 1e-12);
  EXPECT_NEAR(path.at(2.5).curvature, 0.0, 1e-12);
}

TEST(Path, AnOpenSplineEndsAtItsLastWaypointWithoutCurvature) {
  const std::vector<Vec2> points = {{0.0, 0.0}, {0.4, 0.1}, {0.7, -0.2}, {1.2, 0.3}};
  const Path path = Path::spline(points, false).value();
  for (const double beyond : {0.0, 3.0}) {
    EXPECT_LT(distance(path.at(-beyond).p, points.front()), 1e-12);
    EXPECT_LT(distance(path.at(path.length() + beyond).p, points.back()), 1e-12);
  }
  EXPECT_NEAR(path.at(0.0).curvature, 0.0, 1e-9);
  EXPECT_NEAR(path.at(path.length()).curvature, 0.0, 1e-9);
  EXPECT_NEAR(path.nearest({5.0, 5.0}), path.length(), 1e-9);
  EXPECT_NEAR(path.nearest({-5.0, 0.0}), 0.0, 1e-9);
}

TEST(Path, TheNearestPointIsWhereTheNormalMeetsThePath) {
  for (const Path& path : every_kind()) {
    for (double s = 0.05; s < 1.4; s += 0.07) {
      const PathSample sample = path.at(s);
      for (const double aside : {-0.05, 0.0, 0.05}) {
        const Vec2 normal(-std::sin(sample.heading), std::cos(sample.heading));
        const double found = path.nearest(sample.p + aside * normal, s + 0.03, 0.1);
        EXPECT_NEAR(found, s, 1e-9) << "at " << s << ", " << aside << " m aside";
      }
    }
  }
}

/// m, from `p` to the nearest of points of the path every half millimetre within `window` (m) of
/// `s_near` (m).
double sampled_distance(const Path& path, const Vec2& p, double s_near, double window) {
  constexpr double kStep = 5e-4;  // m
  double least = std::numeric_limits<double>::infinity();
  for (double way = -window; way <= window; way += kStep) {
    least = std::min(least, (path.at(s_near + way).p - p).norm());
  }
  return least;
}

TEST(Path, NoSampleOfTheWindowIsNearerThanTheNearestPoint) {
  constexpr double kWindow = 0.2;  // m
  // Waypoints from 12 mm to 1.6 m apart, of a curve that bends less than the points lie off it.
  std::vector<Vec2> uneven;
  for (const double angle :
       {0.0, 0.006, 0.02, 0.5, 0.51, 0.53, 1.2, 2.0, 2.02, 2.8, 3.5, 4.2, 5.0, 5.7})
    uneven.emplace_back(2.0 * std::cos(angle), 2.0 * std::sin(angle));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const bool closed : {false, true}) {
    const Path path = Path::spline(uneven, closed).value();
    for (int i = 0; i < 2000; ++i) {
      // Every tenth within a window of the ends, where a closed path goes round.
      const double along = i % 10 == 0 ? share(random) * kWindow : share(random) * path.length();
      const double s_near = (closed ? 3.0 * path.length() : 0.0) + along;
      const Vec2 p = path.at(s_near).p + 0.05 * Vec2(share(random) - 0.5, share(random) - 0.5);
      const double found = path.nearest(p, s_near, kWindow);
      ASSERT_LE(std::abs(found - s_near), kWindow + 1e-9);
      ASSERT_LE((path.at(found).p - p).norm(), sampled_distance(path, p, s_near, kWindow) + 1e-9)
          << (closed ? "closed" : "open") << ", at " << s_near << " of " << path.length();
    }
  }
}

TEST(Path, TheWindowKeepsToTheBranchThatIsFollowed) {
  const Path path = Path::spline(figure_of_eight(), true).value();
  const double lap = path.length();
  // The crossing is passed at the beginning and in the middle of each lap.
  const Vec2 crossing(0.001, 0.0);
  EXPECT_NEAR(path.nearest(crossing, 0.05, 0.2), 0.0, 0.01);
  EXPECT_NEAR(path.nearest(crossing, 0.5 * lap - 0.05, 0.2), 0.5 * lap, 0.01);
  EXPECT_NEAR(path.nearest(crossing, 2.5 * lap + 0.05, 0.2), 2.5 * lap, 0.01);
  EXPECT_NEAR(path.nearest(crossing, 3.0 * lap - 0.05, 0.2), 3.0 * lap, 0.01);
}

TEST(Path, MovingItsStartMovesAllOfItRigidly) {
  for (const Path& path : every_kind()) {
    Path moved = path;
    moved.start_at({0.3, -0.7}, 1.1);
    const PathSample start = path.at(0.0);
    EXPECT_LT(distance(moved.at(0.0).p, Vec2(0.3, -0.7)), 1e-12);
    EXPECT_NEAR(moved.at(0.0).heading, 1.1, 1e-12);
    const Mat2 turn = rot2(1.1 - start.heading);
    for (double s = 0.0; s < 1.5; s += 0.11) {
      const Vec2 expected = Vec2(0.3, -0.7) + turn * (path.at(s).p - start.p);
      EXPECT_LT(distance(moved.at(s).p, expected), 1e-9);
      EXPECT_NEAR(moved.at(s).curvature, path.at(s).curvature, 1e-9);
    }
  }
}

TEST(Path, AMirroredPathIsTheMirrorImage) {
  std::vector<Vec2> points = figure_of_eight();
  const Path path = Path::spline(points, true).value();
  for (Vec2& point : points) point.y() = -point.y();
  const Path mirrored = Path::spline(points, true).value();
  for (double s = 0.0; s < 3.0; s += 0.1) {
    EXPECT_LT(distance(mirrored.at(s).p, Vec2(path.at(s).p.x(), -path.at(s).p.y())), 1e-12);
    EXPECT_NEAR(mirrored.at(s).curvature, -path.at(s).curvature, 1e-9);
  }
}

TEST(Path, ThereIsNoneThroughTooFewOrCoincidingWaypoints) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec2> one = {{0.0, 0.0}}, two = {{0.0, 0.0}, {1.0, 0.0}};
  const std::vector<Vec2> twice = {{0.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}};
  const std::vector<Vec2> repeated_end = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}};
  const std::vector<Vec2> not_finite = {{0.0, 0.0}, {nan, 0.0}, {0.0, 1.0}};
  EXPECT_FALSE(Path::spline({}, false));
  EXPECT_FALSE(Path::spline(one, false));
  EXPECT_FALSE(Path::spline(two, true));
  EXPECT_FALSE(Path::spline(twice, false));
  EXPECT_FALSE(Path::spline(repeated_end, true));
  EXPECT_TRUE(Path::spline(repeated_end, false));
  EXPECT_FALSE(Path::spline(not_finite, true));
}

TEST(Path, ThereIsNoneThatTurnsBackOnItself) {
  // The spline through these stands still half-way back: there it has no tangent.
  const std::vector<Vec2> there_and_back = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.0}};
  EXPECT_FALSE(Path::spline(there_and_back, false));
  const std::vector<Vec2> hairpin = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.05}, {0.0, 0.05}};
  const std::optional<Path> narrow = Path::spline(hairpin, false);
  ASSERT_TRUE(narrow);
  for (double s = 0.0; s <= narrow->length(); s += 1e-3) {
    ASSERT_TRUE(narrow->at(s).p.allFinite() && std::isfinite(narrow->at(s).curvature)) << s;
  }
}

}  // namespace
}  // namespace pirouette
