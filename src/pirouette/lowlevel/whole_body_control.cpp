#include "pirouette/lowlevel/whole_body_control.hpp"

#include <Eigen/LU>

#include "pirouette/base/rotation.hpp"
#include "pirouette/lowlevel/friction_pyramid.hpp"

namespace pirouette {

namespace {

constexpr int kTrunkDof = 6;

int first_column(Leg leg) { return kTrunkDof + 3 * static_cast<int>(index(leg)); }

/// Rotation vector, world axes, from the measured to the referenced attitude.
Vec3 attitude_error_W(const WbcInput& in) {
  return log_so3(rotation_from_rpy(in.reference.rpy) * in.state.R_WB.transpose());
}

}  // namespace

Mat3 damped_inverse(const Mat3& J, const RobotScale& scale) noexcept {
  // Of a robot of scale 1.
  constexpr double kSingular = 2e-4;  // m^3
  constexpr double kDamping = 0.05;   // m
  const double singular = kSingular * scale.volume();
  const double det = J.determinant();
  if (std::abs(det) >= singular) return J.inverse();
  const double damping2 = square(kDamping * scale.length) * (1.0 - square(det / singular));
  const Mat3 JJt = J * J.transpose() + damping2 * Mat3::Identity();
  return J.transpose() * JJt.inverse();
}

WholeBodyControl::WholeBodyControl(const WbcConfig& config, const MpcConfig& limits,
                                   const RobotScale& scale)
    : config_(config),
      limits_(limits),
      scale_(scale),
      solver_(3, kPyramidRows, static_cast<int>(kLegCount), limits.max_iterations) {}

void WholeBodyControl::map_legs(const WbcInput& in, const RobotModel& model) noexcept {
  for (const Leg leg : kLegs) {
    LegMap& m = legs_[leg];
    Jacobian J = model.foot_jacobian(leg);
    Vec3 task;
    if (in.contacts[leg].in_contact) {
      // The material contact point accelerates like a rolling sphere's (E13), not like a fixed
      // point.
      const Mat3 arm = in.contact_radius[leg] * skew(in.contacts[leg].n_W);
      J += arm * model.shank_jacobian(leg);
      task = -model.foot_bias(leg) - arm * model.shank_bias(leg);
    } else {
      const SwingTarget& target = in.swing[leg];
      task = target.a_WF_W + config_.swing_kp * (target.p_WF - in.state.p_WF[leg]) +
             config_.swing_kd * (target.v_WF_W - in.state.v_WF_W[leg]) - model.foot_bias(leg);
    }
    m.J_trunk = J.leftCols<kTrunkDof>();
    m.J_leg = J.middleCols<3>(first_column(leg));
    m.J_leg_inverse = damped_inverse(m.J_leg, scale_);
    m.c = m.J_leg_inverse * task;
    m.D = m.J_leg_inverse * m.J_trunk;
  }
}

Vec6 WholeBodyControl::desired_trunk_acceleration(const WbcInput& in,
                                                  const RobotModel& model) const noexcept {
  const BodyReference& reference = in.reference;
  const Vec3 w_error_W = reference.w_WB_W - in.state.w_WB_W();
  const Vec3 angular_W =
      config_.orientation_kp * attitude_error_W(in) + config_.orientation_kd * w_error_W;

  const Vec3 kp(config_.position_kp_xy, config_.position_kp_xy, config_.position_kp_z);
  const Vec3 kd(config_.position_kd_xy, config_.position_kd_xy, config_.position_kd_z);
  Vec3 linear_W = reference.a_WG_W + kp.cwiseProduct(reference.p_WG - in.state.p_WG) +
                  kd.cwiseProduct(reference.v_WG_W - in.state.v_WG_W) - model.com_bias();

  // The CoM's Jacobian with the joints' part folded into the trunk's.
  const Jacobian& J_com = model.com_jacobian();
  Mat36 J = J_com.leftCols<kTrunkDof>();
  for (const Leg leg : kLegs) {
    const Mat3 J_leg = J_com.middleCols<3>(first_column(leg));
    J -= J_leg * legs_[leg].D;
    linear_W -= J_leg * legs_[leg].c;
  }
  Vec6 a;
  a.tail<3>() = in.state.R_WB.transpose() * angular_W;
  const Vec3 rest = linear_W - J.rightCols<3>() * a.tail<3>();
  a.head<3>() = J.leftCols<3>().inverse() * rest;
  return a;
}

ContactForces WholeBodyControl::refine_forces(const WbcInput& in, const Mat6& A, const Vec6& b,
                                              const Vec6& a_desired) noexcept {
  PerLeg<int> position = PerLeg<int>::filled(-1);
  int count = 0;
  for (const Leg leg : kLegs) {
    if (in.contacts[leg].in_contact) position[leg] = count++;
  }
  ContactForces out;
  if (count == 0) return out;

  // Trunk acceleration by the forces f:  a = G f - A^-1 b.
  const Eigen::PartialPivLU<Mat6> lu(A);
  const Vec6 a_missing = a_desired + lu.solve(b);
  PerLeg<Eigen::Matrix<double, 6, 3>> G{};
  QpSolver::Problem& qp = solver_.prepare(count);
  const FrictionPyramid pyramid(in.n_W, limits_.friction, limits_.min_normal_force,
                                limits_.max_normal_force);
  for (const Leg leg : kLegs) {
    if (position[leg] < 0) continue;
    const int i = position[leg];
    const Eigen::Matrix<double, 6, 3> wrench = legs_[leg].J_trunk.transpose();
    G[leg] = lu.solve(wrench);
    qp.g.segment<3>(3 * i) = -config_.weight_force * in.mpc.f_W[leg] -
                             config_.weight_acceleration * (G[leg].transpose() * a_missing);
    qp.C.block<kPyramidRows, 3>(kPyramidRows * i, 3 * i) = pyramid.C;
    qp.lower.segment<kPyramidRows>(kPyramidRows * i) = pyramid.lower;
  }
  for (const Leg row : kLegs) {
    for (const Leg column : kLegs) {
      if (position[row] < 0 || position[column] < 0) continue;
      Mat3 block = config_.weight_acceleration * (G[row].transpose() * G[column]);
      if (row == column) block.diagonal().array() += config_.weight_force;
      qp.H.block<3, 3>(3 * position[row], 3 * position[column]) = block;
    }
  }
  const QpSolution solution = solver_.solve();
  out.status = solution.status;
  out.iterations = solution.iterations;
  for (const Leg leg : kLegs) {
    if (position[leg] >= 0) out.f_W[leg] = qp.x.segment<3>(3 * position[leg]);
  }
  return out;
}

void WholeBodyControl::joint_targets(const WbcInput& in, WbcOutput& out) const noexcept {
  const BodyReference& reference = in.reference;
  const RobotState& state = in.state;
  // Trunk displacement and velocity that bring CoM and attitude to their references.
  const Vec3 turn_W = attitude_error_W(in);
  const Vec3 p_BG_W = state.p_WG - state.p_WB;
  Vec6 displacement, velocity;
  displacement << reference.p_WG - state.p_WG - turn_W.cross(p_BG_W),
      state.R_WB.transpose() * turn_W;
  velocity << reference.v_WG_W - reference.w_WB_W.cross(p_BG_W),
      state.R_WB.transpose() * reference.w_WB_W;

  for (const Leg leg : kLegs) {
    const LegMap& m = legs_[leg];
    Vec3 foot_displacement = Vec3::Zero(), foot_velocity = Vec3::Zero();
    if (!in.contacts[leg].in_contact) {
      foot_displacement = in.swing[leg].p_WF - state.p_WF[leg];
      foot_velocity = in.swing[leg].v_WF_W;
    }
    out.q[leg] = state.joint_position[leg] +
                 m.J_leg_inverse * (foot_displacement - m.J_trunk * displacement);
    out.dq[leg] = m.J_leg_inverse * (foot_velocity - m.J_trunk * velocity);
  }
}

WbcOutput WholeBodyControl::update(const WbcInput& in, const RobotModel& model) noexcept {
  WbcOutput out;
  map_legs(in, model);
  const Vec6 a_desired = desired_trunk_acceleration(in, model);

  // Trunk dynamics with the joints' accelerations substituted:  A a + b = sum of J_trunk' f.
  const MatDof& M = model.mass_matrix();
  const VecDof& h = model.bias();
  Mat6 A = M.topLeftCorner<kTrunkDof, kTrunkDof>();
  Vec6 b = h.head<kTrunkDof>();
  for (const Leg leg : kLegs) {
    const Eigen::Matrix<double, 6, 3> M_leg = M.block<kTrunkDof, 3>(0, first_column(leg));
    A -= M_leg * legs_[leg].D;
    b += M_leg * legs_[leg].c;
  }
  out.forces = refine_forces(in, A, b, a_desired);

  Vec6 wrench = -b;
  for (const Leg leg : kLegs) {
    if (in.contacts[leg].in_contact) wrench += legs_[leg].J_trunk.transpose() * out.forces.f_W[leg];
  }
  out.trunk_acceleration = A.partialPivLu().solve(wrench);

  for (const Leg leg : kLegs) {
    const LegMap& m = legs_[leg];
    const int column = first_column(leg);
    const Vec3 ddq = m.c - m.D * out.trunk_acceleration;
    out.joint_acceleration[leg] = ddq;
    out.tau[leg] = M.block<3, kTrunkDof>(column, 0) * out.trunk_acceleration +
                   M.block<3, 3>(column, column) * ddq + h.segment<3>(column);
    if (in.contacts[leg].in_contact) out.tau[leg] -= m.J_leg.transpose() * out.forces.f_W[leg];
  }
  joint_targets(in, out);
  return out;
}

}  // namespace pirouette
