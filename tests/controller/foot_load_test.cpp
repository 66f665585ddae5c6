#include "pirouette/controller/foot_load.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pirouette {
namespace {

constexpr double kDt = 0.002;    ///< s
constexpr double kPeriod = 0.5;  ///< s
constexpr double kDuty = 0.6;
constexpr double kWeight = 90.0;  ///< N

/// A sensor that reads offset + scale * force.
struct Sensor {
  double scale = 1.0;
  double offset = 0.0;
  double operator()(double force) const { return offset + scale * force; }
};

/// Share of the ticks of `duration` (s) in which the flag of FR is the schedule's, at a trot in
/// which the legs of a diagonal carry half the weight each.
double agreement(FootLoad& load, const Sensor& sensor, double duration) {
  int right = 0, all = 0;
  for (double t = 0.0; t < duration; t += kDt, ++all) {
    const double cycle = std::fmod(t / kPeriod, 1.0);
    GaitPhase gait;
    gait.walking = true;
    LegPhase& phase = gait.leg[Leg::kFR];
    phase.stance = cycle < kDuty;
    phase.progress = phase.stance ? cycle / kDuty : (cycle - kDuty) / (1.0 - kDuty);
    const double force = phase.stance ? 0.5 * kWeight : 0.0;
    const auto flags = load.update(PerLeg<double>::filled(sensor(force)), gait, kDt);
    right += flags[Leg::kFR] == phase.stance ? 1 : 0;
  }
  return static_cast<double>(right) / all;
}

PerLeg<bool> stand(FootLoad& load, const Sensor& sensor) {
  PerLeg<bool> flags{};
  for (double t = 0.0; t < 0.5; t += kDt)
    flags = load.update(PerLeg<double>::filled(sensor(0.25 * kWeight)), GaitPhase{}, kDt);
  return flags;
}

TEST(FootLoad, FindsItsThresholdForAnyScale) {
  for (const double scale : {1e-3, 0.1, 1.0, 40.0}) {
    FootLoad load;
    for (const bool touches : stand(load, {scale, 0.0})) EXPECT_TRUE(touches);
    EXPECT_EQ(agreement(load, {scale, 0.0}, 5.0), 1.0) << scale;
  }
}

TEST(FootLoad, LearnsWhatAFootInTheAirReads) {
  for (const double offset : {-300.0, 20.0, 300.0}) {
    FootLoad load;
    stand(load, {1.0, offset});
    agreement(load, {1.0, offset}, 2.0);
    EXPECT_EQ(agreement(load, {1.0, offset}, 5.0), 1.0) << offset;
  }
}

TEST(FootLoad, ASensorThatFeelsNothingNeverFollowsTheSchedule) {
  for (const double offset : {0.0, 50.0}) {
    FootLoad load;
    stand(load, {0.0, offset});
    agreement(load, {0.0, offset}, 2.0);
    EXPECT_NEAR(agreement(load, {0.0, offset}, 5.0), 1.0 - kDuty, 0.01);  // false throughout
  }
}

TEST(FootLoad, ResetForgets) {
  FootLoad load;
  stand(load, {1.0, 0.0});
  load.reset();
  for (const bool touches : stand(load, {1e-3, 0.0})) EXPECT_TRUE(touches);
}

}  // namespace
}  // namespace pirouette
