// What is read of other people's robot files: the Mini Cheetah's file, changed as such files
// differ.
#include "pirouette/model/robot_reader.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>

#include "pirouette/base/rotation.hpp"
#include "pirouette/foot/leg_kinematics.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/model/robot_text.hpp"
#include "pirouette/model/spec_repair.hpp"
#include "support/random_robot.hpp"
#include "support/robot_text.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

using test::text_of_robot;

double distance(const auto& a, const auto& b) { return (a - b).cwiseAbs().maxCoeff(); }

std::string replaced(const std::string& text, const std::string& pattern, const std::string& by) {
  return std::regex_replace(text, std::regex(pattern), by);
}

void expect_mentions(const std::string& text, const std::string& what) {
  EXPECT_NE(text.find(what), std::string::npos) << text;
}

class RobotFiles : public test::TempFolderTest {
 protected:
  std::string write(const std::string& text, const std::string& name = "robot.xml") {
    return test::write(folder_ / name, text);
  }

  RobotModel model_of(const std::string& text) { return RobotModel::load(write(text)).value(); }

  std::string error_of(const RobotDescription& robot) {
    const Result<RobotModel> model = RobotModel::load(robot);
    if (model) return "no error";
    std::string all;
    for (const Error& e : model.errors()) all += e.to_string() + "\n";
    return all;
  }

  std::string notes_of(const RobotModel& model) {
    std::string all;
    for (const std::string& note : model.notes()) all += note + "\n";
    return all;
  }

  /// Both are the same robot in the controller's joints, whatever their files look like.
  void expect_same(RobotModel& a, RobotModel& b, double tolerance = 1e-12) {
    test::RandomRobot random(7);
    for (int i = 0; i < 5; ++i) {
      const RobotState s = random.state();
      a.update(s);
      b.update(s);
      EXPECT_LT(distance(a.mass_matrix(), b.mass_matrix()), tolerance);
      EXPECT_LT(distance(a.bias(), b.bias()), 100.0 * tolerance);
      EXPECT_LT(distance(a.com_jacobian(), b.com_jacobian()), tolerance);
      for (const Leg leg : kLegs) {
        EXPECT_LT(distance(a.foot_jacobian(leg), b.foot_jacobian(leg)), tolerance);
        EXPECT_LT(distance(a.shank_jacobian(leg), b.shank_jacobian(leg)), tolerance);
        EXPECT_LT(distance(a.foot_bias(leg), b.foot_bias(leg)), 100.0 * tolerance);
      }
    }
    for (const Leg leg : kLegs) {
      const LegGeometry &one = a.legs()[leg], &other = b.legs()[leg];
      EXPECT_LT(distance(one.p_BH, other.p_BH), tolerance);
      EXPECT_LT(distance(one.q_min, other.q_min), tolerance);
      EXPECT_LT(distance(one.q_max, other.q_max), tolerance);
      EXPECT_NEAR(one.thigh, other.thigh, tolerance);
      EXPECT_NEAR(one.shank, other.shank, tolerance);
      EXPECT_NEAR(one.abad_offset, other.abad_offset, tolerance);
      EXPECT_EQ(one.knee_sign, other.knee_sign);
    }
  }

  RobotModel mini_cheetah_ = RobotModel::load(test::kRobot).value();
};

TEST_F(RobotFiles, NeedNoNames) {
  std::string text = text_of_robot();
  text = replaced(text, "FR_", "alpha_");
  text = replaced(text, "FL_", "beta_");
  text = replaced(text, "RR_", "gamma_");
  text = replaced(text, "RL_", "delta_");
  RobotModel model = model_of(text);
  expect_same(model, mini_cheetah_);
  EXPECT_EQ(model.description().legs[Leg::kRR].joints[2], "gamma_knee");
  EXPECT_TRUE(model.notes().empty()) << notes_of(model);
}

TEST_F(RobotFiles, MayTurnTheirJointsTheOtherWay) {
  std::string text = replaced(text_of_robot(), "axis=\"1 0 0\" range=\"-1.5 1.5\"",
                              "axis=\"-1 0 0\" range=\"-1.5 1.5\"");
  text = replaced(text, "axis=\"0 1 0\" range=\"-3 3\"", "axis=\"0 -1 0\" range=\"-3 3\"");
  text = replaced(text, "axis=\"0 1 0\" range=\"-2.7 0\"", "axis=\"0 -1 0\" range=\"0 2.7\"");
  text = replaced(text, "<key [^>]*>", "");
  RobotModel model = model_of(text);
  expect_same(model, mini_cheetah_);
  for (const LegGeometry& leg : model.legs()) EXPECT_EQ(leg.convention.sign, -Vec3::Ones());
}

TEST_F(RobotFiles, MayHaveTheirZerosAnywhere) {
  // Bodies turned where they hang on their joint: hip by 0.3 rad, shank by -0.9 rad about +y, so
  // that the leg hangs straight down at hip -0.3 and knee 0.9.
  std::string text = text_of_robot();
  text = replaced(text, "(name=\"[FR][RL]_thigh\")",
                  "$1 quat=\"0.98877107793604 0 0.14943813247360 0\"");
  text = replaced(text, "(name=\"[FR][RL]_shank\")",
                  "$1 quat=\"0.90044710235268 0 -0.43496553411123 0\"");
  text = replaced(text, "range=\"-3 3\"", "range=\"-3.3 2.7\"");
  text = replaced(text, "range=\"-2.7 0\"", "range=\"-1.8 0.9\"");
  text = replaced(text, "<key [^>]*>", "");
  RobotModel model = model_of(text);
  expect_same(model, mini_cheetah_, 1e-10);
  for (const LegGeometry& leg : model.legs())
    EXPECT_LT(distance(leg.convention.zero, Vec3(0.0, -0.3, 0.9)), 1e-10);
}

TEST_F(RobotFiles, MayHaveAHipAxisBelowTheAbadAxis) {
  // As HyQ: 80 mm. Kinematics and MuJoCo agree in any posture.
  RobotModel model = model_of(
      replaced(text_of_robot(), "(name=\"[FR][RL]_thigh\" pos=\"0 -?0.062) 0\"", "$1 -0.08\""));
  test::RandomRobot random(3);
  for (int i = 0; i < 5; ++i) {
    const RobotState s = random.state();
    model.update(s);
    for (const Leg leg : kLegs) {
      const LegGeometry& g = model.legs()[leg];
      EXPECT_NEAR(g.hip_drop, 0.08, 1e-12);
      const Vec3& q = s.joint_position[leg];
      const Mat3 J =
          s.R_WB.transpose() * model.foot_jacobian(leg).middleCols<3>(test::leg_column(leg));
      EXPECT_LT(distance(foot_jacobian(g, q), J), 1e-12);
      EXPECT_NEAR(foot_jacobian_determinant(g, q), J.determinant(), 1e-12);
      const IkSolution ik = inverse_kinematics(g, foot_position_H(g, q));
      EXPECT_TRUE(ik.reachable());
      EXPECT_LT(distance(ik.q, q), 1e-9);
    }
  }
}

TEST_F(RobotFiles, KeepTheMassOfAnArmThatIsLocked) {
  const std::string arm =
      "<body name=\"arm\" pos=\"0.1 0 0.1\"><inertial mass=\"0.4\" pos=\"0.1 0 0\" "
      "diaginertia=\"1e-3 1e-3 1e-3\"/><joint name=\"shoulder\" axis=\"0 0 1\" range=\"-3 3\"/>"
      "<body name=\"gripper\" pos=\"0.2 0 0\"><inertial mass=\"0.1\" pos=\"0.05 0 0\" "
      "diaginertia=\"1e-4 1e-4 1e-4\"/><joint name=\"jaw\" type=\"slide\" axis=\"0 1 0\"/>"
      "<geom size=\"0.01\"/></body></body>";
  std::string text = replaced(text_of_robot(), "<site name=\"imu\"", arm + "$&");
  text = replaced(text, "<key [^>]*>", "");
  RobotModel model = model_of(text);
  EXPECT_NEAR(model.mass(), mini_cheetah_.mass() + 0.5, 1e-9);
  expect_mentions(notes_of(model), "locked, their mass kept: shoulder at 0, jaw at 0");

  // Turned by a right angle the arm points to the left: its CoM is where the closed form has it.
  RobotDescription turned(write(text));
  turned.locked["shoulder"] = 0.5 * kPi;
  RobotModel other = RobotModel::load(turned).value();
  const PerLeg<Vec3> q;
  const Vec3 moved = other.mass() * (other.com(q) - model.com(q));
  // Of 0.4 kg at 0.1 m and 0.1 kg at 0.25 m from the shoulder, turned from x to y.
  EXPECT_LT(distance(moved, Vec3(-0.065, 0.065, 0.0)), 1e-9);
  turned.locked["elbow"] = 0.0;
  expect_mentions(error_of(turned), "locked.elbow: there is no such joint");
}

TEST_F(RobotFiles, OfOtherMachinesAreRefusedByWhatTheyAre) {
  const std::string text = text_of_robot();
  // A wheel in place of each foot.
  const std::string wheel =
      "<body name=\"$2_wheel\" pos=\"0 0 -0.2\"><inertial mass=\"0.1\" pos=\"0 0 0\" "
      "diaginertia=\"1e-4 1e-4 1e-4\"/><joint name=\"$2_wheel\" axis=\"0 1 0\"/></body>";
  const std::string wheels =
      replaced(text, "(<body name=\"([FR][RL])_shank\"[^>]*>)", "$1" + wheel);
  expect_mentions(error_of(write(wheels)), "wheels or ankles");
  expect_mentions(error_of(write(wheels)), "FR_wheel");
  const std::string no_abad = replaced(text, "<joint name=\"[FR][RL]_abad\"[^>]*>", "");
  expect_mentions(
      error_of(write(replaced(no_abad, "<(key|motor name=\"[FR][RL]_abad\") [^>]*>", ""))),
      "its legs have two joints");
  expect_mentions(error_of(write("<mujoco><worldbody><body name=\"box\"><freejoint/>"
                                 "<geom size=\"0.1\"/></body></worldbody></mujoco>")),
                  "it has 0 legs of three joints");
}

TEST_F(RobotFiles, MayHaveFeetOfAnyShape) {
  const std::string foot = "<geom name=\"([FR][RL])_foot\"[^>]*/>";
  ASSERT_TRUE(std::regex_search(text_of_robot(), std::regex(foot)));
  const auto with_foot = [&](const std::string& shape) {
    return model_of(replaced(text_of_robot(), foot, shape));
  };
  // Each ends 0.2225 m below the knee, as the sphere does.
  RobotModel capsule = with_foot(
      "<geom name=\"$1_foot\" type=\"capsule\" fromto=\"0 0 -0.1 0 0 -0.2\" size=\"0.0225\" "
      "mass=\"0\"/>");
  expect_same(capsule, mini_cheetah_);
  expect_mentions(notes_of(capsule),
                  "FR foot: a sphere of 22.5 mm stands in for the end of geom FR_foot");

  RobotModel box = with_foot(
      "<geom name=\"$1_foot\" type=\"box\" pos=\"0 0 -0.2\" size=\"0.02 0.02 0.0225\" "
      "mass=\"0\"/>");
  for (const LegGeometry& leg : box.legs())
    EXPECT_NEAR(leg.shank + leg.foot_radius, 0.2225, 0.004);  // its corners reach 1.8 mm farther

  const std::string no_shape =
      replaced(text_of_robot(), "<geom name=\"[FR][RL]_shank\"[^>]*/>", "");
  RobotDescription site(
      write(replaced(no_shape, foot, "<site name=\"$1_toe\" pos=\"0 0 -0.2\"/>")));
  expect_mentions(error_of(site), "RL: no foot");
  for (const Leg leg : kLegs) {
    site.legs[leg].foot = std::string(name(leg)) + "_toe";
    site.legs[leg].foot_radius = 0.0225;
  }
  RobotModel of_site = RobotModel::load(site).value();
  expect_same(of_site, mini_cheetah_);
}

TEST_F(RobotFiles, StandOnOneGeomAFoot) {
  RobotModel model =
      model_of(replaced(text_of_robot(), "<geom name=\"([FR][RL])_foot\"[^>]*/>",
                        "$&<geom name=\"$1_twin\" class=\"foot\" pos=\"0 0 -0.2\"/>"));
  expect_mentions(notes_of(model), "no longer collides");
}

TEST_F(RobotFiles, LoadWithoutTheirLooksButNotWithoutTheirShape) {
  const auto with_mesh = [&](const std::string& attributes) {
    std::string text =
        replaced(text_of_robot(), "<asset>", "<asset><mesh name=\"shell\" file=\"shell.stl\"/>");
    return write(replaced(text, "<site name=\"imu\"",
                          "<geom type=\"mesh\" mesh=\"shell\" " + attributes + "/>$&"));
  };
  RobotModel model =
      RobotModel::load(with_mesh("contype=\"0\" conaffinity=\"0\" mass=\"0\"")).value();
  expect_same(model, mini_cheetah_);
  expect_mentions(notes_of(model), "it will not look as it does: there is no file shell.stl");
  expect_mentions(error_of(with_mesh("mass=\"0\"")), "is the collision shape of body trunk");
}

TEST_F(RobotFiles, TellOfMassesThatTheirCompilerChanges) {
  RobotModel model = model_of(
      replaced(text_of_robot(), "<worldbody>", "<compiler boundmass=\"0.1\"/><worldbody>"));
  expect_mentions(notes_of(model), "changes masses");
}

TEST_F(RobotFiles, CanBeWrittenAsMjcf) {
  // The knees' armature and one foot of its own body whose geom weighs nothing.
  const std::string text = replaced(
      text_of_robot(), "<geom name=\"FR_foot\"[^>]*/>",
      "<body name=\"toe\" pos=\"0 0 -0.2\"><geom name=\"FR_foot\" class=\"foot\"/></body>");
  const std::string first = write(text);
  RobotModel as_read = RobotModel::load(first).value();
  RobotModel written = RobotModel::load(write(robot_mjcf(first).value(), "again.xml")).value();
  EXPECT_NEAR(written.mass(), as_read.mass(), 1e-6);  // the file has six digits
  expect_same(written, as_read, 1e-5);
}

TEST_F(RobotFiles, AreCompleteAfterReading) {
  const std::string text = replaced(text_of_robot(), "axis=\"1 0 0\"", "axis=\"-1 0 0\"");
  RobotModel first = model_of(text);
  RobotModel again = RobotModel::load(first.description()).value();
  expect_same(first, again, 1e-300);
  EXPECT_EQ(first.description().legs[Leg::kFR].zero, again.description().legs[Leg::kFR].zero);
}

/// A quadruped in URDF, its trunk on a dummy root link.
std::string urdf(const std::string& trunk_inertia) {
  std::string text =
      "<robot name=\"u\"><link name=\"base\"/><joint name=\"fixed\" type=\"fixed\"><parent "
      "link=\"base\"/><child link=\"body\"/></joint><link name=\"body\"><inertial><mass "
      "value=\"6\"/><inertia " +
      trunk_inertia +
      "/></inertial><visual><geometry><mesh filename=\"package://u/looks.dae\"/></geometry>"
      "</visual><collision><geometry><box size=\"0.3 0.2 0.1\"/></geometry></collision></link>";
  const auto link = [](const std::string& name, const std::string& more) {
    return "<link name=\"" + name +
           "\"><inertial><mass value=\"0.5\"/><inertia ixx=\"1e-3\" iyy=\"1e-3\" izz=\"1e-3\" "
           "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>" +
           more + "</link>";
  };
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& at, const std::string& axis,
                        const std::string& range) {
    return "<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/><origin xyz=\"" + at + "\"/><axis xyz=\"" + axis +
           "\"/><limit effort=\"30\" velocity=\"20\" " + range + "/></joint>";
  };
  for (const std::string leg : {"LF", "RF", "LH", "RH"}) {
    const std::string x = leg[1] == 'F' ? "0.2" : "-0.2", y = leg[0] == 'L' ? "0.05" : "-0.05",
                      out = leg[0] == 'L' ? "0.08" : "-0.08";
    text += link(leg + "_hip", "") + link(leg + "_thigh", "") +
            link(leg + "_shank",
                 "<collision><origin xyz=\"0 0 -0.2\"/><geometry><sphere radius=\"0.02\"/>"
                 "</geometry></collision>");
    text += joint(leg + "_HAA", "body", leg + "_hip", x + " " + y + " 0", "1 0 0",
                  "lower=\"-1\" upper=\"1\"") +
            joint(leg + "_HFE", leg + "_hip", leg + "_thigh", "0 " + out + " 0", "0 1 0",
                  "lower=\"-3\" upper=\"3\"") +
            joint(leg + "_KFE", leg + "_thigh", leg + "_shank", "0 0 -0.2", "0 1 0",
                  leg[1] == 'F' ? "lower=\"-2.5\" upper=\"-0.1\"" : "lower=\"0.1\" upper=\"2.5\"");
  }
  return text + "</robot>";
}

TEST_F(RobotFiles, MayBeUrdf) {
  const std::string sound = "ixx=\"0.02\" iyy=\"0.05\" izz=\"0.06\" ixy=\"0\" ixz=\"0\" iyz=\"0\"";
  RobotModel model = RobotModel::load(write(urdf(sound), "robot.urdf")).value();
  EXPECT_NEAR(model.mass(), 12.0, 1e-9);
  expect_mentions(notes_of(model), "no free joint: body base was given one");
  expect_mentions(notes_of(model), "no armature");
  for (const Leg leg : kLegs) {
    const LegGeometry& g = model.legs()[leg];
    EXPECT_LT(distance(g.p_BH, Vec3(0.2 * fore_sign(leg), 0.05 * side_sign(leg), 0.0)), 1e-12);
    EXPECT_EQ(g.knee_sign, -fore_sign(leg));  // an X
    EXPECT_EQ(g.tau_max, Vec3::Constant(30.0));
    EXPECT_NEAR(g.shank, 0.2, 1e-12);
  }
  EXPECT_EQ(model.description().legs[Leg::kRL].joints[0], "LH_HAA");
}

TEST_F(RobotFiles, HaveImpossibleInertiasMended) {
  const std::string impossible =
      "ixx=\"1e-2\" iyy=\"1e-2\" izz=\"1e-2\" ixy=\"1e-2\" ixz=\"1e-2\" iyz=\"1e-2\"";
  RobotModel model = RobotModel::load(write(urdf(impossible), "robot.urdf")).value();
  expect_mentions(notes_of(model), "no body has the inertia of body");
}

TEST(PossibleInertia, LeavesWhatSomeBodyHas) {
  const Mat3 rod = Vec3(1.0, 1.0, 0.0).asDiagonal();
  EXPECT_EQ(possible_inertia(rod), rod);
  const Mat3 ball = 0.3 * Mat3::Identity();
  EXPECT_EQ(possible_inertia(ball), ball);
}

TEST(PossibleInertia, HasNoNegativeSecondMoment) {
  for (const Mat3& wrong :
       {Mat3(Mat3::Ones()), Mat3(Vec3(1.0, 1.0, 3.0).asDiagonal()), Mat3(-Mat3::Identity())}) {
    const Mat3 I = possible_inertia(wrong);
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(I);
    const Vec3 m = solver.eigenvalues();
    EXPECT_GT(m[0], 0.0);
    EXPECT_GE(m[0] + m[1], m[2]);
  }
  // Of a diagonal one the principal axes stay.
  const Mat3 I = possible_inertia(Vec3(1.0, 1.0, 3.0).asDiagonal());
  EXPECT_NEAR(I(0, 1), 0.0, 1e-12);
}

}  // namespace
}  // namespace pirouette
