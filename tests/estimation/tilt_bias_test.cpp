#include "pirouette/estimation/tilt_bias.hpp"

#include <gtest/gtest.h>

#include <random>

#include "pirouette/base/rotation.hpp"
#include "pirouette/terrain/plane_estimator.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kTick = 0.002, kRate = 0.7;  // s, rad/s
constexpr double kTime = 20.0;                // s, averaging
constexpr double kPrior = 0.1;                // weight of b = 0 against all data
const Vec2 kTilt(2e-3, -1e-3);

/// The ground that a robot turning by `angle` (rad) sees.
TiltBias after_turning(double angle, const Vec2& ground, const Vec2& tilt_H,
                       double first_yaw = 0.0) {
  TiltBias bias(kTime);
  const int ticks = static_cast<int>(std::lround(std::abs(angle) / (kRate * kTick)));
  for (int i = 0; i < ticks; ++i) {
    const double yaw = first_yaw + std::copysign(i * kRate * kTick, angle);
    bias.update(ground + rot2(yaw) * tilt_H, yaw, kTick);
  }
  return bias;
}

TEST(TiltBias, SeparatesTheTurningPartOverSeveralTurnsWhateverTheGround) {
  for (const double turns : {3.0, 8.0, -5.0}) {
    const double time = 2.0 * kPi * std::abs(turns) / kRate;
    // Mean of e^(i w t) that forgets with time constant T; only its size matters, and what has
    // been forgotten of the start is at most e^(-t/T) of it.
    const double remembered = 1.0 - std::exp(-time / kTime);
    const double mean_turn = 1.0 / std::hypot(1.0, kRate * kTime);
    const double spread = remembered * (1.0 - square(mean_turn));
    for (const Vec2& ground : {Vec2(0.0, 0.0), Vec2(0.27, 0.0), Vec2(-0.1, 0.3)}) {
      const TiltBias bias = after_turning(2.0 * kPi * turns, ground, kTilt);
      EXPECT_LT(distance(bias.slope_H(), spread / (spread + kPrior) * kTilt), 1e-2 * kTilt.norm())
          << turns;
    }
  }
}

TEST(TiltBias, IsLinearInTheBiasAndBlindToTheGround) {
  const double angle = 2.5;  // a part of a turn
  const Vec2 of_x = after_turning(angle, Vec2::Zero(), Vec2(1e-3, 0.0)).slope_H();
  const Vec2 of_y = after_turning(angle, Vec2::Zero(), Vec2(0.0, 1e-3)).slope_H();
  const Vec2 both = after_turning(angle, Vec2(0.27, -0.1), Vec2(3e-3, -2e-3)).slope_H();
  EXPECT_LT(distance(both, 3.0 * of_x - 2.0 * of_y), 1e-14);
  // The least-squares solution of a model without noise lies along the truth, shrunk.
  EXPECT_NEAR(of_x.y(), 0.0, 1e-16);
  EXPECT_GT(of_x.x(), 0.3e-3);
  EXPECT_LT(of_x.x(), 1e-3);
}

TEST(TiltBias, SaysNothingBeforeAPartOfATurn) {
  EXPECT_EQ(TiltBias(kTime).slope_H(), Vec2::Zero());
  TiltBias still(kTime);
  for (int i = 0; i < 5000; ++i) still.update(Vec2(0.27, -0.1), 1.1, kTick);
  EXPECT_LT(still.slope_H().norm(), 1e-14);
  EXPECT_LT(after_turning(0.1, Vec2(0.27, 0.0), kTilt).slope_H().norm(), 1e-2 * kTilt.norm());
}

TEST(TiltBias, GrowsTowardsTheTruthWithTheTurn) {
  double last = 0.0;
  for (const double angle : {0.5, 1.0, 2.0, 4.0, 8.0, 30.0}) {
    const double share =
        after_turning(angle, Vec2(0.2, 0.1), kTilt).slope_H().norm() / kTilt.norm();
    EXPECT_GT(share, last);
    EXPECT_LT(share, 1.0);
    last = share;
  }
  EXPECT_GT(last, 0.88);
}

TEST(TiltBias, DoesNotDependOnWhereNorthIs) {
  const double turn = 0.9;
  const Vec2 ground(0.2, -0.1);
  const Vec2 b = after_turning(3.0, ground, kTilt).slope_H();
  const Vec2 turned = after_turning(3.0, rot2(turn) * ground, kTilt, turn).slope_H();
  EXPECT_LT(distance(b, turned), 1e-15);
}

TEST(TiltBias, NoiseOfThePlaneWhileStandingMovesItLittle) {
  std::mt19937 generator(1);
  std::normal_distribution<double> noise(0.0, 3e-3);
  TiltBias bias(kTime);
  for (int i = 0; i < 10000; ++i) {
    const double x = noise(generator), y = noise(generator);
    bias.update(Vec2(0.27 + x, y), 0.3, kTick);
  }
  EXPECT_LT(bias.slope_H().norm(), 1e-12);
}

/// Gradient of the ground as a robot of attitude R_seen on four feet sees it.
Vec2 seen_gradient(const Vec3& n_W, double yaw, const Vec3& error_B, Mat3& R_seen, Mat3& R_true) {
  const TerrainPlane truth{.a0 = 0.0, .a1 = -n_W.x() / n_W.z(), .a2 = -n_W.y() / n_W.z()};
  R_true = rotation_from_rpy(terrain_aligned_rpy(truth, yaw));
  R_seen = R_true * exp_so3(error_B);
  PerLeg<Vec3> feet_W;
  for (const Leg leg : kLegs) {
    const Vec3 p_BF(fore_sign(leg) * 0.19, side_sign(leg) * 0.11,
                    -0.27);  // a plane below the trunk
    feet_W[leg] = R_seen * p_BF;
  }
  const std::array<double, kLegCount> weights = {1.0, 1.0, 1.0, 1.0};
  const TerrainPlane seen = fit_plane(feet_W.values, weights, {}, 1e-6, 0.0);
  return {seen.a1, seen.a2};
}

TEST(TiltBias, ItsRotationUndoesAnErrorOfTheAttitude) {
  const Vec3 error_B(3e-3, -2e-3, 0.0);
  for (const Vec3& n_W : {Vec3(0.0, 0.0, 1.0), Vec3(-0.17, 0.05, 1.0)}) {
    TiltBias bias(kTime);
    Mat3 R_seen, R_true;
    const int ticks = static_cast<int>(std::lround(10.0 * 2.0 * kPi / (kRate * kTick)));
    for (int i = 0; i < ticks; ++i) {
      const double yaw = i * kRate * kTick;
      bias.update(seen_gradient(n_W, yaw, error_B, R_seen, R_true), yaw, kTick);
    }
    const double before = log_so3(R_true.transpose() * R_seen).head<2>().norm();
    const Mat3 corrected = R_seen * exp_so3(-bias.rotation_B());
    const double after = log_so3(R_true.transpose() * corrected).head<2>().norm();
    // A tenth is left by the prior, and on the slope its cosine squared turns into the rest.
    EXPECT_LT(after, 0.13 * before);
  }
}

TEST(TiltBias, CorrectsNoMoreThanAnAccelerometerCanBeWrong) {
  const TiltBias bias = after_turning(20.0, Vec2::Zero(), Vec2(0.3, 0.4));
  EXPECT_NEAR(bias.rotation_B().norm(), 0.02, 1e-12);
  EXPECT_EQ(bias.rotation_B().z(), 0.0);
}

TEST(TiltBias, CanBeSwitchedOffAndForgets) {
  TiltBias off(0.0);
  for (int i = 0; i < 10000; ++i) off.update(rot2(i * 1e-3) * kTilt, i * 1e-3, kTick);
  EXPECT_EQ(off.slope_H(), Vec2::Zero());
  TiltBias bias = after_turning(10.0, Vec2::Zero(), kTilt);
  bias.reset();
  EXPECT_EQ(bias.slope_H(), Vec2::Zero());
}

}  // namespace
}  // namespace pirouette
