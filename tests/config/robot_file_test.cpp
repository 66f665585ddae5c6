// robot.toml, read and written.
#include "pirouette/config/robot_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "pirouette/model/robot_model.hpp"
#include "support/robot_text.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

class RobotToml : public test::TempFolderTest {
 protected:
  std::string write(const std::string& text) { return test::write(folder_ / "robot.toml", text); }

  std::string error_of(const std::string& text) {
    const Result<RobotDescription> robot = load_robot_file(write(text));
    if (robot) return "no error";
    std::string all;
    for (const Error& e : robot.errors()) all += e.to_string() + "\n";
    return all.substr(folder_.string().size() + 1);
  }

  const std::string file_ = std::string("file = \"") + test::kRobot + "\"\n";
};

TEST_F(RobotToml, ReadsBackWhatWasFoundToTheLastBit) {
  const RobotModel robot = RobotModel::load(test::kRobot).value();
  RobotDescription found = robot.description();
  found.legs[Leg::kFL].zero = Vec3(0.1 + 0.2, -1.0 / 3.0, 1e-17);
  found.legs[Leg::kRR].sign = Vec3(1.0, -1.0, -1.0);
  found.legs[Leg::kRL].knee_sign = 1.0;
  found.locked["arm joint"] = 2.0 / 3.0;
  const RobotDescription again = load_robot_file(write(robot_toml(found))).value();
  EXPECT_EQ(robot_toml(again), robot_toml(found));
  for (const Leg leg : kLegs) {
    EXPECT_EQ(again.legs[leg].joints, found.legs[leg].joints);
    EXPECT_EQ(*again.legs[leg].zero, *found.legs[leg].zero);
    EXPECT_EQ(*again.legs[leg].sign, *found.legs[leg].sign);
    EXPECT_EQ(*again.legs[leg].torque, *found.legs[leg].torque);
    EXPECT_EQ(again.legs[leg].foot, found.legs[leg].foot);
  }
  EXPECT_EQ(again.locked, found.locked);
}

TEST_F(RobotToml, NamesLineKeyValueAndWhatIsAllowed) {
  EXPECT_EQ(error_of("imu = \"imu\"\n"),
            "robot.toml: file: missing; the MJCF or URDF file of the robot\n");
  EXPECT_EQ(error_of("file = \"nowhere.xml\"\n"),
            "robot.toml:1: file: given \"nowhere.xml\": no such file\n");
  EXPECT_EQ(error_of(file_ + "[legs.FR]\nkne = \"forward\"\n"),
            "robot.toml:3: legs.FR.kne: unknown key; did you mean knee?\n");
  EXPECT_EQ(error_of(file_ + "[legs.FX]\n"),
            "robot.toml:2: legs.FX: unknown key; did you mean FR?\n");
  EXPECT_EQ(error_of(file_ + "[legs.FR]\nsign = [1, 0.5, 1]\n"),
            "robot.toml:3: legs.FR.sign: given [1, 0.5, 1]; allowed: three of 1 and -1: abad, hip, "
            "knee\n");
  EXPECT_EQ(error_of(file_ + "[legs.FR]\nfoot_radius = -1\n"),
            "robot.toml:3: legs.FR.foot_radius: given -1; allowed: 0.001 to 0.5 m\n");
  EXPECT_EQ(error_of(file_ + "[legs.FR]\njoints = [\"a\", \"b\", \"c\"]\n"),
            "robot.toml:2: legs: joints are named of 1 legs; allowed: of all four, or of none\n");
}

TEST_F(RobotToml, OverridesTheFile) {
  const RobotModel robot =
      RobotModel::load(
          load_robot_file(write(file_ + "[legs.RL]\nknee = \"forward\"\ntorque = [9, 9, 9]\n"))
              .value())
          .value();
  EXPECT_EQ(robot.legs()[Leg::kRL].knee_sign, 1.0);
  EXPECT_EQ(robot.legs()[Leg::kRL].tau_max, Vec3::Constant(9.0));
  EXPECT_EQ(robot.legs()[Leg::kRR].knee_sign, -1.0);
}

TEST_F(RobotToml, TakesThePoseOfTheSrdfBesideAUrdf) {
  test::write(folder_ / "u.urdf", "<robot name=\"u\"/>");
  test::write(
      folder_ / "u.srdf",
      "<robot name=\"u\"><group_state name=\"standing\" group=\"all\"><joint name=\"root\" "
      "value=\"0 0 0.4 0 0 0 1\"/><joint name=\"knee\" value=\"-1.25\"/></group_state></robot>");
  const RobotDescription robot = load_robot_file(folder_ / "u.urdf").value();
  ASSERT_EQ(robot.pose.size(), 1u);
  EXPECT_EQ(robot.pose.at("knee"), -1.25);
}

}  // namespace
}  // namespace pirouette
