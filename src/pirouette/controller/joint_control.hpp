// Joint commands from the body reference: whole-body control, joint friction, gains, command
// checks.
#pragma once

#include "pirouette/controller/command_guard.hpp"
#include "pirouette/controller/joint_config.hpp"
#include "pirouette/lowlevel/whole_body_control.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/contact_forces.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/leg_geometry.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/swing_target.hpp"

namespace pirouette {

/// Input of JointControl::update(). `last_...`: of the tick before.
struct JointControlInput {
  const RobotState& state;           ///< estimated state of the robot
  const FootContacts& contacts;      ///< contact of each foot
  const BodyReference& reference;    ///< body reference
  const PerLeg<SwingTarget>& swing;  ///< swing targets
  const ContactForces& mpc;          ///< forces planned by the MPC
  const JointCommand& last_command;  ///< joint command sent
};

/// Output of JointControl::update().
struct JointControlOutput {
  ContactForces wbc;     ///< forces of the whole-body control
  JointCommand command;  ///< the last one when no forces are found or the new one is not finite
  bool finite = true;    ///< false: a value of the new command was not finite
};

/// Computes the joint command of each tick.
class JointControl {
 public:
  /// `contact_radius` (m) of the rolling feet; 0 of a point foot.
  JointControl(const WbcConfig& wbc, const MpcConfig& limits, const JointConfig& joint,
               const PerLeg<LegGeometry>& legs, const PerLeg<double>& contact_radius,
               const RobotScale& scale = {})
      : config_(joint),
        legs_(legs),
        contact_radius_(contact_radius),
        wbc_(wbc, limits, scale),
        guard_(joint, legs) {}

  /// Joint command after one tick of `dt` (s). `model` must have been updated at in.state.
  JointControlOutput update(const JointControlInput& in, const RobotModel& model,
                            double dt) noexcept;

  /// Starts from the `measured` joint angles (rad) and no torque.
  void start(const PerLeg<Vec3>& measured) noexcept;

  int failures() const { return failures_; }     ///< failures of the whole-body QP in a row
  double solve_us() const { return solve_us_; }  ///< us, of the last update

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, legs, contact_radius, wbc, guard, failures, solve_us] = self;
    visit(guard, failures);
  }

 private:
  JointConfig config_;
  PerLeg<LegGeometry> legs_;
  PerLeg<double> contact_radius_;
  WholeBodyControl wbc_;
  CommandGuard guard_;
  int failures_ = 0;
  double solve_us_ = 0.0;
};

}  // namespace pirouette
