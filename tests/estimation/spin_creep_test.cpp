#include "pirouette/estimation/spin_creep.hpp"

#include <gtest/gtest.h>

#include "pirouette/base/rotation.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kTick = 0.002;
constexpr double kFriction = 0.8, kTorsion = 0.005;  // mu, mu_t (m) of the ground

CreepConfig configured(CreepModelMode mode) {
  CreepConfig config;
  config.mode = mode;
  config.calibrated_friction = kFriction;
  config.calibrated_torsion = kTorsion;
  return config;
}

/// Normal of a slope of `angle` (rad) that climbs towards `uphill` (rad).
Vec3 normal(double angle, double uphill = 0.0) {
  return rot_z(uphill) * rot_y(-angle) * Vec3::UnitZ();
}

/// Share of its torsional friction that a foot keeps on the slope.
double cone(double angle) { return std::sqrt(1.0 - square(std::tan(angle) / kFriction)); }

/// What the stance forces of a steady spin show: mean yaw moment m N with m = mu_t cone.
CreepInput spinning_on(const Vec3& n_W, double moment_per_force, double rate = 0.7) {
  CreepInput in;
  in.n_W = n_W;
  in.twist_rate = rate;
  in.normal_force = 87.0;
  in.yaw_moment = std::copysign(moment_per_force * in.normal_force, rate);
  return in;
}

CreepEstimate settled(const CreepConfig& config, const CreepInput& in) {
  SpinCreep creep(config);
  CreepEstimate out;
  const int ticks = static_cast<int>(20.0 * config.averaging_time / kTick);
  for (int i = 0; i < ticks; ++i) out = creep.update(in, kTick);
  return out;
}

TEST(SpinCreep, StoredCalibrationGivesTheSlipOfTheEllipticCone) {
  for (const double angle : {0.1, 0.26, 0.5}) {
    const CreepInput in = spinning_on(normal(angle), kTorsion * cone(angle));
    const CreepEstimate out = SpinCreep(configured(CreepModelMode::kStored)).update(in, kTick);
    const double k = kTorsion / (square(kFriction) * cone(angle));
    EXPECT_NEAR(out.coefficient, k, 1e-15);
    EXPECT_NEAR(out.slip_per_twist_W.norm(), k * std::tan(angle), 1e-15);
  }
}

// Friction acts against the slip in the plane of (velocity, radius of gyration times twist), scaled
// by the ellipse's axes: the slip of SpinCreep must be normal to the cone f_t^2/mu^2 + m^2/mu_t^2.
TEST(SpinCreep, SlipAndTwistAreNormalToTheFrictionCone) {
  const double angle = 0.4, twist = 1.0;
  const CreepEstimate out =
      SpinCreep(configured(CreepModelMode::kStored)).update(spinning_on(normal(angle), 0.0), kTick);
  const double force = std::tan(angle);  // per normal force
  const double moment = kTorsion * std::sqrt(1.0 - square(force / kFriction));
  ASSERT_NEAR(square(force / kFriction) + square(moment / kTorsion), 1.0, 1e-14);
  const Vec2 gradient(force / square(kFriction), moment / square(kTorsion));
  const Vec2 slip(twist * out.slip_per_twist_W.norm(), twist);
  EXPECT_NEAR(gradient.x() * slip.y() - gradient.y() * slip.x(), 0.0, 1e-12 * gradient.norm());
}

TEST(SpinCreep, PointsStraightDownTheSlopeWhateverItsDirection) {
  const double angle = 0.3;
  const SpinCreep creep(configured(CreepModelMode::kStored));
  const Vec3 along_x =
      SpinCreep(creep).update(spinning_on(normal(angle), 0.0), kTick).slip_per_twist_W;
  EXPECT_LT(along_x.x(), 0.0);
  EXPECT_LT(along_x.z(), 0.0);
  EXPECT_EQ(along_x.y(), 0.0);
  for (const double uphill : {0.7, 2.0, -1.3}) {
    const Vec3 n_W = normal(angle, uphill);
    const Vec3 slip = SpinCreep(creep).update(spinning_on(n_W, 0.0), kTick).slip_per_twist_W;
    EXPECT_LT(distance(slip, rot_z(uphill) * along_x), 1e-16);
    EXPECT_NEAR(slip.dot(n_W), 0.0, 1e-17);
  }
}

TEST(SpinCreep, NothingSlipsOnTheLevelOrWhenSwitchedOff) {
  const CreepInput level = spinning_on(Vec3::UnitZ(), kTorsion);
  EXPECT_EQ(settled(configured(CreepModelMode::kOnline), level).slip_per_twist_W, Vec3::Zero());
  const CreepInput steep = spinning_on(normal(0.4), kTorsion);
  EXPECT_EQ(settled(configured(CreepModelMode::kOff), steep).slip_per_twist_W, Vec3::Zero());
}

TEST(SpinCreep, OnlineFindsTheCoefficientFromMomentAndKnownFriction) {
  for (const double torsion : {0.002, 0.005, 0.02}) {
    for (const double rate : {0.7, -2.0}) {
      const double angle = 0.26;
      const CreepInput in = spinning_on(normal(angle), torsion * cone(angle), rate);
      const CreepEstimate out = settled(configured(CreepModelMode::kOnline), in);
      // What is left of the prior after 20 time constants: 2e-9.
      EXPECT_NEAR(out.torsional_friction, torsion * cone(angle), 1e-8);
      EXPECT_NEAR(out.coefficient, torsion / (square(kFriction) * cone(angle)), 1e-8);
    }
  }
}

TEST(SpinCreep, PatchRatioMakesTheSlidingFrictionUnnecessary) {
  const double angle = 0.26;
  CreepConfig config = configured(CreepModelMode::kOnline);
  config.patch_ratio = kTorsion / kFriction;
  config.calibrated_friction = 0.3;  // wrong, and not used
  const CreepInput in = spinning_on(normal(angle), kTorsion * cone(angle));
  EXPECT_NEAR(settled(config, in).coefficient, kTorsion / (square(kFriction) * cone(angle)), 1e-8);
}

TEST(SpinCreep, BothCalibrationsAgreeWhenBothAreRight) {
  const CreepInput in = spinning_on(normal(0.35), kTorsion * cone(0.35));
  CreepConfig patch = configured(CreepModelMode::kOnline);
  patch.patch_ratio = kTorsion / kFriction;
  const double stored = settled(configured(CreepModelMode::kStored), in).coefficient;
  EXPECT_NEAR(settled(patch, in).coefficient, stored, 1e-8);
  EXPECT_NEAR(settled(configured(CreepModelMode::kOnline), in).coefficient, stored, 1e-8);
}

TEST(SpinCreep, PriorHoldsUntilTheFeetHaveTwisted) {
  CreepConfig config = configured(CreepModelMode::kOnline);
  CreepInput in = spinning_on(normal(0.2), 0.02);
  in.twist_rate = 0.05;  // the feet may stick: their moment says nothing
  EXPECT_NEAR(settled(config, in).torsional_friction, config.calibrated_torsion, 1e-15);

  SpinCreep creep(config);
  in.twist_rate = 0.7;
  CreepEstimate out;
  const int ticks = static_cast<int>(std::lround(config.averaging_time / kTick));
  for (int i = 0; i < ticks; ++i) out = creep.update(in, kTick);
  // After one time constant, moment and force weighed by what they were: prior 100 N, then 87 N.
  const double old = std::exp(-1.0) * 100.0, seen = (1.0 - std::exp(-1.0)) * 87.0;
  EXPECT_NEAR(out.torsional_friction,
              (old * config.calibrated_torsion + seen * 0.02) / (old + seen), 1e-12);
}

TEST(SpinCreep, OnlineEstimateStaysBoundedWhateverTheForcesSay) {
  CreepConfig config = configured(CreepModelMode::kOnline);
  for (const double bound : {0.03, 0.0}) {
    config.max_torsional_friction = bound;
    for (const double moment : {10.0, -10.0}) {
      for (const double patch_ratio : {0.0, 0.0063}) {
        config.patch_ratio = patch_ratio;
        const CreepEstimate out = settled(config, spinning_on(normal(0.6), moment));
        EXPECT_GE(out.coefficient, 0.0);
        EXPECT_LE(out.coefficient, 0.15);
        EXPECT_TRUE(out.slip_per_twist_W.allFinite());
      }
    }
  }
  config.max_torsional_friction = 0.03;
  config.patch_ratio = 0.0;
  EXPECT_NEAR(settled(config, spinning_on(normal(0.0), 10.0)).coefficient, 0.03 / square(kFriction),
              1e-12);
}

TEST(SpinCreep, SlopesBeyondTheFrictionConeStayFinite) {
  const CreepEstimate out =
      settled(configured(CreepModelMode::kStored), spinning_on(normal(0.9), 0.0));
  EXPECT_TRUE(out.slip_per_twist_W.allFinite());
  EXPECT_GT(out.coefficient, kTorsion / square(kFriction));
}

TEST(SpinCreep, ForgetsOnReset) {
  SpinCreep creep(configured(CreepModelMode::kOnline));
  const CreepInput in = spinning_on(normal(0.2), 0.02);
  const CreepEstimate first = creep.update(in, kTick);
  for (int i = 0; i < 1000; ++i) creep.update(in, kTick);
  creep.reset();
  EXPECT_EQ(creep.update(in, kTick).coefficient, first.coefficient);
}

}  // namespace
}  // namespace pirouette
