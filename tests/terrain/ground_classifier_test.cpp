#include "pirouette/terrain/ground_classifier.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

using Ground = std::function<double(const Vec2&)>;

/// Footholds of a robot that turns on the spot, leg by leg, with noise of the heights (m).
class TurningRobot {
 public:
  explicit TurningRobot(Ground ground, double noise = 0.0, double turn = 0.0)
      : ground_(std::move(ground)), noise_(0.0, noise), turn_(turn) {}

  void step(GroundClassifier& classifier, int strides) {
    for (int i = 0; i < strides; ++i, yaw_ += 0.35) {
      for (const Leg leg : kLegs) {
        const Vec2 hip(fore_sign(leg) * 0.19, side_sign(leg) * 0.11);
        const Vec2 local = rot2(yaw_) * hip;
        const Vec2 xy = rot2(turn_) * local;
        classifier.add(leg, {xy.x(), xy.y(), ground_(local) + noise_(generator_)});
      }
    }
  }

 private:
  Ground ground_;
  std::mt19937 generator_{5};
  std::normal_distribution<double> noise_;
  double turn_;
  double yaw_ = 0.0;
};

Ground slope(double angle) {
  return [angle](const Vec2& p) { return std::tan(angle) * p.x(); };
}
Ground stairs(double rise, double run) {
  return [=](const Vec2& p) { return rise * std::floor(p.x() / run + 0.5); };
}

TEST(GroundClassifier, SaysNothingBeforeEveryFootHasStoodThreeTimes) {
  GroundClassifier classifier{TerrainConfig{}};
  TurningRobot robot(slope(0.2));
  EXPECT_FALSE(classifier.estimate().known);
  robot.step(classifier, 2);
  EXPECT_FALSE(classifier.estimate().known);
  robot.step(classifier, 1);
  EXPECT_TRUE(classifier.estimate().known);
}

TEST(GroundClassifier, OneFootAloneIsNoGround) {
  GroundClassifier classifier{TerrainConfig{}};
  for (int i = 0; i < 20; ++i) classifier.add(Leg::kFR, {0.1 * i, 0.0, i % 2 ? 0.1 : 0.0});
  EXPECT_FALSE(classifier.estimate().known);
  EXPECT_FALSE(classifier.estimate().stepped);
}

TEST(GroundClassifier, APlaneLeavesNoResidualHoweverSteep) {
  for (const double angle : {0.0, 0.26, 0.5}) {
    GroundClassifier classifier{TerrainConfig{}};
    TurningRobot(slope(angle)).step(classifier, 10);
    EXPECT_LT(classifier.estimate().residual, 1e-15);
    EXPECT_LT(classifier.estimate().step_height, 1e-15);
    EXPECT_FALSE(classifier.estimate().stepped);
  }
}

TEST(GroundClassifier, NoiseOfTheEncodersMakesNoSteps) {
  GroundClassifier classifier{TerrainConfig{}};
  TurningRobot robot(slope(0.3), 0.5e-3);
  for (int i = 0; i < 100; ++i) {
    robot.step(classifier, 1);
    EXPECT_FALSE(classifier.estimate().stepped);
  }
}

TEST(GroundClassifier, StairsAreSteppedWithinThreeStridesAndStaySo) {
  for (const double rise : {0.03, 0.05, 0.10}) {
    GroundClassifier classifier{TerrainConfig{}};
    TurningRobot robot(stairs(rise, 0.2), 0.5e-3);
    robot.step(classifier, 3);
    for (int i = 0; i < 50; ++i, robot.step(classifier, 1)) {
      EXPECT_TRUE(classifier.estimate().stepped) << rise << " stride " << i;
    }
    // The plane through the steps misses them by up to half a rise to each side; noise adds 3
    // sigma.
    EXPECT_GT(classifier.estimate().step_height, 0.5 * rise);
    EXPECT_LT(classifier.estimate().step_height, 1.5 * rise);
  }
}

TEST(GroundClassifier, TheVerdictChangesWithHysteresis) {
  const TerrainConfig config;
  // A checkerboard of footholds: amplitude a of alternating sign in the diagonal pairs is the
  // residual.
  const auto residual = [](GroundClassifier& classifier, double amplitude) {
    for (int i = 0; i < 3; ++i) {
      for (const Leg leg : kLegs) {
        classifier.add(leg, {fore_sign(leg) * 0.19, side_sign(leg) * 0.11,
                             fore_sign(leg) * side_sign(leg) * amplitude});
      }
    }
    EXPECT_NEAR(classifier.estimate().residual, amplitude, 1e-15);
    EXPECT_NEAR(classifier.estimate().step_height, 2.0 * amplitude, 1e-15);
    return classifier.estimate().stepped;
  };
  const double between = 0.5 * (config.step_residual + config.step_residual_release);
  GroundClassifier classifier(config);
  EXPECT_FALSE(residual(classifier, between));
  EXPECT_TRUE(residual(classifier, 1.01 * config.step_residual));
  EXPECT_TRUE(residual(classifier, between));
  EXPECT_FALSE(residual(classifier, 0.99 * config.step_residual_release));
  EXPECT_FALSE(residual(classifier, between));
}

TEST(GroundClassifier, DoesNotDependOnWhereNorthIs) {
  GroundClassifier straight{TerrainConfig{}}, turned{TerrainConfig{}};
  TurningRobot(stairs(0.05, 0.2)).step(straight, 7);
  TurningRobot(stairs(0.05, 0.2), 0.0, 1.234).step(turned, 7);
  EXPECT_NEAR(straight.estimate().residual, turned.estimate().residual, 1e-14);
  EXPECT_NEAR(straight.estimate().step_height, turned.estimate().step_height, 1e-14);
}

TEST(GroundClassifier, ForgetsOnResetAndIsSilentOnAFlatWorld) {
  GroundClassifier classifier{TerrainConfig{}};
  TurningRobot robot(stairs(0.05, 0.2));
  robot.step(classifier, 5);
  ASSERT_TRUE(classifier.estimate().stepped);
  classifier.reset();
  EXPECT_FALSE(classifier.estimate().known);
  EXPECT_FALSE(classifier.estimate().stepped);

  TerrainConfig flat;
  flat.estimation = TerrainEstimation::kOff;
  GroundClassifier off(flat);
  robot.step(off, 5);
  EXPECT_FALSE(off.estimate().stepped);
}

}  // namespace
}  // namespace pirouette
