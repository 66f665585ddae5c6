#include "pirouette/plant/sensors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pirouette/base/rotation.hpp"
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

TEST(Sensors, KeepTheDensityOfTheInertialNoiseAtAnyRate) {
  SensorConfig config;
  config.accelerometer_bias = config.gyro_bias = 0.0;
  PlantTruth truth;
  truth.a_WB_W.z() = -kGravity;  // free fall: the accelerometer shows its noise
  const SensorReading nominal = Sensors(config, 1, 0.002).sample(truth, {});
  const SensorReading slow = Sensors(config, 1, 0.008).sample(truth, {});
  EXPECT_NEAR(slow.w_WB_B.norm() / nominal.w_WB_B.norm(), 0.5, 1e-12);
  EXPECT_NEAR(slow.specific_force_B.norm() / nominal.specific_force_B.norm(), 0.5, 1e-12);
  EXPECT_EQ(slow.joint_position[Leg::kFR], nominal.joint_position[Leg::kFR]);
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

/// Contact flags of a foot that touches down at 0.1 s, at 500 Hz for 1 s.
std::vector<bool> flags_of_a_touchdown(const SensorConfig& config, std::uint64_t seed = 1) {
  Sensors sensors(config, seed, kTick);
  std::vector<bool> flags;
  for (int tick = 0; tick < 500; ++tick) {
    PlantTruth truth;
    truth.time = tick * kTick;
    PerLeg<double> force{};
    force[Leg::kFL] = tick >= 50 ? 20.0 : 0.0;
    flags.push_back((*sensors.sample(truth, force).foot_contact)[Leg::kFL]);
  }
  return flags;
}

TEST(ContactFlags, AreAsLateAsConfigured) {
  for (const auto& [delay, ticks] : {std::pair(0.0, 0), {0.01, 5}, {0.011, 6}}) {
    SensorConfig config;
    config.contact_delay = delay;
    const std::vector<bool> flags = flags_of_a_touchdown(config);
    const auto first = std::find(flags.begin(), flags.end(), true) - flags.begin();
    EXPECT_EQ(first, 50 + ticks) << delay;
  }
}

TEST(ContactFlags, AreWrongAsOftenAsConfigured) {
  SensorConfig config;
  const std::vector<bool> right = flags_of_a_touchdown(config);
  config.contact_error = 0.02;
  int wrong = 0, samples = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::vector<bool> flags = flags_of_a_touchdown(config, seed);
    for (std::size_t i = 0; i < flags.size(); ++i, ++samples) wrong += flags[i] != right[i] ? 1 : 0;
  }
  // Four standard errors of a share p of n draws: 4 sqrt(p (1 - p) / n).
  const double share = static_cast<double>(wrong) / samples;
  EXPECT_NEAR(share, 0.02, 4.0 * std::sqrt(0.02 * 0.98 / samples));
  EXPECT_EQ(flags_of_a_touchdown(config, 7), flags_of_a_touchdown(config, 7));
  config.ideal = true;
  EXPECT_EQ(flags_of_a_touchdown(config), right);
}

/// What the position aid says of a trunk that walks along x at 1 m/s, tick by tick at 500 Hz.
std::vector<std::optional<PositionAid>> aid_of_a_walk(const SensorConfig& config, double duration) {
  Sensors sensors(config, 3, kTick);
  std::vector<std::optional<PositionAid>> aids;
  for (int tick = 0; tick * kTick < duration; ++tick) {
    PlantTruth truth;
    truth.time = tick * kTick;
    truth.base.p_WB = Vec3(truth.time, 0.2, 0.3);
    truth.base.R_WB = rot_z(3.1);
    aids.push_back(sensors.sample(truth, {}).aid);
  }
  return aids;
}

SensorConfig exact_aid() {
  SensorConfig config;
  config.aid_rate = 10.0;
  config.aid_noise = config.aid_yaw_noise = 0.0;
  return config;
}

TEST(PositionAid, IsAbsentUnlessAskedFor) {
  for (const auto& aid : aid_of_a_walk(SensorConfig{}, 1.0)) EXPECT_FALSE(aid);
}

TEST(PositionAid, ArrivesAtItsRateAndSaysWhereTheTrunkWasWhenItMeasured) {
  SensorConfig config = exact_aid();
  config.aid_delay = 0.25;  // longer than its period
  const auto aids = aid_of_a_walk(config, 1.0);
  std::vector<double> arrivals;
  for (std::size_t tick = 0; tick < aids.size(); ++tick) {
    if (!aids[tick]) continue;
    const double now = static_cast<double>(tick) * kTick;
    arrivals.push_back(now);
    EXPECT_NEAR(aids[tick]->time, now - 0.25, 0.5 * kTick);
    EXPECT_EQ(aids[tick]->p_WB, Vec3(aids[tick]->time, 0.2, 0.3));
    EXPECT_NEAR(aids[tick]->yaw, 3.1, 1e-12);
  }
  ASSERT_EQ(arrivals.size(), 8U);  // those measured at 0, 0.1, ... 0.7 s
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    EXPECT_NEAR(arrivals[i], 0.25 + 0.1 * static_cast<double>(i), 1e-9 + 0.5 * kTick);
  }
}

TEST(PositionAid, HasTheConfiguredNoiseGapsAndEnd) {
  SensorConfig config = exact_aid();
  config.aid_rate = 500.0;
  config.aid_noise = 0.005;
  config.aid_yaw_noise = 0.01;
  config.aid_dropout = 0.3;
  config.aid_lost_after = 20.0;
  int count = 0;
  double position = 0.0, yaw = 0.0;
  for (const auto& aid : aid_of_a_walk(config, 30.0)) {
    if (!aid) continue;
    EXPECT_LE(aid->time, 20.0);
    ++count;
    position += (aid->p_WB - Vec3(aid->time, 0.2, 0.3)).squaredNorm() / 3.0;
    yaw += square(wrap_angle(aid->yaw - 3.1));
  }
  // Four standard errors each: of a share, and of standard deviations.
  constexpr double kMeasured = 10000.0;
  EXPECT_NEAR(count / kMeasured, 0.7, 4.0 * std::sqrt(0.3 * 0.7 / kMeasured));
  EXPECT_NEAR(std::sqrt(position / count) / 0.005, 1.0, 4.0 / std::sqrt(6.0 * count));
  EXPECT_NEAR(std::sqrt(yaw / count) / 0.01, 1.0, 4.0 / std::sqrt(2.0 * count));
}

TEST(Sensors, HaveTheSameNoiseWithContactErrorsAndAPositionAidAsWithout) {
  Config config = ideal_config();
  config.plant.sensors.ideal = false;
  Plant plain = make_plant(config);
  config.plant.sensors.contact_error = 0.1;
  config.plant.sensors.aid_rate = 100.0;
  Plant aided = make_plant(config);
  for (int i = 0; i < 20; ++i) {
    const SensorReading a = plain.sense(), b = aided.sense();
    EXPECT_EQ(a.joint_velocity[Leg::kRR], b.joint_velocity[Leg::kRR]);
    EXPECT_EQ(a.w_WB_B, b.w_WB_B);
    plain.advance(JointCommand{});
    aided.advance(JointCommand{});
  }
}

}  // namespace
}  // namespace pirouette
