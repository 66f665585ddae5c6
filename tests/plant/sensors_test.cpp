#include "pirouette/plant/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/mini_cheetah.hpp"

namespace pirouette {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

TEST(Sensors, FeelNoSpecificForceInFreeFall) {
  Plant plant = make_plant(ideal_config());
  plant.push(Vec3(0.0, 0.0, 1.0));  // jumps
  for (int i = 0; i < 20; ++i) plant.advance(JointCommand{});
  for (const bool contact : plant.truth().contact) ASSERT_FALSE(contact);
  // The legs hang loose, so that the trunk falls like a stone, but for the joints' friction.
  EXPECT_NEAR(plant.sense().specific_force_B.norm(), 0.0, 0.05);
  EXPECT_NEAR((plant.truth().a_WB_W - Vec3(0.0, 0.0, -kGravity)).norm(), 0.0, 0.05);
  EXPECT_NEAR(plant.truth().v_WG_W.z(), 1.0 - kGravity * 20 * kTick, 1e-6);
}

TEST(Sensors, FeelGravityUpwardsAtRest) {
  for (const char* terrain : {"flat", "slope:15"}) {
    Plant plant = make_plant(ideal_config(terrain), Vec2::Zero(), 0.4);
    stand(plant, 3.0);
    const SensorReading reading = plant.sense();
    const Vec3 up_B = plant.truth().base.R_WB.transpose() * Vec3::UnitZ();
    EXPECT_NEAR((reading.specific_force_B - kGravity * up_B).norm(), 0.0, 0.05) << terrain;
    EXPECT_NEAR(reading.w_WB_B.norm(), 0.0, 2e-3) << terrain;
    ASSERT_TRUE(reading.foot_contact.has_value());
    for (const bool contact : *reading.foot_contact) EXPECT_TRUE(contact);
  }
}

TEST(Sensors, ShowTheTruthOnlyToAControllerConfiguredForIt) {
  Config config = ideal_config();
  EXPECT_FALSE(make_plant(config).sense().truth.has_value());
  config.estimation.source = EstimatorSource::kTruth;
  Plant plant = make_plant(config);
  EXPECT_EQ(plant.sense().truth->p_WB, plant.truth().base.p_WB);
}

TEST(Sensors, ReportContactAboveTheThreshold) {
  Config config = ideal_config();
  config.plant.sensors.contact_threshold = 15.0;
  Plant plant = make_plant(config);
  stand(plant, 1.0);
  for (const Leg leg : kLegs) {
    EXPECT_EQ((*plant.sense().foot_contact)[leg], plant.truth().f_W[leg].z() > 15.0);
    EXPECT_TRUE(plant.truth().contact[leg]);
  }
  config.plant.sensors.contact_threshold = 500.0;
  Plant numb = make_plant(config);
  stand(numb, 0.1);
  const SensorReading numb_reading = numb.sense();
  for (const bool contact : *numb_reading.foot_contact) EXPECT_FALSE(contact);
  config.plant.sensors.contact_flags = false;
  EXPECT_FALSE(make_plant(config).sense().foot_contact.has_value());
}

TEST(Sensors, HaveTheConfiguredNoiseAndAConstantBias) {
  Config config = ideal_config();
  config.plant.sensors.ideal = false;
  Plant plant = make_plant(config);
  Plant ideal = make_plant(ideal_config());
  const SensorReading clean = ideal.sense();

  constexpr int kSamples = 4000;
  double encoder = 0.0, velocity = 0.0, force = 0.0, gyro = 0.0;
  Vec3 force_mean = Vec3::Zero(), gyro_mean = Vec3::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const SensorReading noisy = plant.sense();
    for (const Leg leg : kLegs) {
      encoder += (noisy.joint_position[leg] - clean.joint_position[leg]).squaredNorm() / 12.0;
      velocity += (noisy.joint_velocity[leg] - clean.joint_velocity[leg]).squaredNorm() / 12.0;
    }
    const Vec3 force_error = noisy.specific_force_B - clean.specific_force_B;
    const Vec3 gyro_error = noisy.w_WB_B - clean.w_WB_B;
    force += force_error.squaredNorm();
    gyro += gyro_error.squaredNorm();
    force_mean += force_error / kSamples;
    gyro_mean += gyro_error / kSamples;
  }
  const auto deviation = [](double squares, const Vec3& mean) {
    return std::sqrt((squares / kSamples - mean.squaredNorm()) / 3.0);
  };
  // Four standard errors of a standard deviation: 4 / sqrt(2 n) with n draws.
  EXPECT_NEAR(std::sqrt(encoder / kSamples) / 5e-4, 1.0, 4.0 / std::sqrt(24.0 * kSamples));
  EXPECT_NEAR(std::sqrt(velocity / kSamples) / 0.025, 1.0, 4.0 / std::sqrt(24.0 * kSamples));
  EXPECT_NEAR(deviation(force, force_mean) / 0.05, 1.0, 4.0 / std::sqrt(6.0 * kSamples));
  EXPECT_NEAR(deviation(gyro, gyro_mean) / 0.005, 1.0, 4.0 / std::sqrt(6.0 * kSamples));
  // A bias is there, and of its order.
  EXPECT_GT(force_mean.norm(), 0.004);
  EXPECT_LT(force_mean.norm(), 0.08);
  EXPECT_LT(gyro_mean.norm(), 8e-4);
}

TEST(Sensors, FollowTheSeed) {
  Config config = ideal_config();
  config.plant.sensors.ideal = false;
  const auto run = [&](std::int64_t seed) {
    config.run.seed = seed;
    Plant plant = make_plant(config);
    stand(plant, 0.1);
    return plant.sense();
  };
  const SensorReading first = run(5), again = run(5), other = run(6);
  EXPECT_EQ(first.specific_force_B, again.specific_force_B);
  EXPECT_EQ(first.joint_velocity[Leg::kRL], again.joint_velocity[Leg::kRL]);
  EXPECT_NE(first.specific_force_B, other.specific_force_B);
  EXPECT_NE(first.w_WB_B, other.w_WB_B);
}

}  // namespace
}  // namespace pirouette
