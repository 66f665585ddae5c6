#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "pirouette/base/rotation.hpp"
#include "pirouette/metrics/motion_metrics.hpp"
#include "support/synthetic_motion.hpp"

namespace pirouette {
namespace {

using test::kRate;
using test::kYawRate;
using test::measure;
using test::Motion;
using test::synthetic_spin;

constexpr double kSampling = 0.01;  // mm or mm/s: a whole number of samples is not quite a turn

TEST(Metrics, ACleanSpinOnThePointIsCleanInEveryNumber) {
  const Vec2 point(0.3, -0.2);
  const Metrics m = measure(synthetic_spin(8.0, point, Vec2::Zero(), 0.0),
                            {point, Vec2::Zero(), kYawRate}, kRate);
  EXPECT_NEAR(m.turns_done, 8.0, 1e-3);
  EXPECT_NEAR(*m.yaw_rate_mean, kYawRate, 1e-9);
  EXPECT_NEAR(*m.yaw_rate_error, 0.0, 1e-9);
  EXPECT_NEAR(*m.com.distance_to_point_max_mm, 0.0, 1e-9);
  EXPECT_NEAR(*m.com.radius_max_mm, 0.0, 1e-9);
  EXPECT_NEAR(*m.com.drift_per_turn_mm, 0.0, 1e-9);
  EXPECT_NEAR(*m.com.body_bias_mm_s, 0.0, 1e-9);
  EXPECT_FALSE(m.com.circle_radius_mm) << "a single point is no circle";
}

TEST(Metrics, ABodyFixedBiasDrawsACircleOfItsSizeOverTheYawRate) {
  const Vec2 point(0.1, 0.0);
  const Vec2 bias(0.012, -0.005);
  for (const double yaw_rate : {kYawRate, -kYawRate}) {
    const Metrics m = measure(synthetic_spin(8.0, point, bias, 0.0, yaw_rate),
                              {point, Vec2::Zero(), yaw_rate}, kRate);
    const double radius = bias.norm() / kYawRate * 1e3;
    EXPECT_NEAR(m.turns_done, 8.0, 1e-3);
    EXPECT_NEAR(*m.yaw_rate_error, 0.0, 1e-9);
    EXPECT_NEAR(*m.com.body_bias_x_mm_s, 12.0, 1e-9);
    EXPECT_NEAR(*m.com.body_bias_y_mm_s, -5.0, 1e-9);
    EXPECT_NEAR(*m.com.body_bias_mm_s, 13.0, 1e-9);
    EXPECT_NEAR(*m.com.radius_mean_mm, radius, kSampling);
    EXPECT_NEAR(*m.com.circle_radius_mm, radius, 1e-9);
    EXPECT_NEAR(*m.com.circle_variance_mm2, 0.0, 1e-9);
    EXPECT_NEAR(*m.com.circle_centre_x_mm, 0.0, 1e-9);
    EXPECT_NEAR(*m.com.distance_to_point_mean_mm, radius, 1e-9);
    EXPECT_NEAR(*m.com.distance_to_point_p95_mm, radius, 1e-9);
    EXPECT_NEAR(*m.com.peak_to_peak_x_mm, 2.0 * radius, kSampling);
    EXPECT_NEAR(*m.com.peak_to_peak_y_mm, 2.0 * radius, kSampling);
    EXPECT_NEAR(*m.com.drift_per_turn_mm, 0.0, kSampling);
  }
}

TEST(Metrics, RadiusIsAboutTheMeanPointAndDistanceAboutTheCommandedOne) {
  const Metrics m = measure(synthetic_spin(8.0, Vec2(0.03, 0.04), Vec2(0.0007, 0.0), 0.0),
                            {Vec2::Zero(), Vec2::Zero(), kYawRate}, kRate);
  EXPECT_NEAR(*m.com.radius_mean_mm, 1.0, kSampling);
  EXPECT_NEAR(*m.com.distance_to_point_mean_mm, 50.0, 0.02);
  EXPECT_NEAR(*m.com.circle_centre_x_mm, 30.0, 1e-6);
  EXPECT_NEAR(*m.com.circle_centre_y_mm, 40.0, 1e-6);
}

TEST(Metrics, DriftIsTheSameWhateverTheNumberOfTurns) {
  for (const double turns : {2.1, 3.0, 8.0}) {
    const Metrics m = measure(synthetic_spin(turns, Vec2::Zero(), Vec2(0.01, 0.0), 0.005),
                              {Vec2::Zero(), Vec2::Zero(), kYawRate}, kRate);
    EXPECT_NEAR(*m.com.drift_per_turn_mm, 5.0, kSampling) << turns << " turns";
  }
}

TEST(Metrics, DistanceToTheAverageIsTheRadiusWhereverTheCircleDrifts) {
  const Vec2 bias(0.012, -0.005);
  for (const double yaw_rate : {kYawRate, -kYawRate}) {
    const Metrics m = measure(synthetic_spin(5.0, Vec2(0.3, 0.1), bias, 0.02, yaw_rate),
                              {Vec2::Zero(), Vec2::Zero(), yaw_rate}, kRate);
    EXPECT_NEAR(*m.com.distance_to_average_mean_mm, bias.norm() / kYawRate * 1e3, kSampling);
    EXPECT_GT(*m.com.radius_mean_mm, 1.5 * *m.com.distance_to_average_mean_mm);
  }
}

TEST(Metrics, DistanceToTheAverageNeedsATurn) {
  const auto distance = [](double turns) {
    return measure(synthetic_spin(turns, Vec2::Zero(), Vec2(0.01, 0.0), 0.0), {}, kRate)
        .com.distance_to_average_mean_mm;
  };
  EXPECT_FALSE(distance(0.9));
  EXPECT_TRUE(distance(1.1));
}

TEST(Metrics, DriftNeedsTwoTurns) {
  const Metrics m = measure(synthetic_spin(1.9, Vec2::Zero(), Vec2::Zero(), 0.005), {}, kRate);
  EXPECT_FALSE(m.com.drift_per_turn_mm);
  EXPECT_FALSE(m.estimator.position_drift_per_turn_mm);
}

TEST(Metrics, WhatARobotThatHardlyTurnsCannotTellIsAbsent) {
  const Metrics still = measure(synthetic_spin(0.4, Vec2::Zero(), Vec2(0.01, 0.0), 0.0),
                                {Vec2::Zero(), Vec2::Zero(), 1e-6}, kRate);
  EXPECT_FALSE(still.com.bias_circle_mm);
  EXPECT_FALSE(still.com.circle_radius_mm) << "less than half of the circle";
  EXPECT_FALSE(still.yaw_rate_error) << "relative to next to nothing";
  EXPECT_TRUE(still.com.body_bias_mm_s);
  const Metrics turns = measure(synthetic_spin(0.6, Vec2::Zero(), Vec2(0.01, 0.0), 0.0),
                                {Vec2::Zero(), Vec2::Zero(), kYawRate}, kRate);
  EXPECT_TRUE(turns.com.bias_circle_mm);
  EXPECT_TRUE(turns.com.circle_radius_mm);
  EXPECT_TRUE(turns.yaw_rate_error);
}

TEST(Metrics, AStraightLineHasNoCircle) {
  Motion motion;
  for (int i = 0; i < 5000; ++i) {
    MotionSample sample;
    sample.time = i / kRate;
    sample.p_WG = Vec2(0.2 * sample.time, 1e-3 * std::sin(3.0 * sample.time));
    motion.push_back(sample);
  }
  const Metrics m = measure(motion, {Vec2::Zero(), Vec2(0.2, 0.0)}, kRate);
  EXPECT_FALSE(m.com.circle_radius_mm);
  EXPECT_FALSE(m.com.circle_centre_x_mm);
  EXPECT_TRUE(m.com.radius_mean_mm);
}

TEST(Metrics, TurningTheWrongWayCountsNegative) {
  const Metrics m = measure(synthetic_spin(3.0, Vec2::Zero(), Vec2::Zero(), 0.0, -kYawRate),
                            {Vec2::Zero(), Vec2::Zero(), kYawRate}, kRate);
  EXPECT_NEAR(m.turns_done, -3.0, 1e-3);
  EXPECT_NEAR(*m.yaw_rate_error, -2.0, 1e-9);
}

TEST(Metrics, AttitudeAndAccelerationsHaveTheirClosedForms) {
  constexpr double kAmplitude = 0.02;
  const Metrics m =
      measure(synthetic_spin(8.0, Vec2::Zero(), Vec2::Zero(), 0.0, kYawRate, kAmplitude),
              {Vec2::Zero(), Vec2::Zero(), kYawRate}, kRate);
  constexpr double kFewPermille = 5e-3;  // the record is not a whole number of swings
  EXPECT_NEAR(*m.attitude.roll_variance, square(kAmplitude) / 2.0,
              kFewPermille * square(kAmplitude));
  EXPECT_NEAR(*m.attitude.pitch_mean, -0.01, 1e-9);
  EXPECT_NEAR(*m.attitude.pitch_variance, 0.0, 1e-12);
  // 2 Hz lies far below the cut-off: gain 1 - 1e-4.
  EXPECT_NEAR(*m.acceleration.x_variance, square(0.3) / 2.0, kFewPermille * square(0.3));
  EXPECT_NEAR(*m.acceleration.y_variance, 0.0, 1e-12);
  const double roll_acceleration = kAmplitude * square(4.0 * kPi);
  EXPECT_NEAR(*m.acceleration.roll_variance, square(roll_acceleration) / 2.0,
              kFewPermille * square(roll_acceleration));
}

TEST(Metrics, EstimatorErrorIsHorizontalAndIgnoresTheYawsBranch) {
  const Metrics m = measure(synthetic_spin(1.0, Vec2::Zero(), Vec2::Zero(), 0.0),
                            {Vec2::Zero(), Vec2::Zero(), kYawRate}, kRate);
  EXPECT_NEAR(*m.estimator.position_error_mm, 5.0, 1e-9);
  EXPECT_NEAR(*m.estimator.yaw_error_rad, 0.02, 1e-9);
}

TEST(Metrics, EstimatorDriftIsThatOfItsErrorWhateverTheRobotDoes) {
  Motion record = synthetic_spin(5.0, Vec2::Zero(), Vec2(0.01, 0.0), 0.02);
  for (MotionSample& sample : record) {
    const double turns = (sample.yaw - record.front().yaw) / (2.0 * kPi);
    sample.position_error = turns * Vec2(0.003, -0.004) + rot2(sample.yaw) * Vec2(0.001, 0.0);
  }
  const Metrics m = measure(record, {Vec2::Zero(), Vec2::Zero(), kYawRate}, kRate);
  EXPECT_NEAR(*m.estimator.position_drift_per_turn_mm, 5.0, kSampling);
}

TEST(Metrics, RelativeAttitudeIsConstantForATrunkThatKeepsItsLeanFromASlope) {
  const Vec3 normal(-std::sin(radians(10.0)), 0.0, std::cos(radians(10.0)));
  const Mat3 R_WT = Quat::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
  const RollPitchYaw lean{0.02, -0.03, 0.0};
  Motion record;
  for (int i = 0; i < 1000; ++i) {
    PlantTruth truth;
    truth.ground_normal_W = normal;
    truth.base.R_WB = R_WT * rot_z(0.02 * i) * rotation_from_rpy(lean);
    record.push_back(motion_sample(truth, 0.02 * i, RobotState{}, 0.0));
  }
  const AttitudeMetrics attitude = measure(record, {}, kRate).attitude;
  EXPECT_NEAR(*attitude.relative_roll_mean, lean.roll, 1e-12);
  EXPECT_NEAR(*attitude.relative_pitch_mean, lean.pitch, 1e-12);
  EXPECT_NEAR(*attitude.relative_roll_variance, 0.0, 1e-20);
  EXPECT_NEAR(*attitude.relative_pitch_variance, 0.0, 1e-20);
  EXPECT_GT(*attitude.roll_variance, 0.01);  // half of the square of 10 degrees: 0.015
}

TEST(Metrics, RelativeAttitudeOnTheFlatIsTheAttitude) {
  const AttitudeMetrics attitude =
      measure(synthetic_spin(2.0, Vec2::Zero(), Vec2::Zero(), 0.0, kYawRate, 0.02), {}, kRate)
          .attitude;
  EXPECT_NEAR(*attitude.relative_roll_variance, *attitude.roll_variance, 1e-12);
  EXPECT_NEAR(*attitude.relative_pitch_mean, *attitude.pitch_mean, 1e-12);
}

TEST(Metrics, SlipCountsTheFeetThatTouch) {
  Motion record;
  PlantTruth truth;
  truth.v_slip_W = PerLeg<Vec3>::filled(Vec3(1.0, 0.0, 0.0));  // in the air
  record.push_back(motion_sample(truth, 0.0, RobotState{}, 0.0));
  EXPECT_FALSE(measure(record, {}, kRate).contact.slip_mean_mm_s);
  truth.contact[Leg::kFR] = truth.contact[Leg::kRL] = true;
  truth.v_slip_W[Leg::kFR] = Vec3(0.003, 0.004, 0.0);
  truth.v_slip_W[Leg::kRL] = Vec3(0.0, 0.001, 0.0);
  record.push_back(motion_sample(truth, 0.0, RobotState{}, 0.0));
  EXPECT_NEAR(*measure(record, {}, kRate).contact.slip_mean_mm_s, 3.0, 1e-12);
}

TEST(Metrics, ATurnHasACircleButNoDistanceToAPoint) {
  const Vec2 velocity(0.35, 0.0);
  const Metrics m = measure(synthetic_spin(3.0, Vec2::Zero(), velocity, 0.0),
                            {Vec2::Zero(), velocity, kYawRate}, kRate);
  EXPECT_FALSE(m.com.distance_to_point_mean_mm);
  EXPECT_NEAR(*m.com.circle_radius_mm, 500.0, 1e-6);
  EXPECT_NEAR(*m.com.body_bias_mm_s, 0.0, 1e-9);
}

TEST(MetricsJson, HasTheAgreedKeysInTheirPlaces) {
  const auto json = nlohmann::json::parse(to_json(Metrics{}));
  const std::vector<std::string> keys = {"/fell",
                                         "/turns_done",
                                         "/yaw_rate_mean",
                                         "/yaw_rate_error",
                                         "/com/distance_to_point_mean_mm",
                                         "/com/distance_to_point_max_mm",
                                         "/com/radius_mean_mm",
                                         "/com/radius_max_mm",
                                         "/com/radius_variance_mm2",
                                         "/com/peak_to_peak_x_mm",
                                         "/com/peak_to_peak_y_mm",
                                         "/com/drift_per_turn_mm",
                                         "/com/distance_to_average_mean_mm",
                                         "/com/body_bias_mm_s",
                                         "/attitude/roll_mean",
                                         "/attitude/roll_variance",
                                         "/attitude/pitch_mean",
                                         "/attitude/pitch_variance",
                                         "/attitude/relative_roll_mean",
                                         "/attitude/relative_roll_variance",
                                         "/attitude/relative_pitch_mean",
                                         "/attitude/relative_pitch_variance",
                                         "/acceleration/x_variance",
                                         "/acceleration/y_variance",
                                         "/acceleration/roll_variance",
                                         "/acceleration/pitch_variance",
                                         "/estimator/position_error_mm",
                                         "/contact/slip_mean_mm_s",
                                         "/estimator/yaw_error_rad",
                                         "/estimator/position_drift_per_turn_mm",
                                         "/timing/tick_us_median",
                                         "/timing/tick_us_p99",
                                         "/timing/tick_us_max",
                                         "/timing/mpc_us_median",
                                         "/timing/wbc_us_median",
                                         "/timing/physics_step_us_median",
                                         "/timing/real_time_factor",
                                         "/context/robot",
                                         "/context/terrain",
                                         "/context/controller",
                                         "/context/estimator",
                                         "/context/reference",
                                         "/context/tracker",
                                         "/context/foot_model",
                                         "/context/com_planner",
                                         "/context/duty",
                                         "/context/period",
                                         "/context/torsional_friction",
                                         "/context/friction",
                                         "/context/seed",
                                         "/context/duration_s",
                                         "/context/mujoco",
                                         "/context/terrain_half_extent_m",
                                         "/context/terrain_pitch_m",
                                         "/context/commit"};
  for (const std::string& key : keys) {
    EXPECT_TRUE(json.contains(nlohmann::json::json_pointer(key))) << key;
  }
}

TEST(MetricsJson, WritesNullForWhatHasNoSensibleValue) {
  Metrics m = measure({}, {}, kRate);
  m.attitude.roll_mean = std::numeric_limits<double>::quiet_NaN();
  m.timing.real_time_factor = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(to_json(m));
  EXPECT_EQ(json.at("turns_done"), 0.0);
  EXPECT_TRUE(json.at("yaw_rate_mean").is_null());
  EXPECT_TRUE(json.at("attitude").at("roll_mean").is_null());
  EXPECT_TRUE(json.at("timing").at("real_time_factor").is_null());
  for (const auto& [key, value] : json.at("com").items()) EXPECT_TRUE(value.is_null()) << key;
}

TEST(MetricsJson, OfOneSampleHasMeansButNoVariances) {
  Motion record;
  record.push_back(motion_sample(PlantTruth{}, 0.0, RobotState{}, 0.0));
  const auto json = nlohmann::json::parse(to_json(measure(record, {}, kRate)));
  EXPECT_EQ(json.at("com").at("radius_mean_mm"), 0.0);
  EXPECT_TRUE(json.at("com").at("radius_variance_mm2").is_null());
  EXPECT_TRUE(json.at("acceleration").at("x_variance").is_null());
}

TEST(MetricsJson, SurvivesARobotPathThatIsNotUtf8) {
  Metrics m;
  m.context.robot = "caf\xe9.xml";
  EXPECT_TRUE(nlohmann::json::accept(to_json(m)));
}

TEST(Metrics, PathErrorsAreAcrossThePathAndAlongItFromWhereItIsDue) {
  constexpr double kAside = 0.004, kLate = 0.01, kSpeed = 0.2;
  const Vec2 start(0.3, -0.2);
  CommandedMotion commanded{start, Vec2(kSpeed, 0.0), 0.4};
  commanded.path = Path::circle(start, 0.5, 0.5);
  Motion record;
  for (int i = 0; i < 5000; ++i) {
    const double due = kSpeed * i / kRate;
    const PathSample here = commanded.path->at(due - kLate);
    PlantTruth truth;
    truth.time = i / kRate;
    truth.p_WG.head<2>() = here.p + kAside * Vec2(-std::sin(here.heading), std::cos(here.heading));
    record.push_back(motion_sample(truth, here.heading, RobotState{}, due));
  }
  const Metrics m = measure(record, commanded, kRate);
  EXPECT_NEAR(*m.path.cross_track_mean_mm, 1e3 * kAside, 1e-9);
  EXPECT_NEAR(*m.path.cross_track_max_mm, 1e3 * kAside, 1e-9);
  EXPECT_NEAR(*m.path.along_track_mean_mm, 1e3 * kLate, 1e-9);
  commanded.path.reset();
  EXPECT_FALSE(measure(record, commanded, kRate).path.cross_track_mean_mm) << "a spin has no path";
}

}  // namespace
}  // namespace pirouette
