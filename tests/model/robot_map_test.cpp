#include "pirouette/model/robot_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <regex>
#include <sstream>

#include "pirouette/plant/scene.hpp"

namespace pirouette {
namespace {

std::string mini_cheetah() {
  std::ostringstream text;
  text << std::ifstream(PIROUETTE_SOURCE_DIR "/robots/mini_cheetah/mini_cheetah.xml").rdbuf();
  return text.str();
}

std::string replaced(const std::string& text, const std::string& pattern, const std::string& by) {
  return std::regex_replace(text, std::regex(pattern), by);
}

ModelPtr compile(const std::string& xml) {
  std::array<char, 1024> message{};
  const SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, message.data(), message.size()));
  if (!spec) throw std::runtime_error(message.data());
  ModelPtr model(mj_compile(spec.get(), nullptr));
  if (!model) throw std::runtime_error(mjs_getError(spec.get()));
  return model;
}

Result<RobotMap> map_of(const std::string& xml) { return map_robot(*compile(xml), "robot.xml"); }

std::string first_error(const std::string& xml) {
  const Result<RobotMap> map = map_of(xml);
  return map ? "no error" : map.errors().front().to_string();
}

TEST(RobotMap, FindsTheMiniCheetah) {
  const ModelPtr model = compile(mini_cheetah());
  const RobotMap map = map_robot(*model, "mini_cheetah.xml").value();
  EXPECT_STREQ(mj_id2name(model.get(), mjOBJ_BODY, map.trunk_body), "trunk");
  const std::array<std::string, kJointsPerLeg> suffixes = {"_abad", "_hip", "_knee"};
  for (const Leg leg : kLegs) {
    const std::string prefix(name(leg));
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      const int joint = map.legs[leg].joint[i];
      EXPECT_EQ(mj_id2name(model.get(), mjOBJ_JOINT, joint), prefix + suffixes.at(i));
      EXPECT_EQ(map.legs[leg].qpos[i], model->jnt_qposadr[joint]);
      EXPECT_EQ(map.legs[leg].dof[i], model->jnt_dofadr[joint]);
    }
    EXPECT_EQ(mj_id2name(model.get(), mjOBJ_GEOM, map.legs[leg].foot_geom), prefix + "_foot");
    EXPECT_EQ(map.legs[leg].tau_max, Vec3(18.0, 18.0, 28.0));
    EXPECT_EQ(map.legs[leg].knee_sign, -1.0);
  }
}

TEST(RobotMap, FollowsNamesInEitherCaseAndNotTheOrderInTheFile) {
  const RobotMap plain = map_of(mini_cheetah()).value();
  const std::string swapped =
      replaced(replaced(replaced(mini_cheetah(), "FR_", "spare_"), "FL_", "FR_"), "spare_", "fl_");
  const RobotMap map = map_of(swapped).value();
  EXPECT_EQ(map.legs[Leg::kFL].joint, plain.legs[Leg::kFR].joint);
  EXPECT_EQ(map.legs[Leg::kFR].joint, plain.legs[Leg::kFL].joint);
  EXPECT_EQ(map.legs[Leg::kRR].joint, plain.legs[Leg::kRR].joint);
}

TEST(RobotMap, ListsAllJointsWhenOneIsMissing) {
  const std::string message = first_error(replaced(mini_cheetah(), "RL_knee", "tail"));
  EXPECT_NE(message.find("robot.xml: RL: has 2 hinge joints"), std::string::npos) << message;
  EXPECT_NE(message.find("trunk (free), FR_abad (hinge), FR_hip (hinge)"), std::string::npos)
      << message;
  EXPECT_NE(message.find("tail (hinge)"), std::string::npos) << message;
}

TEST(RobotMap, ReportsEveryMissingLeg) {
  const std::string xml = replaced(mini_cheetah(), "F[RL]_(abad|hip|knee)\"", "front_$&");
  EXPECT_EQ(map_of(xml).errors().size(), 2U);
}

TEST(RobotMap, RequiresAFootSphere) {
  const std::string message = first_error(replaced(
      mini_cheetah(), "type=\"sphere\" size=\"0.0225\"", "type=\"capsule\" size=\"0.02 0.01\""));
  EXPECT_NE(message.find("FR: body FR_shank has no colliding sphere"), std::string::npos)
      << message;
}

TEST(RobotMap, RequiresAFreeTrunk) {
  const std::string message = first_error(replaced(mini_cheetah(), "<(freejoint|key )[^>]*>", ""));
  EXPECT_NE(message.find("no free joint"), std::string::npos) << message;
}

TEST(RobotMap, RefusesARobotThatIsTiedToTheWorldOrToItself) {
  const auto with = [](const std::string& constraint) {
    return replaced(mini_cheetah(), "</mujoco>",
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

TEST(RobotMap, RequiresTheAxesOfTheConventions) {
  const std::string message =
      first_error(replaced(mini_cheetah(), "axis=\"1 0 0\"", "axis=\"-1 0 0\""));
  EXPECT_NE(message.find("joint FR_abad must turn about +x"), std::string::npos) << message;
}

TEST(RobotMap, ReadsTheKneeFromItsRangeOrElseTheFirstKeyframe) {
  const auto sign = [](const std::string& xml) {
    return map_of(xml).value().legs[Leg::kRR].knee_sign;
  };
  const std::string range = "range=\"-2.7 0\"";
  EXPECT_EQ(sign(replaced(mini_cheetah(), range, "range=\"0 2.7\"")), 1.0);
  const std::string both_ways = replaced(mini_cheetah(), range, "range=\"-2.7 2.7\"");
  EXPECT_EQ(sign(both_ways), -1.0);
  EXPECT_EQ(sign(replaced(both_ways, "-1.8108", "1.8108")), 1.0);
  EXPECT_EQ(sign(replaced(both_ways, "<key [^>]*>", "")), -1.0);
}

TEST(RobotMap, ReadsTorqueLimitsFromTheJointOrElseItsMotor) {
  const auto limit = [](const std::string& xml) {
    return map_of(xml).value().legs[Leg::kFR].tau_max.z();
  };
  const std::string knee_limit = "actuatorfrcrange=\"-28 28\"", knee_motor = "joint=\"FR_knee\"";
  EXPECT_EQ(limit(replaced(mini_cheetah(), knee_limit, "actuatorfrcrange=\"-5 7\"")), 5.0);
  const std::string unlimited = replaced(mini_cheetah(), knee_limit, "");
  EXPECT_EQ(limit(replaced(unlimited, knee_motor, "$& gear=\"9\" forcerange=\"-3 3\"")), 27.0);
  EXPECT_EQ(limit(replaced(unlimited, knee_motor, "$& gear=\"9\" ctrlrange=\"-2 2\"")), 18.0);
  EXPECT_EQ(limit(unlimited), kNoTorqueLimit);
}

}  // namespace
}  // namespace pirouette
