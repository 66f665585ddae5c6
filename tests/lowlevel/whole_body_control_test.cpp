#include "pirouette/lowlevel/whole_body_control.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <utility>
#include <vector>

#include "pirouette/foot/leg_kinematics.hpp"
#include "pirouette/lowlevel/friction_pyramid.hpp"
#include "support/mini_cheetah.hpp"
#include "support/random_robot.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::leg_column;
using test::velocity_of;

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kDraws = 20;
constexpr double kRadius = 0.0225;

const PerLeg<bool> kAllFeet = PerLeg<bool>::filled(true);

PerLeg<bool> trot_pair() {
  PerLeg<bool> pair;
  pair[Leg::kFR] = pair[Leg::kRL] = true;
  return pair;
}

PerLeg<bool> all_but(Leg leg) {
  PerLeg<bool> feet = kAllFeet;
  feet[leg] = false;
  return feet;
}

/// Feet may push in any direction, and only push.
MpcConfig without_limits() {
  MpcConfig limits;
  limits.friction = 1e3;
  limits.max_normal_force = 1e9;
  return limits;
}

class WholeBody : public testing::Test {
 protected:
  /// Any motion, references and swing targets near it, contacts of feet in `stance`; `vigour`
  /// scales velocities and what is asked for.
  WbcInput random_input(const PerLeg<bool>& stance, double vigour = 1.0) {
    WbcInput in;
    in.state = random_.state();
    in.state.v_WB_W *= vigour;
    in.state.w_WB_B *= vigour;
    for (Vec3& dq : in.state.joint_velocity) dq *= vigour;
    in.state.R_WB = exp_so3(random_.vec3(0.3));
    in.state.rpy = rpy_from_rotation(in.state.R_WB);
    in.contact_radius = PerLeg<double>::filled(kRadius);
    in.n_W = (Vec3::UnitZ() + random_.vec3(0.2)).normalized();
    complete(in, stance);
    in.reference.p_WG = in.state.p_WG + vigour * random_.vec3(0.02);
    in.reference.v_WG_W = in.state.v_WG_W + vigour * random_.vec3(0.2);
    in.reference.a_WG_W = vigour * random_.vec3(0.5);
    in.reference.rpy = {in.state.rpy.roll + 0.02 * vigour, in.state.rpy.pitch - 0.03 * vigour,
                        in.state.rpy.yaw + 0.1 * vigour};
    in.reference.w_WB_W = in.state.w_WB_W() + vigour * random_.vec3(0.3);
    for (const Leg leg : kLegs) {
      in.swing[leg] = {in.state.p_WF[leg] + vigour * random_.vec3(0.02),
                       in.state.v_WF_W[leg] + vigour * random_.vec3(0.3),
                       vigour * random_.vec3(5.0)};
      in.mpc.f_W[leg] = Vec3(0.0, 0.0, 30.0) + random_.vec3(5.0);
    }
    return in;
  }

  /// The robot at rest in its nominal posture, which is also the reference.
  WbcInput standing() {
    WbcInput in;
    in.state.joint_position = PerLeg<Vec3>::filled(Vec3(0.0, 0.8596, -1.8108));
    in.contact_radius = PerLeg<double>::filled(kRadius);
    complete(in, kAllFeet);
    in.reference.p_WG = in.state.p_WG;
    for (const Leg leg : kLegs) in.mpc.f_W[leg].z() = 0.25 * model_.mass() * kGravity;
    return in;
  }

  /// What follows from trunk and joints: CoM, feet, contacts; leaves the model at the state.
  void complete(WbcInput& in, const PerLeg<bool>& stance) {
    RobotState& s = in.state;
    model_.update(s);
    s.p_WG = model_.p_WG();
    s.v_WG_W = model_.v_WG_W();
    for (const Leg leg : kLegs) {
      const FootState f =
          foot_state(model_.legs()[leg], s.joint_position[leg], s.joint_velocity[leg]);
      s.p_WF[leg] = s.p_WB + s.R_WB * f.p_BF;
      s.v_WF_W[leg] = model_.foot_jacobian(leg) * velocity_of(s);
      in.contacts[leg].in_contact = in.contacts[leg].measured = stance[leg];
      in.contacts[leg].n_W = in.n_W;
      in.contacts[leg].p_WC = s.p_WF[leg] - in.contact_radius[leg] * in.n_W;
    }
  }

  Jacobian contact_jacobian(const WbcInput& in, Leg leg) const {
    return model_.foot_jacobian(leg) +
           in.contact_radius[leg] * skew(in.contacts[leg].n_W) * model_.shank_jacobian(leg);
  }

  /// Part of the contact's acceleration that velocities make (equations.md 4.7).
  Vec3 contact_bias(const WbcInput& in, Leg leg) const {
    return model_.foot_bias(leg) +
           in.contact_radius[leg] * skew(in.contacts[leg].n_W) * model_.shank_bias(leg);
  }

  Vec3 swing_acceleration(const WbcInput& in, Leg leg) const {
    return in.swing[leg].a_WF_W + config_.swing_kp * (in.swing[leg].p_WF - in.state.p_WF[leg]) +
           config_.swing_kd * (in.swing[leg].v_WF_W - in.state.v_WF_W[leg]);
  }

  static VecDof acceleration(const WbcOutput& out) {
    VecDof a;
    a << out.trunk_acceleration, out.joint_acceleration[Leg::kFR], out.joint_acceleration[Leg::kFL],
        out.joint_acceleration[Leg::kRR], out.joint_acceleration[Leg::kRL];
    return a;
  }

  VecDof by_null_space_projections(const WbcInput& in) const;

  RobotModel model_ = RobotModel::load(test::kRobot).value();
  WbcConfig config_;
  test::RandomRobot random_{17};
};

/// [Kim19] Eqs. (14)-(17): each task acts in the null space of those before it, with dynamically
/// consistent pseudo-inverses. Contacts, trunk orientation, CoM, swing feet.
VecDof WholeBody::by_null_space_projections(const WbcInput& in) const {
  struct Task {
    MatrixXd J;
    VectorXd acceleration;  ///< without the bias: J nu_dot of this task
  };
  std::vector<Task> tasks(1);
  for (const Leg leg : kLegs) {
    if (!in.contacts[leg].in_contact) continue;
    Task& contacts = tasks.front();
    const Eigen::Index row = contacts.J.rows();
    contacts.J.conservativeResize(row + 3, kDof);
    contacts.J.bottomRows(3) = contact_jacobian(in, leg);
    contacts.acceleration.conservativeResize(row + 3);
    contacts.acceleration.tail(3) = -contact_bias(in, leg);
  }
  Jacobian turn = Jacobian::Zero();
  turn.middleCols<3>(3) = in.state.R_WB;  // R w_dot_B: the rate of w_WB_W, since w x w = 0
  const Vec3 attitude_error =
      log_so3(rotation_from_rpy(in.reference.rpy) * in.state.R_WB.transpose());
  tasks.push_back({turn, config_.orientation_kp * attitude_error +
                             config_.orientation_kd * (in.reference.w_WB_W - in.state.w_WB_W())});
  const Vec3 kp(config_.position_kp_xy, config_.position_kp_xy, config_.position_kp_z);
  const Vec3 kd(config_.position_kd_xy, config_.position_kd_xy, config_.position_kd_z);
  tasks.push_back({model_.com_jacobian(),
                   in.reference.a_WG_W + kp.cwiseProduct(in.reference.p_WG - in.state.p_WG) +
                       kd.cwiseProduct(in.reference.v_WG_W - in.state.v_WG_W) - model_.com_bias()});
  for (const Leg leg : kLegs) {
    if (in.contacts[leg].in_contact) continue;
    tasks.push_back(
        {model_.foot_jacobian(leg), swing_acceleration(in, leg) - model_.foot_bias(leg)});
  }

  const MatDof M_inverse = model_.mass_matrix().inverse();
  VecDof nu_dot = VecDof::Zero();
  MatDof null_space = MatDof::Identity();
  for (const Task& task : tasks) {
    const MatrixXd J = task.J * null_space;
    const MatrixXd weighted = M_inverse * J.transpose();
    const MatrixXd pseudo_inverse =
        weighted * (J * weighted).completeOrthogonalDecomposition().pseudoInverse();
    nu_dot += pseudo_inverse * (task.acceleration - task.J * nu_dot);
    null_space = (null_space * (MatDof::Identity() - pseudo_inverse * J)).eval();
  }
  return nu_dot;
}

TEST_F(WholeBody, TorquesForcesAndAccelerationsObeyTheEquationsOfMotion) {
  WholeBodyControl wbc(config_, MpcConfig{});
  for (const PerLeg<bool>& stance : {kAllFeet, trot_pair(), all_but(Leg::kFL), PerLeg<bool>{}}) {
    for (int i = 0; i < kDraws; ++i) {
      const WbcInput in = random_input(stance);
      const WbcOutput out = wbc.update(in, model_);
      ASSERT_NE(out.forces.status, SolveStatus::kFailed);
      VecDof residual = model_.mass_matrix() * acceleration(out) + model_.bias();
      for (const Leg leg : kLegs) {
        residual.segment<3>(leg_column(leg)) -= out.tau[leg];
        if (stance[leg]) residual -= contact_jacobian(in, leg).transpose() * out.forces.f_W[leg];
      }
      // Rounding of terms up to 10^3 N m.
      EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-9);
    }
  }
}

TEST_F(WholeBody, StanceFeetAccelerateAsRollingSpheresDo) {
  WholeBodyControl wbc(config_, MpcConfig{});
  for (const PerLeg<bool>& stance : {kAllFeet, trot_pair()}) {
    for (int i = 0; i < kDraws; ++i) {
      const WbcInput in = random_input(stance);
      const VecDof nu_dot = acceleration(wbc.update(in, model_));
      for (const Leg leg : kLegs) {
        if (!stance[leg]) continue;
        // a_c = alpha_shank x r n; 1e-9 of accelerations up to 10^3 m/s^2.
        const Vec3 centre = model_.foot_jacobian(leg) * nu_dot + model_.foot_bias(leg);
        const Vec3 shank = model_.shank_jacobian(leg) * nu_dot + model_.shank_bias(leg);
        EXPECT_LT(distance(centre, shank.cross(kRadius * in.n_W)), 1e-9);
      }
    }
  }
}

TEST_F(WholeBody, SwingFeetAccelerateAsTheirTargetsAsk) {
  WholeBodyControl wbc(config_, MpcConfig{});
  for (int i = 0; i < kDraws; ++i) {
    const WbcInput in = random_input(trot_pair());
    const VecDof nu_dot = acceleration(wbc.update(in, model_));
    for (const Leg leg : {Leg::kFL, Leg::kRR}) {
      const Vec3 a_WF_W = model_.foot_jacobian(leg) * nu_dot + model_.foot_bias(leg);
      EXPECT_LT(distance(a_WF_W, swing_acceleration(in, leg)), 1e-9);
    }
  }
}

TEST_F(WholeBody, IsTheNullSpaceHierarchyWhenForcesAreFree) {
  config_.weight_acceleration = 1e6;
  config_.weight_force = 1e-4;
  WholeBodyControl wbc(config_, without_limits());
  for (const PerLeg<bool>& stance : {kAllFeet, all_but(Leg::kRR)}) {
    int compared = 0;
    for (int i = 0; i < 10 * kDraws; ++i) {
      const WbcInput in = random_input(stance, 0.1);
      const WbcOutput out = wbc.update(in, model_);
      if (out.forces.status != SolveStatus::kUnconstrained) continue;  // a foot would have to pull
      ++compared;
      // 1e-10 is the ratio of the weights; the feet's lever arms enter by their inverse square.
      EXPECT_LT(distance(acceleration(out), by_null_space_projections(in)), 1e-5);  // rad/s^2
    }
    EXPECT_GT(compared, kDraws);
  }
}

TEST_F(WholeBody, KeepsTheForcesOfTheMpcWhenAccelerationIsCheap) {
  config_.weight_acceleration = 1e-6;
  WholeBodyControl wbc(config_, without_limits());
  const WbcInput in = random_input(kAllFeet);
  const WbcOutput out = wbc.update(in, model_);
  for (const Leg leg : kLegs) {
    // The trunk's acceleration error, some 10^2, times 1 / mass or arm / inertia, times the weight.
    EXPECT_LT(distance(out.forces.f_W[leg], in.mpc.f_W[leg]), 0.01);
  }
}

TEST_F(WholeBody, StandsStillWhenTheForcesBalanceTheRobot) {
  config_.weight_acceleration = 1e6;
  WholeBodyControl wbc(config_, MpcConfig{});
  const WbcInput in = standing();
  const WbcOutput out = wbc.update(in, model_);
  EXPECT_LT(acceleration(out).cwiseAbs().maxCoeff(), 1e-3);
  Vec3 f_W = Vec3::Zero();
  for (const Leg leg : kLegs) {
    f_W += out.forces.f_W[leg];
    EXPECT_LT(distance(out.q[leg], in.state.joint_position[leg]), 1e-12);
    EXPECT_LT(out.dq[leg].norm(), 1e-12);
  }
  EXPECT_LT(distance(f_W, model_.mass() * kGravity * Vec3::UnitZ()), 1e-2);
}

TEST_F(WholeBody, JointTargetsCarryTheBodyToItsReferenceOverFeetThatStay) {
  WholeBodyControl wbc(config_, MpcConfig{});
  WbcInput in = standing();
  constexpr double kShift = 1e-3;
  in.reference.p_WG += kShift * Vec3(1.0, -0.5, 0.7);
  in.reference.rpy = {0.5 * kShift, -kShift, kShift};
  const WbcOutput out = wbc.update(in, model_);
  const Mat3 R_WB = rotation_from_rpy(in.reference.rpy);
  const Vec3 p_WB = in.reference.p_WG - R_WB * (in.state.p_WG - in.state.p_WB);
  for (const Leg leg : kLegs) {
    const FootState foot = foot_state(model_.legs()[leg], out.q[leg], Vec3::Zero());
    const Vec3 shank_turn =
        log_so3(R_WB * foot.R_BS * shank_rotation(in.state.joint_position[leg]).transpose());
    const Vec3 rolled = kRadius * shank_turn.cross(Vec3::UnitZ());
    // First order in the shift: what is left is about shift^2 / leg length.
    EXPECT_LT(distance(p_WB + R_WB * foot.p_BF, in.state.p_WF[leg] + rolled),
              30.0 * kShift * kShift);
  }
}

TEST_F(WholeBody, KeepsEveryForceInTheFrictionPyramid) {
  MpcConfig limits;
  limits.friction = 0.4;
  WholeBodyControl wbc(config_, limits);
  int constrained = 0;
  for (int i = 0; i < 10 * kDraws; ++i) {
    const WbcInput in = random_input(i % 2 == 0 ? kAllFeet : trot_pair());
    const WbcOutput out = wbc.update(in, model_);
    ASSERT_NE(out.forces.status, SolveStatus::kFailed);
    constrained += out.forces.status == SolveStatus::kConstrained;
    const FrictionPyramid pyramid(in.n_W, limits.friction, limits.min_normal_force,
                                  limits.max_normal_force);
    for (const Leg leg : kLegs) {
      const Vec3& f_W = out.forces.f_W[leg];
      if (in.contacts[leg].in_contact) {
        EXPECT_GT((pyramid.C * f_W - pyramid.lower).minCoeff(),
                  -1e-6);  // the solver's tolerance, N
      } else {
        EXPECT_EQ(f_W, Vec3::Zero());
      }
    }
  }
  EXPECT_GT(constrained, kDraws);
}

TEST_F(WholeBody, WithoutContactsTheCentreOfMassFallsFreely) {
  WholeBodyControl wbc(config_, MpcConfig{});
  for (int i = 0; i < kDraws; ++i) {
    const WbcInput in = random_input(PerLeg<bool>{});
    const WbcOutput out = wbc.update(in, model_);
    EXPECT_EQ(out.forces.status, SolveStatus::kUnconstrained);
    const Vec3 a_WG_W = model_.com_jacobian() * acceleration(out) + model_.com_bias();
    EXPECT_LT(distance(a_WG_W, Vec3(0.0, 0.0, -kGravity)), 1e-9);
    for (const Vec3& f_W : out.forces.f_W) EXPECT_EQ(f_W, Vec3::Zero());
  }
}

TEST_F(WholeBody, ReportsForcesThatCannotBeFound) {
  MpcConfig limits;
  limits.min_normal_force = 100.0;
  limits.max_normal_force = 50.0;
  WholeBodyControl wbc(config_, limits);
  EXPECT_EQ(wbc.update(random_input(kAllFeet), model_).forces.status, SolveStatus::kFailed);
}

TEST_F(WholeBody, StaysFiniteWithStraightLegs) {
  WholeBodyControl wbc(config_, MpcConfig{});
  for (const double knee : {0.0, -1e-9, -1e-3, -0.05}) {
    WbcInput in = standing();
    in.state.joint_position = PerLeg<Vec3>::filled(Vec3(0.0, 0.0, knee));
    complete(in, trot_pair());
    in.swing[Leg::kFL].p_WF = in.state.p_WF[Leg::kFL] + Vec3(0.0, 0.0, 0.05);
    const WbcOutput out = wbc.update(in, model_);
    EXPECT_TRUE(acceleration(out).allFinite());
    for (const Leg leg : kLegs) {
      EXPECT_TRUE(out.tau[leg].allFinite());
      EXPECT_TRUE(out.q[leg].allFinite());
      EXPECT_TRUE(out.dq[leg].allFinite());
    }
  }
}

TEST(DampedInverse, IsTheInverseAwayFromSingularPostures) {
  const LegGeometry leg = test::paper_leg(Leg::kFR);
  const Mat3 J = foot_jacobian(leg, Vec3(0.2, 0.8, -1.6));
  EXPECT_LT(distance(damped_inverse(J) * J, Mat3::Identity()), 1e-12);
}

TEST(DampedInverse, NeverAmplifiesMoreThanItsDampingAllowsAtSingularPostures) {
  const LegGeometry leg = test::paper_leg(Leg::kRL);
  for (const double knee : {0.0, -1e-12, -1e-6, -1e-3}) {
    const Mat3 inverse = damped_inverse(foot_jacobian(leg, Vec3(0.1, 0.0, knee)));
    // s / (s^2 + 0.05^2) <= 10 for every singular value s.
    EXPECT_LE(inverse.operatorNorm(), 10.0 + 1e-2);
  }
}

TEST(DampedInverse, IsContinuousWhereDampingSetsIn) {
  // Two sides of |det| = 2e-4 m^3.
  const Mat3 base = Vec3(0.1, 0.1, 0.02).asDiagonal();
  const Mat3 inside = damped_inverse(base * (1.0 - 1e-9)),
             outside = damped_inverse(base * (1.0 + 1e-9));
  EXPECT_LT(distance(inside, outside), 1e-3 * outside.norm());
}

}  // namespace
}  // namespace pirouette
