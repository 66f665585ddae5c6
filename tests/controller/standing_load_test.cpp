// Whether a robot can carry itself.
#include "pirouette/controller/standing_load.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/mini_cheetah.hpp"
#include "support/robot_text.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

class StandingLoads : public test::TempFolderTest {
 protected:
  std::string problems(const ControllerConfig& config, RobotModel& robot) {
    std::string all;
    for (const Error& e : check_standing(config, robot)) all += e.to_string() + "\n";
    return all;
  }

  RobotModel robot_ = RobotModel::load(test::kRobot).value();
  ControllerConfig config_;
};

TEST_F(StandingLoads, AreTheLeversOfHalfTheWeight) {
  const StandingLoad load = standing_load(robot_, 0.27);
  const double half = 0.5 * robot_.mass() * kGravity;
  for (const Leg leg : kLegs) {
    const LegGeometry& g = robot_.legs()[leg];
    // Feet below the hips: the hip has no lever, the knee that of the thigh, the abad the offset.
    EXPECT_NEAR(load.torque[leg][1], 0.0, 1e-9);
    EXPECT_NEAR(std::abs(load.torque[leg][2]), half * g.thigh * std::sin(load.q[leg][1]), 1e-9);
    EXPECT_NEAR(std::abs(load.torque[leg][0]), half * std::abs(g.abad_offset), 1e-9);
    EXPECT_TRUE(load.reaches[leg]);
  }
  EXPECT_NEAR(load.p_BG.z(), -0.0088, 2e-4);  // robots/README.md
  EXPECT_EQ(problems(config_, robot_), "");
}

TEST_F(StandingLoads, TooLargeAreRefusedWithTheNumber) {
  config_.mpc.max_normal_force = 40.0;
  EXPECT_NE(problems(config_, robot_)
                .find("mpc.max_normal_force: given 40 N: two feet cannot carry "
                      "the weight of 87.4 N; allowed: more than 43.7 N"),
            std::string::npos)
      << problems(config_, robot_);
  config_ = {};
  config_.body.height = 0.5;
  EXPECT_NE(
      problems(config_, robot_).find("body.height: the robot cannot stand with its CoM 0.5 m"),
      std::string::npos)
      << problems(config_, robot_);

  std::string text = test::text_of_robot();
  const std::string limit = "actuatorfrcrange=\"-28 28\"";
  text.replace(text.find(limit), limit.size(), "actuatorfrcrange=\"-5 5\"");
  RobotModel weak = RobotModel::load(test::write(folder_ / "weak.xml", text)).value();
  config_ = {};
  EXPECT_NE(problems(config_, weak)
                .find("knee needs 7.12 N m to carry half the weight of 8.91 kg; "
                      "its motor gives 5 N m"),
            std::string::npos)
      << problems(config_, weak);
}

}  // namespace
}  // namespace pirouette
