// The indices of a robot in a compiled model.
#include "pirouette/model/robot_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <regex>
#include <string>

#include "pirouette/model/robot_reader.hpp"
#include "pirouette/plant/scene.hpp"
#include "support/robot_text.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

std::string replaced(const std::string& text, const std::string& pattern, const std::string& by) {
  return std::regex_replace(text, std::regex(pattern), by);
}

class RobotMaps : public test::TempFolderTest {
 protected:
  Result<RobotMap> map_of(const std::string& xml) {
    const Result<ReadRobot> robot = read_robot(test::write(folder_ / "robot.xml", xml));
    if (!robot) return robot.errors();
    model_.reset(mj_compile(robot.value().spec.get(), nullptr));
    return map_robot(*model_, robot.value().description);
  }

  std::string first_error(const std::string& xml) {
    const Result<RobotMap> map = map_of(xml);
    return map ? "no error" : map.errors().front().to_string();
  }

  ModelPtr model_;
};

TEST_F(RobotMaps, HoldTheMiniCheetah) {
  const RobotMap map = map_of(test::text_of_robot()).value();
  const mjModel* model = model_.get();
  EXPECT_STREQ(mj_id2name(model, mjOBJ_BODY, map.trunk_body), "trunk");
  const std::array<std::string, kJointsPerLeg> suffixes = {"_abad", "_hip", "_knee"};
  for (const Leg leg : kLegs) {
    const std::string prefix(name(leg));
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      const int joint = map.legs[leg].joint[i];
      EXPECT_EQ(mj_id2name(model, mjOBJ_JOINT, joint), prefix + suffixes.at(i));
      EXPECT_EQ(map.legs[leg].qpos[i], model->jnt_qposadr[joint]);
      EXPECT_EQ(map.legs[leg].dof[i], model->jnt_dofadr[joint]);
    }
    EXPECT_EQ(mj_id2name(model, mjOBJ_GEOM, map.legs[leg].foot_geom), prefix + "_foot");
    EXPECT_EQ(map.legs[leg].tau_max, Vec3(18.0, 18.0, 28.0));
    EXPECT_EQ(map.legs[leg].knee_sign, -1.0);
    EXPECT_EQ(map.legs[leg].convention.sign, Vec3::Ones());
    EXPECT_EQ(map.legs[leg].convention.zero, Vec3::Zero());
  }
}

TEST_F(RobotMaps, RefuseARobotThatIsTiedToTheWorldOrToItself) {
  const auto with = [](const std::string& constraint) {
    return replaced(test::text_of_robot(), "</mujoco>",
                    "<equality>" + constraint + "</equality></mujoco>");
  };
  for (const std::string constraint :
       {"<weld name=\"rig\" body1=\"trunk\" body2=\"world\"/>",
        "<connect name=\"rig\" body1=\"world\" body2=\"FL_shank\" anchor=\"0 0 0\"/>"}) {
    const std::string message = first_error(with(constraint));
    EXPECT_NE(message.find("equality: constraint rig ties the robot to the world"),
              std::string::npos)
        << message;
  }
  const std::string message = first_error(with("<joint joint1=\"FR_hip\" joint2=\"FL_hip\"/>"));
  EXPECT_NE(message.find("constraint number 1 ties joint FR_hip"), std::string::npos) << message;
  EXPECT_TRUE(map_of(with("<weld active=\"false\" body1=\"trunk\" body2=\"world\"/>")).ok());
}

TEST_F(RobotMaps, ReadTheKneeFromItsRangeOrElseTheFirstKeyframe) {
  const auto sign = [this](const std::string& xml) {
    return map_of(xml).value().legs[Leg::kRR].knee_sign;
  };
  const std::string range = "range=\"-2.7 0\"";
  EXPECT_EQ(sign(replaced(test::text_of_robot(), range, "range=\"0 2.7\"")), 1.0);
  const std::string both_ways = replaced(test::text_of_robot(), range, "range=\"-2.7 2.7\"");
  EXPECT_EQ(sign(both_ways), -1.0);
  EXPECT_EQ(sign(replaced(both_ways, "-1.8108", "1.8108")), 1.0);
  EXPECT_EQ(sign(replaced(both_ways, "<key [^>]*>", "")), -1.0);
}

TEST_F(RobotMaps, ReadTorqueLimitsFromTheJointOrElseItsMotor) {
  const auto limit = [this](const std::string& xml) {
    return map_of(xml).value().legs[Leg::kFR].tau_max.z();
  };
  const std::string knee_limit = "actuatorfrcrange=\"-28 28\"", knee_motor = "joint=\"FR_knee\"";
  EXPECT_EQ(limit(replaced(test::text_of_robot(), knee_limit, "actuatorfrcrange=\"-5 7\"")), 5.0);
  const std::string unlimited = replaced(test::text_of_robot(), knee_limit, "");
  EXPECT_EQ(limit(replaced(unlimited, knee_motor, "$& gear=\"9\" forcerange=\"-3 3\"")), 27.0);
  EXPECT_EQ(limit(replaced(unlimited, knee_motor, "$& gear=\"9\" ctrlrange=\"-2 2\"")), 18.0);
  EXPECT_EQ(limit(unlimited), 1000.0);
}

}  // namespace
}  // namespace pirouette
