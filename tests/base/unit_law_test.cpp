// How the defaults follow the size of a robot.
#include "pirouette/base/unit_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "pirouette/base/fit_to_scale.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/robot_defaults.hpp"
#include "pirouette/config/toml.hpp"
#include "pirouette/controller/robot_defaults.hpp"
#include "support/mini_cheetah.hpp"

namespace pirouette {
namespace {

TEST(UnitLaws, AreTheDimensionsOfTheUnit) {
  const auto law = [](double length, double mass, double time) {
    return UnitLaw{length, mass, time};
  };
  EXPECT_EQ(unit_law("1"), law(0, 0, 0));
  EXPECT_EQ(unit_law("rad"), law(0, 0, 0));
  EXPECT_EQ(unit_law("m/s^2"), law(1, 0, -2));
  EXPECT_EQ(unit_law("N m s/rad"), law(2, 1, -1));
  EXPECT_EQ(unit_law("(m/s)^2/s"), law(2, 0, -3));
  EXPECT_EQ(unit_law("1/N^2"), law(-2, -2, 4));
  EXPECT_EQ(unit_law("s^4/m^2"), law(-2, 0, 4));
  EXPECT_THROW(unit_law("furlong"), std::invalid_argument);
  EXPECT_THROW(unit_law("(m"), std::invalid_argument);
}

TEST(UnitLaws, AreThoseThatCuredForeignRobots) {
  // findings of scaled gains: times and speeds go with sqrt(l), accelerations not at all.
  EXPECT_EQ(law_text(unit_law("m/s")), "l^0.5");
  EXPECT_EQ(law_text(unit_law("m/s^2")), "");
  EXPECT_EQ(law_text(unit_law("N")), "u");
  EXPECT_EQ(law_text(unit_law("N m/rad")), "u l");
  EXPECT_EQ(law_text(unit_law("N m s/rad")), "u l^1.5");
  EXPECT_EQ(law_text(unit_law("1/s^2")), "l^-1");
  EXPECT_EQ(law_text(unit_law("1/N^2")), "u^-2");
  EXPECT_EQ(law_text(unit_law("s^2/rad^2")), "l");
}

TEST(UnitLaws, HoldForEveryParameter) {
  for (const ParameterGroup& group : describe(Config{})) {
    for (const ParameterInfo& p : group.parameters) {
      for (const std::string_view unit : units_of(p.unit)) {
        if (p.unit.empty()) continue;
        EXPECT_NO_THROW(parameter_law(p.key, unit)) << p.key;
      }
    }
  }
}

TEST(UnitLaws, ScaleToFourDigitsAndTurnNothingIntoItself) {
  EXPECT_EQ(scaled(150.0, unit_law("N"), 1.0, 1.0), 150.0);
  EXPECT_EQ(scaled(0.1 + 0.2, unit_law("N"), 1.0, 1.0), 0.1 + 0.2);
  EXPECT_EQ(scaled(150.0, unit_law("N"), 2.0, 10.0), 1500.0);
  EXPECT_EQ(scaled(1.0, unit_law("s"), 2.0, 10.0), 1.414);
  EXPECT_EQ(scaled(1e-5, unit_law("1/N^2"), 1.0, 3.0), 1.111e-6);
  EXPECT_EQ(scaled(0.0, unit_law("m"), 2.0, 10.0), 0.0);
}

TEST(RobotDefaults, AreTheMiniCheetahsOwn) {
  RobotModel robot = RobotModel::load(test::kRobot).value();
  EXPECT_EQ(robot.scale().length, 1.0);
  EXPECT_EQ(robot.scale().mass, 1.0);
  Config fitted;
  static_cast<ControllerConfig&>(fitted) = default_config(robot);
  EXPECT_EQ(dump_toml(fitted), dump_toml(Config{}));
}

TEST(RobotDefaults, GiveGroundInSharesOfTheHeight) {
  EXPECT_EQ(terrain_in_metres("stairs:11%x74%", 0.27), "stairs:0.0297x0.1998");
  EXPECT_EQ(terrain_in_metres("slope:10+rough:7.5%", 0.4), "slope:10+rough:0.03");
  EXPECT_EQ(terrain_in_metres("stairs:0.03x0.20@30", 0.4), "stairs:0.03x0.20@30");
  const Config config =
      load_config({.robot = "go1", .overrides = {"plant.terrain=stairs:10%x50%"}}).value();
  EXPECT_EQ(config.plant.terrain, "stairs:0.03x0.15");
}

TEST(RobotDefaults, LetTheExplicitKeyWin) {
  const Config config =
      load_config({.robot = "go1", .overrides = {"mpc.max_normal_force=77"}}).value();
  EXPECT_EQ(config.mpc.max_normal_force, 77.0);
  // Two feet carry the same share of the weight as the Mini Cheetah's.
  EXPECT_NEAR(config.joint.kp_stance, 10.0 * (11.308932 / 8.912) * (0.426 / 0.415), 0.01);
  EXPECT_EQ(config.control.rate, 500.0);
}

}  // namespace
}  // namespace pirouette
