// Stays in place on slopes, steps and with bad contact flags; the acceptance runs are experiments.
#include <gtest/gtest.h>

#include "support/trial.hpp"

namespace pirouette {
namespace {

/// Three turns at 0.7 rad/s on `terrain` with `overrides`, seed 1.
Metrics spin_on(const std::string& terrain, std::vector<std::string> overrides = {}) {
  overrides.insert(overrides.end(),
                   {"plant.terrain=\"" + terrain + "\"", "run.turns=3", "run.seed=1"});
  return test::spin(overrides);
}

double drift(const Metrics& m) { return m.com.drift_per_turn_mm.value_or(1e9); }
double distance_to_point(const Metrics& m) { return m.com.distance_to_point_mean_mm.value_or(1e9); }

const std::vector<std::string> kAid = {"plant.sensors.aid_rate=10", "plant.sensors.aid_noise=0.005",
                                       "plant.sensors.aid_delay=0.05"};

TEST(SpinOnASlope, CalibratedCreepKeepsItInPlace) {
  const std::vector<std::string> calibration = {"creep.calibrated_friction=0.8",
                                                "creep.calibrated_torsion=0.005"};
  std::vector<std::string> on = calibration, off = calibration;
  on.emplace_back("creep.mode=\"stored\"");
  off.emplace_back("creep.mode=\"off\"");
  const Metrics m = spin_on("slope:15", on);
  EXPECT_FALSE(m.fell);
  EXPECT_LE(drift(m), 1.2);
  // Without it: 2 pi (mu_t / mu^2) tan(15 deg) = 13.2 mm, over the cone's factor 0.94 = 14.0 mm.
  EXPECT_NEAR(drift(spin_on("slope:15", off)), 13.6, 2.0);
}

// Bounds from here on: about twice what is measured with this seed.
TEST(SpinOnASlope, TheCreepFoundOnlineKeepsItInPlaceBothWays) {
  for (const char* rate : {"0.7", "-0.7"}) {
    const Metrics m = spin_on("slope:15", {std::string("run.rate=") + rate});
    EXPECT_FALSE(m.fell) << rate;
    EXPECT_LE(drift(m), 1.6) << rate;
    EXPECT_LE(distance_to_point(m), 4.0) << rate;
  }
}

TEST(SpinOnStairs, StaysInPlaceOnHighSteps) {
  const Metrics m = spin_on("stairs:0.05x0.20");
  EXPECT_FALSE(m.fell);
  EXPECT_LE(drift(m), 1.7);
  EXPECT_LE(distance_to_point(m), 5.5);
}

TEST(SpinOnStairs, LateAndWrongContactFlagsDoNotMakeItFall) {
  const Metrics m = spin_on(
      "stairs:0.03x0.20", {"plant.sensors.contact_delay=0.01", "plant.sensors.contact_error=0.02"});
  EXPECT_FALSE(m.fell);
  EXPECT_GE(m.turns_done, 2.9);
}

TEST(SpinOnBlocks, StandsOnScatteredBlocks) {
  const Metrics m = spin_on("blocks:0.05");
  EXPECT_FALSE(m.fell);
  EXPECT_GE(m.turns_done, 2.9);
  EXPECT_LE(distance_to_point(m), 25.0);
}

TEST(SpinWithAPositionAid, StaysOnThePoint) {
  const Metrics m = spin_on("flat", kAid);
  EXPECT_FALSE(m.fell);
  EXPECT_LE(distance_to_point(m), 2.5);
}

TEST(SpinWithAPositionAid, ALostAidDoesNoHarm) {
  std::vector<std::string> lost = kAid;
  lost.emplace_back("plant.sensors.aid_lost_after=10");
  const Metrics m = spin_on("flat", lost);
  EXPECT_FALSE(m.fell);
  EXPECT_LE(distance_to_point(m), 5.0);
}

}  // namespace
}  // namespace pirouette
