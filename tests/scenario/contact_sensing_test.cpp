// Contact sensing that is wrong, missing or raw, in the closed loop: the robot spins as well as
// without it, and does not fall where the ground is not flat.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "support/trial.hpp"

namespace pirouette {
namespace {

struct Sensing {
  const char* name;
  std::vector<std::string> overrides;
};

const std::string kSensors = "plant.sensors.";

/// The weight on a foot is 20 to 60 N: these thresholds are never, hardly or at times passed.
const std::vector<Sensing> kSensings = {
    {"Threshold20N", {kSensors + "contact_threshold=20"}},
    {"Threshold40N", {kSensors + "contact_threshold=40"}},
    {"Threshold60N", {kSensors + "contact_threshold=60"}},
    {"AlwaysFalse", {kSensors + "contact_threshold=1000"}},
    {"OneLegDead", {"plant.faults.contact='stuck_off'", "plant.faults.start=0"}},
    {"RawForces",
     {kSensors + "foot_forces=true", kSensors + "foot_force_scale=3.7",
      kSensors + "foot_force_offset=25", kSensors + "foot_force_noise=4"}},
    {"RawForcesOneLegDead",
     {kSensors + "foot_forces=true", "plant.faults.contact='stuck_off'", "plant.faults.start=0"}},
};

class ContactSensing : public testing::TestWithParam<std::tuple<const char*, Sensing>> {
 protected:
  static Metrics spin(const std::vector<std::string>& more) {
    auto [robot, sensing] = GetParam();
    std::vector<std::string> overrides = sensing.overrides;
    overrides.push_back("robot=" + std::string(robot));
    overrides.insert(overrides.end(), more.begin(), more.end());
    return test::spin(overrides);
  }
};

TEST_P(ContactSensing, TheRobotSpinsWithinAMillimetreOnTheFlat) {
  const Metrics m = spin({"run.turns=4"});
  EXPECT_FALSE(m.fell);
  EXPECT_LE(m.com.distance_to_point_mean_mm.value_or(1e9), 1.0);
}

TEST_P(ContactSensing, TheRobotDoesNotFallOnASlopeOrOnStairs) {
  for (const std::string terrain : {"slope:10", "stairs:0.03x0.20"}) {
    EXPECT_FALSE(spin({"run.turns=2", "plant.terrain='" + terrain + "'"}).fell) << terrain;
  }
}

INSTANTIATE_TEST_SUITE_P(Sensors, ContactSensing,
                         testing::Combine(testing::Values("mini_cheetah", "go1"),
                                          testing::ValuesIn(kSensings)),
                         [](const auto& of) {
                           return std::string(std::get<0>(of.param)) == "go1"
                                      ? std::string("Go1") + std::get<1>(of.param).name
                                      : std::string("MiniCheetah") + std::get<1>(of.param).name;
                         });

}  // namespace
}  // namespace pirouette
