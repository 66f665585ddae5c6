#include "pirouette/controller/joint_control.hpp"

#include <gtest/gtest.h>

#include "pirouette/controller/joint_friction.hpp"
#include "pirouette/foot/leg_kinematics.hpp"
#include "support/mini_cheetah.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

/// A robot on FL and RR that swings FR and RL; what is commanded once the torque filter has
/// settled.
JointCommand command(double compensation) {
  static RobotModel model = RobotModel::load(test::kRobot).value();
  RobotState state;
  state.p_WB.z() = 0.29;
  FootContacts contacts;
  PerLeg<SwingTarget> swing{};
  ContactForces mpc;
  for (const Leg leg : kLegs) {
    const LegGeometry& g = model.legs()[leg];
    state.joint_position[leg] = inverse_kinematics(g, Vec3(0.0, g.abad_offset, -0.26)).q;
    const FootState foot = foot_state(g, state.joint_position[leg], Vec3::Zero());
    state.p_WF[leg] = state.p_WB + foot.p_BF;
    const bool stance = leg == Leg::kFL || leg == Leg::kRR;
    contacts[leg].in_contact = stance;
    contacts[leg].p_WC = state.p_WF[leg] - Vec3(0.0, 0.0, g.foot_radius);
    swing[leg].p_WF = state.p_WF[leg];
    swing[leg].v_WF_W = stance ? Vec3::Zero().eval() : Vec3(0.5, -0.2, 0.7);
    mpc.f_W[leg] = stance ? Vec3(0.0, 0.0, 0.5 * model.mass() * kGravity) : Vec3::Zero().eval();
  }
  model.update(state);
  state.p_WG = model.p_WG();
  BodyReference reference;
  reference.p_WG = state.p_WG;
  JointConfig config;
  config.friction_compensation = compensation;
  JointControl control(WbcConfig{}, MpcConfig{}, config, model.legs(),
                       PerLeg<double>::filled(0.0225));
  control.start(state.joint_position);
  JointCommand last;
  for (int i = 0; i < 200; ++i) {
    const JointControlOutput out =
        control.update({state, contacts, reference, swing, mpc, last}, model, 0.002);
    EXPECT_TRUE(out.finite);
    EXPECT_EQ(control.failures(), 0);
    last = out.command;
  }
  return last;
}

TEST(JointControl, AddsTheFrictionOfTheMotionThatItAsksForOnce) {
  const PerLeg<LegGeometry> legs = RobotModel::load(test::kRobot).value().legs();
  const JointCommand without = command(0.0), half = command(0.5), with = command(1.0);
  for (const Leg leg : {Leg::kFR, Leg::kRL}) {
    const Vec3 friction = joint_friction(legs[leg], with[leg].dq);
    EXPECT_GT(friction.cwiseAbs().minCoeff(), 0.01);  // every joint moves
    EXPECT_LT(distance(with[leg].tau - without[leg].tau, friction), 1e-9);
    EXPECT_LT(distance(half[leg].tau - without[leg].tau, (0.5 * friction).eval()), 1e-9);
  }
}

}  // namespace
}  // namespace pirouette
