#include "pirouette/terrain/foothold_memory.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

using Ground = std::function<double(const Vec2&)>;

Ground slope(double angle) {
  return [angle](const Vec2& p) { return std::tan(angle) * p.x(); };
}

/// Up along `direction` (rad), the origin in the middle of a tread.
Ground stairs(double rise, double run, double direction = 0.0) {
  const Vec2 uphill(std::cos(direction), std::sin(direction));
  return [=](const Vec2& p) { return rise * std::floor(uphill.dot(p) / run + 0.5); };
}

/// Contacts of a robot that spins at 0.7 rad/s with a stride of 0.5 s and steps within
/// `scatter` (m) of its nominal footholds; `noise` (m) in every coordinate.
std::vector<Vec3> footholds(const Ground& ground, int strides, double noise = 0.0,
                            double scatter = 0.01) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> off(-scatter, scatter);
  std::normal_distribution<double> error(0.0, 1.0);
  std::vector<Vec3> out;
  for (int i = 0; i < strides; ++i) {
    for (const Leg leg : kLegs) {
      const double x = fore_sign(leg) * 0.19 + off(generator);
      const double y = side_sign(leg) * 0.11 + off(generator);
      const Vec2 xy = rot2(0.35 * i) * Vec2(x, y);
      const double ex = error(generator), ey = error(generator), ez = error(generator);
      out.emplace_back(xy.x() + noise * ex, xy.y() + noise * ey, ground(xy) + noise * ez);
    }
  }
  return out;
}

FootholdMemory remembering(const std::vector<Vec3>& contacts,
                           const TerrainConfig& config = TerrainConfig{}) {
  FootholdMemory memory(config);
  for (const Vec3& p_WC : contacts) memory.add(p_WC, Vec2::Zero());
  return memory;
}

/// Places over which the robot's feet go.
std::vector<Vec2> places() {
  std::vector<Vec2> out;
  for (int i = 0; i < 72; ++i) out.push_back(rot2(radians(5.0 * i)) * Vec2(0.21, 0.0));
  return out;
}

TEST(FootholdMemory, SaysNothingOfGroundThatIsNoStairs) {
  const Ground hills = [](const Vec2& p) {
    return 0.1 * p.x() + 0.02 * std::sin(23.0 * p.x()) * std::cos(19.0 * p.y());
  };
  const Ground flat = [](const Vec2&) { return 0.3; };
  for (const Ground& ground : {flat, slope(0.17), slope(0.35), slope(0.52), hills}) {
    const FootholdMemory memory = remembering(footholds(ground, 40, 0.3e-3));
    EXPECT_EQ(memory.tread_count(), 0u);
    for (const Vec2& p : places()) EXPECT_FALSE(memory.at(p).has_value());
  }
}

TEST(FootholdMemory, FindsTreadsAndTheirHeights) {
  for (const double rise : {0.03, 0.05, 0.08}) {
    const Ground ground = stairs(rise, 0.2);
    const FootholdMemory memory = remembering(footholds(ground, 40, 0.3e-3));
    ASSERT_EQ(memory.tread_count(), 3u);
    for (const Vec2& p : places()) {
      if (std::abs(std::abs(p.x()) - 0.1) < 0.03) continue;  // at an edge either tread will do
      const auto known = memory.at(p);
      ASSERT_TRUE(known.has_value());
      EXPECT_NEAR(known->height, ground(p), 0.3e-3);  // mean of a dozen at 0.3 mm
    }
  }
}

// An edge is known as well as the gap between the feet on its two sides is narrow: the ring of feet
// crosses it at 60 degrees with 160 of them on 1.3 m; and its ends 0.19 m aside as well as the
// climb, to some hundredths of a radian. Together 2 cm.
TEST(FootholdMemory, MovesFootholdsOffEdgesAlongTheClimbOnly) {
  const TerrainConfig config;
  for (const double direction : {0.0, 0.5}) {
    const Vec2 uphill(std::cos(direction), std::sin(direction));
    const FootholdMemory memory = remembering(footholds(stairs(0.05, 0.2, direction), 40), config);
    ASSERT_GE(memory.tread_count(), 3u);
    for (const Vec2& p : places()) {
      const auto known = memory.at(p);
      ASSERT_TRUE(known.has_value());
      const double along = uphill.dot(p), moved = uphill.dot(known->p_W);
      const double from_edge = std::abs(std::remainder(moved - 0.1, 0.2));
      EXPECT_GT(from_edge, config.edge_margin - 0.02);
      EXPECT_LT(std::abs(moved - along), config.edge_margin + 0.02);
      // Sideways only by what the climb's direction is off.
      const Vec2 across(-uphill.y(), uphill.x());
      EXPECT_LT(std::abs(across.dot(known->p_W - p)), 0.1 * config.edge_margin);
    }
  }
}

TEST(FootholdMemory, FeetThatFollowItKeepOffEdgesWhateverTheClimb) {
  const TerrainConfig config;
  std::mt19937 generator(11);
  std::normal_distribution<double> noise(0.0, 0.5e-3);
  int near_edge = 0, near_edge_before = 0, steps = 0;
  for (int degree = 0; degree < 360; degree += 30) {
    const Vec2 uphill(std::cos(radians(degree)), std::sin(radians(degree)));
    const Ground ground = stairs(0.05, 0.2, radians(degree));
    const auto from_edge = [&](const Vec2& p) {
      return std::abs(std::remainder(uphill.dot(p) - 0.1, 0.2));
    };
    FootholdMemory memory(config);
    const std::vector<Vec3> planned = footholds(ground, 100);
    for (std::size_t i = 0; i < planned.size(); ++i) {
      const Vec2 p = planned[i].head<2>();
      const auto known = memory.at(p);
      const Vec2 taken = known ? known->p_W : p;
      memory.add({taken.x(), taken.y(), ground(taken) + noise(generator)}, Vec2::Zero());
      if (i < planned.size() / 2) continue;
      ++steps;
      near_edge += from_edge(taken) < 0.5 * config.edge_margin;
      near_edge_before += from_edge(p) < 0.5 * config.edge_margin;
    }
  }
  // Unmoved, one foot in eight lands there.
  EXPECT_GT(near_edge_before, steps / 10);
  EXPECT_LT(2 * near_edge, near_edge_before) << near_edge << " of " << steps;
}

TEST(FootholdMemory, AFootInTheMiddleOfATreadStaysWhereItIs) {
  const FootholdMemory memory = remembering(footholds(stairs(0.05, 0.2), 40, 0.3e-3));
  for (const double y : {-0.2, 0.21}) {
    const auto known = memory.at({0.01, y});
    ASSERT_TRUE(known.has_value());
    EXPECT_LT(distance(known->p_W, Vec2(0.01, y)), 1e-15);
  }
}

TEST(FootholdMemory, OnTreadsNarrowerThanTwoMarginsAFootAimsAtTheMiddle) {
  const double run = 0.06;
  const FootholdMemory memory = remembering(footholds(stairs(0.03, run), 40, 0.3e-3));
  ASSERT_GE(memory.tread_count(), 5u);
  for (const double x : {-0.07, -0.02, 0.0, 0.02, 0.07}) {
    const auto known = memory.at({x, 0.2});
    ASSERT_TRUE(known.has_value());
    // Half of the gap between feet at each of two edges.
    EXPECT_LT(std::abs(std::remainder(known->p_W.x(), run)), 0.02) << x;
  }
}

TEST(FootholdMemory, HasNoOpinionBeyondWhatTheFeetHaveMet) {
  const FootholdMemory memory = remembering(footholds(stairs(0.05, 0.2), 40));
  EXPECT_TRUE(memory.at({0.25, 0.0}).has_value());
  EXPECT_FALSE(memory.at({0.32, 0.0}).has_value());
  EXPECT_FALSE(memory.at({-0.32, 0.0}).has_value());
}

TEST(FootholdMemory, FindsTheClimbOfStairsAtAnyAngle) {
  for (int degree = 0; degree < 360; degree += 30) {
    const double direction = radians(degree);
    const Vec2 uphill(std::cos(direction), std::sin(direction));
    const FootholdMemory memory = remembering(footholds(stairs(0.05, 0.2, direction), 60));
    ASSERT_EQ(memory.tread_count(), 3u) << degree;
    // A foothold beside an edge is moved straight along the climb.
    const auto known = memory.at(0.09 * uphill);
    ASSERT_TRUE(known.has_value());
    const Vec2 moved = known->p_W - 0.09 * uphill;
    ASSERT_GT(moved.norm(), 0.01) << degree;
    EXPECT_LT(std::acos(std::abs(moved.normalized().dot(uphill))), radians(4.0)) << degree;
  }
}

TEST(FootholdMemory, NoiseOfHalfAMillimetreLeavesTheTreadsHeightsRight) {
  int right = 0, asked = 0;
  for (int degree = 0; degree < 360; degree += 30) {
    const double direction = radians(degree);
    const Vec2 uphill(std::cos(direction), std::sin(direction));
    const Ground ground = stairs(0.05, 0.2, direction);
    const FootholdMemory memory = remembering(footholds(ground, 60, 0.5e-3));
    for (const Vec2& p : places()) {
      if (std::abs(std::abs(uphill.dot(p)) - 0.1) < 0.04) continue;  // where feet do not go
      const auto known = memory.at(p);
      ++asked;
      right += known && std::abs(known->height - ground(p)) < 1e-3;
    }
  }
  // Noise turns the climb by up to 8 degrees, where the heights' order hardly depends on it.
  EXPECT_GT(right, asked * 95 / 100) << "of " << asked;
}

TEST(FootholdMemory, ItsAnswerTurnsWithTheWorld) {
  const std::vector<Vec3> contacts = footholds(stairs(0.05, 0.2, 0.2), 30, 0.3e-3);
  const FootholdMemory memory = remembering(contacts);
  ASSERT_GE(memory.tread_count(), 3u);
  for (const double angle : {0.8, 2.0, -1.3}) {
    std::vector<Vec3> turned;
    for (const Vec3& p : contacts) turned.push_back(rot_z(angle) * p);
    const FootholdMemory other = remembering(turned);
    for (const Vec2& p : places()) {
      const auto a = memory.at(p), b = other.at(rot2(angle) * p);
      ASSERT_EQ(a.has_value(), b.has_value());
      EXPECT_LT(distance(rot2(angle) * a->p_W, b->p_W), 1e-12);
      EXPECT_NEAR(a->height, b->height, 1e-14);
    }
  }
}

TEST(FootholdMemory, ItsAnswerIsMirroredWithTheWorld) {
  const std::vector<Vec3> contacts = footholds(stairs(0.05, 0.2, 0.2), 30, 0.3e-3);
  const auto mirrored = [](const Vec2& p) { return Vec2(p.x(), -p.y()); };
  std::vector<Vec3> other_side;
  for (const Vec3& p : contacts) other_side.emplace_back(p.x(), -p.y(), p.z());
  const FootholdMemory memory = remembering(contacts), other = remembering(other_side);
  for (const Vec2& p : places()) {
    const auto a = memory.at(p), b = other.at(mirrored(p));
    ASSERT_EQ(a.has_value(), b.has_value());
    EXPECT_LT(distance(mirrored(a->p_W), b->p_W), 1e-12);
  }
}

TEST(FootholdMemory, OddHeightsOfFeetOnEdgesMakeNoTread) {
  std::vector<Vec3> contacts = footholds(stairs(0.05, 0.2), 38, 0.3e-3);
  for (const double y : {-0.2, 0.2}) contacts.emplace_back(0.1, y, 0.025);
  const FootholdMemory memory = remembering(contacts);
  EXPECT_EQ(memory.tread_count(), 3u);
}

TEST(FootholdMemory, FollowsADriftOfTheOdometryByForgetting) {
  FootholdMemory memory{TerrainConfig{}};
  const std::vector<Vec3> before = footholds(stairs(0.05, 0.2), 40);
  for (const Vec3& p : before) memory.add(p, Vec2::Zero());
  const Vec3 drift(0.06, 0.0, 0.02);
  for (const Vec3& p : before) memory.add(p + drift, drift.head<2>());
  const FootholdMemory fresh = remembering(before);
  for (const Vec2& p : places()) {
    if (std::abs(std::abs(p.x()) - 0.1) < 0.03) continue;  // at an edge either tread will do
    const auto a = fresh.at(p), b = memory.at(p + drift.head<2>());
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->height + drift.z(), b->height, 1e-12);
    EXPECT_LT(distance(a->p_W + drift.head<2>(), b->p_W), 0.01);  // their climbs differ
  }
}

TEST(FootholdMemory, WhereOldHeightsContradictNewOnesTheNewAreAskedAlone) {
  const Ground ground = stairs(0.03, 0.2);
  const auto lowered = [&](const Vec2& p) { return ground(p) - 0.014; };
  std::vector<Vec3> contacts = footholds(lowered, 20);
  const std::vector<Vec3> now = footholds(ground, 20);
  contacts.insert(contacts.end(), now.begin(), now.end());
  const FootholdMemory memory = remembering(contacts);
  ASSERT_EQ(memory.tread_count(), 3u);
  const auto known = memory.at({0.0, 0.15});
  ASSERT_TRUE(known.has_value());
  EXPECT_NEAR(known->height, 0.0, 1e-3);
}

TEST(FootholdMemory, ItsPlaneIsLeastSquaresThroughTheFeetAroundTheRobot) {
  FootholdMemory memory{TerrainConfig{}};
  const std::vector<Vec3> contacts = footholds(slope(0.3), 10);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    memory.add(contacts[i], Vec2::Zero());
    EXPECT_EQ(memory.plane().has_value(), i + 1 >= 24) << i;
  }
  EXPECT_NEAR(memory.plane()->a1, std::tan(0.3), 1e-13);
  EXPECT_NEAR(memory.plane()->a2, 0.0, 1e-13);
  // From a robot that is elsewhere they are too far away.
  memory.add(contacts.front(), Vec2(3.0, 0.0));
  EXPECT_FALSE(memory.plane().has_value());
}

TEST(FootholdMemory, ForgetsOnResetAndKeepsNothingWhenSwitchedOff) {
  const std::vector<Vec3> contacts = footholds(stairs(0.05, 0.2), 40);
  FootholdMemory memory = remembering(contacts);
  ASSERT_GT(memory.tread_count(), 0u);
  memory.reset();
  EXPECT_EQ(memory.tread_count(), 0u);
  EXPECT_FALSE(memory.plane().has_value());
  EXPECT_FALSE(memory.at(Vec2::Zero()).has_value());

  TerrainConfig config;
  config.memory = false;
  const FootholdMemory off = remembering(contacts, config);
  EXPECT_EQ(off.tread_count(), 0u);
  EXPECT_FALSE(off.plane().has_value());
}

}  // namespace
}  // namespace pirouette
