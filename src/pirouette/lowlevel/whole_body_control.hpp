// Whole-body control: contact-consistent accelerations, refined contact forces, joint torques.
#pragma once
#include "pirouette/lowlevel/mpc_config.hpp"
#include "pirouette/lowlevel/qp_solver.hpp"
#include "pirouette/lowlevel/wbc_config.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/contact_forces.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/robot_scale.hpp"
#include "pirouette/types/swing_target.hpp"

namespace pirouette {

/// Input of WholeBodyControl::update().
struct WbcInput {
  RobotState state;                 ///< estimated state of the robot
  BodyReference reference;          ///< body reference
  PerLeg<SwingTarget> swing{};      ///< swing targets
  FootContacts contacts;            ///< contact of each foot
  ContactForces mpc;                ///< forces of the MPC
  PerLeg<double> contact_radius{};  ///< m, of the rolling feet; 0 of a point foot
  Vec3 n_W = Vec3::UnitZ();         ///< unit normal of the ground, for the friction pyramids
};

/// Output of WholeBodyControl::update().
struct WbcOutput {
  ContactForces forces;                    ///< refined forces on the robot
  Vec6 trunk_acceleration = Vec6::Zero();  ///< [m/s^2 world; rad/s^2 body]
  PerLeg<Vec3> joint_acceleration{};       ///< rad/s^2
  PerLeg<Vec3> tau{};                      ///< N m, inverse dynamics
  PerLeg<Vec3> q{};                        ///< rad, joint targets of the kinematic level
  PerLeg<Vec3> dq{};                       ///< rad/s, their velocities
};

/// [Kim19], solved by legs: docs/decisions/003-whole-body-control.md,
/// docs/equations.md#whole-body-control.
///
/// The task hierarchy contacts > trunk orientation > CoM position > swing feet has 18 rows for 18
/// accelerations: with no leg singular it has one solution, from one 3x3 solve per leg and one 6x6
/// solve, equal to that of null-space projections. A small QP then trades the MPC's forces
/// against the trunk acceleration those forces produce with contact-consistent joints.
class WholeBodyControl {
 public:
  /// `limits` holds friction, normal forces and the iteration cap.
  WholeBodyControl(const WbcConfig& config, const MpcConfig& limits, const RobotScale& scale = {});

  /// `model` must have been updated at in.state.
  WbcOutput update(const WbcInput& in, const RobotModel& model) noexcept;

 private:
  using Mat36 = Eigen::Matrix<double, 3, 6>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;

  /// A leg's joint acceleration as an affine function of the trunk's: c - D a.
  struct LegMap {
    Mat36 J_trunk;       ///< task Jacobian, trunk columns
    Mat3 J_leg;          ///< task Jacobian, the leg's own columns
    Mat3 J_leg_inverse;  ///< damped near singularities
    Vec3 c;
    Mat36 D;
  };

  void map_legs(const WbcInput& in, const RobotModel& model) noexcept;
  Vec6 desired_trunk_acceleration(const WbcInput& in, const RobotModel& model) const noexcept;
  ContactForces refine_forces(const WbcInput& in, const Mat6& A, const Vec6& b,
                              const Vec6& a_desired) noexcept;
  void joint_targets(const WbcInput& in, WbcOutput& out) const noexcept;

  WbcConfig config_;
  MpcConfig limits_;
  RobotScale scale_;
  QpSolver solver_;
  PerLeg<LegMap> legs_{};
};

/// Inverse of a leg's 3x3 Jacobian, damped where |det| < 2e-4 m^3 (equations.md section 2).
Mat3 damped_inverse(const Mat3& J, const RobotScale& scale = {}) noexcept;

}  // namespace pirouette
