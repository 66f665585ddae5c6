#include "pirouette/model/robot_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <stdexcept>

#include "pirouette/foot/leg_kinematics.hpp"
#include "support/mini_cheetah.hpp"
#include "support/random_robot.hpp"
#include "support/robot_text.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::leg_column;
using test::moved;
using test::text_of_robot;
using test::velocity_of;
using test::with_legs_reversed;

constexpr int kDraws = 20;
constexpr double kExact = 1e-12;  // a few hundred roundings of numbers of order one
// Central differences over kStep: the cut-off terms are about kStep^2 times a third derivative of
// at most 10^3 (joints at 4 rad/s), rounding about 1e-15 / kStep.
constexpr double kStep = 1e-5;
constexpr double kDifference = 1e-6;

/// d/dt at t = 0 of `value(state)` along the state's own velocity.
template <class Value>
auto rate(const RobotState& state, const Value& value) {
  return ((value(moved(state, kStep)) - value(moved(state, -kStep))) / (2.0 * kStep)).eval();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::invalid_argument("not in the robot file: " + from);
  for (; at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Writes `xml` to a file that this test has for itself.
std::string write(const std::string& xml) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return test::write(testing::TempDir() + "pirouette_" + test->name() + ".xml", xml);
}

std::string errors_of(const std::string& mjcf) {
  const Result<RobotModel> model = RobotModel::load(RobotDescription(mjcf));
  if (model) return "no error";
  std::string all;
  for (const Error& e : model.errors()) all += e.to_string() + "\n";
  return all;
}

void expect_mentions(const std::string& text, const std::string& what) {
  EXPECT_NE(text.find(what), std::string::npos) << text;
}

class MiniCheetahModel : public testing::Test {
 protected:
  RobotModel model_ = RobotModel::load(test::kRobot).value();
  test::RandomRobot random_{3};
};

TEST_F(MiniCheetahModel, FootAndShankJacobiansAreThoseOfTheLegKinematics) {
  for (int i = 0; i < kDraws; ++i) {
    const RobotState s = random_.state();
    model_.update(s);
    for (const Leg leg : kLegs) {
      const LegGeometry& geometry = model_.legs()[leg];
      const Vec3& q = s.joint_position[leg];
      Jacobian foot = Jacobian::Zero(), shank = Jacobian::Zero();
      foot.leftCols<3>().setIdentity();
      foot.middleCols<3>(3) = -s.R_WB * skew(foot_state(geometry, q, Vec3::Zero()).p_BF);
      foot.middleCols<3>(leg_column(leg)) = s.R_WB * foot_jacobian(geometry, q);
      shank.middleCols<3>(3) = s.R_WB;
      shank.middleCols<3>(leg_column(leg)) = s.R_WB * shank_jacobian(q);
      EXPECT_LT(distance(model_.foot_jacobian(leg), foot), kExact);
      EXPECT_LT(distance(model_.shank_jacobian(leg), shank), kExact);
    }
  }
}

TEST_F(MiniCheetahModel, FootAndShankJacobiansAreDerivativesOfThePose) {
  for (int i = 0; i < kDraws; ++i) {
    const RobotState s = random_.state();
    model_.update(s);
    for (const Leg leg : kLegs) {
      const auto foot = [&](const RobotState& at) {
        const FootState f = foot_state(model_.legs()[leg], at.joint_position[leg], Vec3::Zero());
        return (at.p_WB + at.R_WB * f.p_BF).eval();
      };
      EXPECT_LT(distance(model_.foot_jacobian(leg) * velocity_of(s), rate(s, foot)), kDifference);
      const auto shank = [&](const RobotState& at) {
        return (at.R_WB * shank_rotation(at.joint_position[leg])).eval();
      };
      const Mat3 turn = shank(moved(s, kStep)) * shank(moved(s, -kStep)).transpose();
      const Vec3 w_WS_W = log_so3(turn) / (2.0 * kStep);
      EXPECT_LT(distance(model_.shank_jacobian(leg) * velocity_of(s), w_WS_W), kDifference);
    }
  }
}

TEST_F(MiniCheetahModel, CentreOfMassJacobianIsTheDerivativeOfItsPosition) {
  for (int i = 0; i < kDraws; ++i) {
    const RobotState s = random_.state();
    const Vec3 v_WG_W = rate(s, [&](const RobotState& at) {
      model_.update(at);
      return model_.p_WG();
    });
    model_.update(s);
    EXPECT_LT(distance(model_.com_jacobian() * velocity_of(s), v_WG_W), kDifference);
    EXPECT_LT(distance(model_.v_WG_W(), v_WG_W), kDifference);
  }
}

TEST_F(MiniCheetahModel, BiasAccelerationsAreTheRatesOfTheJacobiansAlongTheMotion) {
  for (int i = 0; i < kDraws; ++i) {
    const RobotState s = random_.state();
    const VecDof nu = velocity_of(s);
    const Vec3 com = rate(s, [&](const RobotState& at) {
      model_.update(at);
      return (model_.com_jacobian() * nu).eval();
    });
    model_.update(s);
    EXPECT_LT(distance(model_.com_bias(), com), kDifference);
    for (const Leg leg : kLegs) {
      const Vec3 foot = rate(s, [&](const RobotState& at) {
        model_.update(at);
        return (model_.foot_jacobian(leg) * nu).eval();
      });
      const Vec3 shank = rate(s, [&](const RobotState& at) {
        model_.update(at);
        return (model_.shank_jacobian(leg) * nu).eval();
      });
      model_.update(s);
      EXPECT_LT(distance(model_.foot_bias(leg), foot), kDifference);
      EXPECT_LT(distance(model_.shank_bias(leg), shank), kDifference);
    }
  }
}

TEST_F(MiniCheetahModel, MassMatrixIsSymmetricAndPositiveDefinite) {
  for (int i = 0; i < kDraws; ++i) {
    model_.update(random_.state());
    const MatDof& M = model_.mass_matrix();
    EXPECT_LT(distance(M, M.transpose()), kExact);
    // The least inertia of the robot is a rotor's, reflected: armature 0.00227 kg m^2.
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatDof>(M).eigenvalues().minCoeff(), 1e-3);
  }
}

TEST_F(MiniCheetahModel, MassesAddUpToDesign) {
  EXPECT_NEAR(model_.mass(), 3.3 + 4 * (0.54 + 0.634 + 0.064) + 12 * 0.055, 1e-12);
  model_.update(random_.state());
  EXPECT_LT(distance(model_.mass_matrix().topLeftCorner<3, 3>(), model_.mass() * Mat3::Identity()),
            kExact);
}

TEST_F(MiniCheetahModel, TrunkBlockOfTheMassMatrixIsTheInertiaAboutTheCentreOfMassMovedToTheTrunk) {
  for (int i = 0; i < kDraws; ++i) {
    const RobotState s = random_.state();
    const Vec3 p_BG = model_.com(s.joint_position);
    const Mat3 about_trunk = model_.inertia(s.joint_position) -
                             model_.mass() * skew(p_BG) * skew(p_BG);  // parallel axes
    model_.update(s);
    const Mat3 block = model_.mass_matrix().block<3, 3>(3, 3);
    EXPECT_LT(distance(block, about_trunk), kExact);
    EXPECT_LT(distance(model_.p_WG(), s.p_WB + s.R_WB * p_BG), kExact);
  }
}

TEST_F(MiniCheetahModel, BiasAtRestIsGravity) {
  for (int i = 0; i < kDraws; ++i) {
    RobotState s = random_.state();
    s.v_WB_W.setZero();
    s.w_WB_B.setZero();
    s.joint_velocity = {};
    model_.update(s);
    const VecDof gravity = model_.mass() * kGravity * model_.com_jacobian().row(2).transpose();
    EXPECT_LT(distance(model_.bias(), gravity), 1e-11);  // of up to 90 N
  }
}

TEST_F(MiniCheetahModel, KineticEnergyOfAnUnforcedRobotChangesByThePowerOfGravityOnly) {
  for (int i = 0; i < kDraws; ++i) {
    const RobotState s = random_.state();
    const VecDof nu = velocity_of(s);
    // With M nu_dot = -bias:  dT/dt = 1/2 nu' M_dot nu - nu' bias.
    const MatDof M_dot = rate(s, [&](const RobotState& at) {
      model_.update(at);
      return model_.mass_matrix();
    });
    model_.update(s);
    const double power = 0.5 * nu.dot(M_dot * nu) - nu.dot(model_.bias());
    const double gravity = -model_.mass() * kGravity * model_.v_WG_W().z();
    EXPECT_NEAR(power, gravity, 1e-4);  // kDifference times |nu|^2, about 100
  }
}

TEST_F(MiniCheetahModel, KineticEnergyOfARigidMotionIsThatOfOneBody) {
  for (int i = 0; i < kDraws; ++i) {
    RobotState s = random_.state();
    s.joint_velocity = {};
    model_.update(s);
    const VecDof nu = velocity_of(s);
    const double energy = 0.5 * nu.dot(model_.mass_matrix() * nu);
    const double translation = 0.5 * model_.mass() * model_.v_WG_W().squaredNorm();
    const double rotation = 0.5 * s.w_WB_B.dot(model_.inertia(s.joint_position) * s.w_WB_B);
    EXPECT_NEAR(energy, translation + rotation, 1e-12 * energy + 1e-12);
  }
}

TEST_F(MiniCheetahModel, HasTheLegsOfTheDesign) {
  for (const Leg leg : kLegs) {
    const LegGeometry& g = model_.legs()[leg];
    EXPECT_LT(distance(g.p_BH, Vec3(0.19 * fore_sign(leg), 0.049 * side_sign(leg), 0.0)), kExact);
    EXPECT_NEAR(g.abad_offset, 0.062 * side_sign(leg), kExact);
    EXPECT_NEAR(g.thigh, 0.215, kExact);
    EXPECT_NEAR(g.shank, 0.20, kExact);
    EXPECT_NEAR(g.foot_radius, 0.0225, kExact);
    EXPECT_EQ(g.knee_sign, -1.0);
    EXPECT_EQ(g.tau_max, Vec3(18.0, 18.0, 28.0));
    EXPECT_EQ(g.q_min, Vec3(-1.5, -3.0, -2.7));
    EXPECT_EQ(g.q_max, Vec3(1.5, 3.0, 0.0));
  }
}

TEST_F(MiniCheetahModel, CentreOfMassStandsBehindAndBelowTheTrunksOrigin) {
  const Vec3 p_BG = model_.com(PerLeg<Vec3>::filled(Vec3(0.0, 0.8596, -1.8108)));
  EXPECT_LT(distance(p_BG, Vec3(-0.008, 0.0, -0.009)), 1e-3);  // the design gives millimetres
}

TEST_F(MiniCheetahModel, IsTheSameWhateverTheOrderOfTheLegsInTheFile) {
  RobotModel reversed = RobotModel::load(write(with_legs_reversed(text_of_robot()))).value();
  const RobotState s = random_.state();
  model_.update(s);
  reversed.update(s);
  EXPECT_LT(distance(reversed.mass_matrix(), model_.mass_matrix()), kExact);
  EXPECT_LT(distance(reversed.bias(), model_.bias()), 1e-11);
  EXPECT_LT(distance(reversed.p_WG(), model_.p_WG()), kExact);
  EXPECT_LT(distance(reversed.com_jacobian(), model_.com_jacobian()), kExact);
  EXPECT_LT(distance(reversed.com_bias(), model_.com_bias()), 1e-11);
  EXPECT_LT(distance(reversed.inertia(s.joint_position), model_.inertia(s.joint_position)), kExact);
  for (const Leg leg : kLegs) {
    EXPECT_LT(distance(reversed.legs()[leg].p_BH, model_.legs()[leg].p_BH), kExact);
    EXPECT_LT(distance(reversed.foot_jacobian(leg), model_.foot_jacobian(leg)), kExact);
    EXPECT_LT(distance(reversed.foot_bias(leg), model_.foot_bias(leg)), 1e-11);
    EXPECT_LT(distance(reversed.shank_bias(leg), model_.shank_bias(leg)), 1e-11);
  }
}

TEST_F(MiniCheetahModel, CountsNothingThatStandsBesideTheRobot) {
  std::string text = text_of_robot();
  text.insert(text.find("</worldbody>"),
              "<body name=\"table\" pos=\"5 0 0\"><geom size=\"0.1\" mass=\"10\"/></body>");
  RobotModel furnished = RobotModel::load(write(text)).value();
  const PerLeg<Vec3> q = random_.state().joint_position;
  EXPECT_EQ(furnished.mass(), model_.mass());
  EXPECT_LT(distance(furnished.inertia(q), model_.inertia(q)), kExact);
}

TEST(RobotModelErrors, NameAFileThatIsNotThere) {
  expect_mentions(errors_of("/no/such/robot.xml"),
                  "/no/such/robot.xml: not a readable MJCF or URDF file");
}

TEST(RobotModelErrors, NameAFileThatIsNotMjcf) {
  const std::string path = write(text_of_robot().substr(0, 2000));
  expect_mentions(errors_of(path), path + ": not a readable MJCF or URDF file");
}

TEST(RobotModelErrors, PassOnWhatMuJoCoCannotCompile) {
  const std::string path = write(replaced(text_of_robot(), "mass=\"0.064\"", "mass=\"-1\""));
  expect_mentions(errors_of(path), path);
}

TEST(RobotModelErrors, NameRangesInRadiansThatTheFileCountsInDegrees) {
  const std::string errors =
      errors_of(write(replaced(replaced(text_of_robot(), "angle=\"radian\"", "angle=\"degree\""),
                               "range=\"-2.7 0\"", "range=\"-154.7 0\"")));
  expect_mentions(errors, "8 of 12 leg joints");
  expect_mentions(errors, "<compiler angle=\"radian\"/>");
}

TEST(RobotModel, SaysWhichJointsHaveNoTorqueLimit) {
  EXPECT_TRUE(RobotModel::load(write(text_of_robot())).value().notes().empty());
  const std::string file = write(replaced(text_of_robot(), " actuatorfrcrange=\"-28 28\"", ""));
  const std::vector<std::string> texts = RobotModel::load(file).value().notes();
  ASSERT_EQ(texts.size(), 1u);
  expect_mentions(texts[0],
                  "no torque limit of FR_knee, FL_knee, RR_knee, RL_knee: up to 1000 N m");
}

}  // namespace
}  // namespace pirouette
