// Spins on flat ground in the real closed loop: Kalman filter, sensor noise and biases on.
#include <gtest/gtest.h>

#include <cmath>

#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/toml.hpp"
#include "support/trial.hpp"

namespace pirouette {
namespace {

using test::spin;

std::string set(const std::string& key, double value) { return key + "=" + std::to_string(value); }

class SpinOnTheFlat : public testing::TestWithParam<std::tuple<double, int>> {};

TEST_P(SpinOnTheFlat, EightTurnsStayOnThePointAtTheCommandedRate) {
  const auto [rate, seed] = GetParam();
  const Metrics m = spin({set("run.rate", rate), "run.seed=" + std::to_string(seed)});
  EXPECT_FALSE(m.fell);
  EXPECT_GE(m.turns_done, 7.9);
  const bool nominal_rate = std::abs(rate) == 0.7;
  // What the calibration at rest leaves of the gyro's bias, 3e-4 rad/s at most, weighs more the
  // slower the robot turns.
  EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), nominal_rate ? 1e-3 : 2e-3);
  EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), nominal_rate ? 1.0 : 2.0);
  EXPECT_LE(m.com.distance_to_point_max_mm.value_or(1e9), nominal_rate ? 4.0 : 8.0);
}

std::string spin_name(const testing::TestParamInfo<std::tuple<double, int>>& test_info) {
  const auto [rate, seed] = test_info.param;
  return std::string(rate > 0.0 ? "Left" : "Right") +
         std::to_string(std::lround(std::abs(rate) * 10.0)) + "DeciradSeed" + std::to_string(seed);
}

INSTANTIATE_TEST_SUITE_P(Rates, SpinOnTheFlat,
                         testing::Combine(testing::Values(0.3, 0.7, 1.2, 2.0, -0.3, -0.7, -1.2,
                                                          -2.0),
                                          testing::Values(1, 2, 3, 4, 5)),
                         spin_name);

TEST(SpinWithTrueState, StaysWithinHalfAMillimetreOfThePoint) {
  const Metrics m = spin({"estimation.source=truth"});
  EXPECT_FALSE(m.fell);
  EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), 0.5);
  EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-3);
}

TEST(SpinOnSlipperyGround, StaysWithinFiveMillimetresOfThePoint) {
  for (const double friction : {0.4, 0.2}) {
    const Metrics m = spin({set("plant.friction", friction)});
    EXPECT_FALSE(m.fell) << friction;
    EXPECT_LE(m.com.distance_to_point_max_mm.value_or(1e9), 5.0) << friction;
  }
}

TEST(FastSpin, SurvivesTenTurnsAtFourRadiansPerSecondByAShorterStride) {
  for (const double rate : {4.0, -4.0}) {
    const Metrics m = spin({set("run.rate", rate), "run.turns=10"});
    EXPECT_FALSE(m.fell) << rate;
    EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-3) << rate;
    EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), 5.0) << rate;
  }
}

TEST(SpinFromAnOffsetStart, ReachesPointAndRateFromTenCentimetresAndThirtyDegrees) {
  for (const std::string start : {"[0.1, 0.0]", "[-0.06, 0.08]", "[0.0, -0.1]"}) {
    for (const char* yaw : {"30", "-30"}) {
      const Metrics m = spin(
          {"run.start_offset=" + start, std::string("run.start_yaw_deg=") + yaw, "run.turns=3"});
      EXPECT_FALSE(m.fell) << start << " " << yaw;
      EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-2) << start << " " << yaw;
      EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), 15.0) << start << " " << yaw;
    }
  }
}

TEST(SpinWithTheFootAsAPoint, TheBaselineBundleSpinsToo) {
  ConfigSources sources;
  sources.controller = "mit";
  const Metrics m = test::run(load_config(sources).value());
  EXPECT_FALSE(m.fell);
  EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-2);
}

class SpinOfARobotInTheBox : public testing::TestWithParam<std::string> {};

TEST_P(SpinOfARobotInTheBox, StaysOnThePointWithNothingButItsName) {
  const Config config = load_config({.robot = GetParam()}).value();
  const Metrics m = spin({"robot=\"" + GetParam() + "\"", "run.turns=1"});
  EXPECT_FALSE(m.fell);
  EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 2e-3);
  // Twice what the worst of them does in three turns.
  EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), 0.004 * 1e3 * config.body.height);
}

INSTANTIATE_TEST_SUITE_P(Known, SpinOfARobotInTheBox, testing::ValuesIn(known_robots()),
                         [](const auto& robot) { return robot.param; });

TEST(SpinOfAnotherRobot, NeedsNothingButTheHeightOfItsCentreOfMass) {
  for (const double rate : {0.7, -2.0}) {
    const Metrics m = spin({"robot=\"go1\"", set("run.rate", rate), "run.turns=3"});
    EXPECT_FALSE(m.fell) << rate;
    EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 2e-3) << rate;
    EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), 2.0) << rate;
  }
}

TEST(SpinWithoutContactSensing, TheScheduleStandsInForTheFlags) {
  const Metrics m = spin({"plant.sensors.contact_flags=false", "run.turns=4"});
  EXPECT_FALSE(m.fell);
  EXPECT_LE(m.com.radius_mean_mm.value_or(1e9), 1.0);  // twice what is measured
}

TEST(SpinAtOtherTimings, AnyPeriodAndDutyOfTheTrotHolds) {
  for (const auto& [period, duty] :
       {std::pair{"0.3", "0.6"}, {"0.4", "0.5"}, {"0.5", "0.75"}, {"0.7", "0.6"}}) {
    const Metrics m = spin(
        {std::string("gait.period=") + period, std::string("gait.duty=") + duty, "run.turns=2"});
    EXPECT_FALSE(m.fell) << period << " " << duty;
    EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), 1e-2) << period << " " << duty;
  }
}

TEST(TrotOnTheSpot, ZeroCommandDoesNotDrift) {
  const Metrics m = spin({"run.rate=0", "run.turns=3"});
  EXPECT_FALSE(m.fell);
  EXPECT_LE(m.com.distance_to_point_max_mm.value_or(1e9), 10.0);
  EXPECT_FALSE(m.yaw_rate_error.has_value());
}

}  // namespace
}  // namespace pirouette
