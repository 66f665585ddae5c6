// From the body's motion to joint commands: whole-body control, joint friction, gains, last checks.
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

/// `last_...`: of the tick before.
struct JointControlInput {
  const RobotState& state;
  const FootContacts& contacts;
  const BodyReference& reference;
  const PerLeg<SwingTarget>& swing;
  const ContactForces& mpc;
  const JointCommand& last_command;
};

struct JointControlOutput {
  ContactForces wbc;
  JointCommand command;  ///< the last one when no forces are found or it would not be finite
  bool finite = true;    ///< false: a value of the new command was not finite
};

class JointControl {
 public:
  /// `foot_radius` (m) is the rolling foot's.
  JointControl(const WbcConfig& wbc, const MpcConfig& limits, const JointConfig& joint,
               const PerLeg<LegGeometry>& legs, double foot_radius)
      : config_(joint),
        legs_(legs),
        foot_radius_(foot_radius),
        wbc_(wbc, limits),
        guard_(joint, legs) {}

  /// `model` must have been updated at in.state.
  JointControlOutput update(const JointControlInput& in, const RobotModel& model,
                            double dt) noexcept;

  /// Starts from measured joint angles (rad) and no torque.
  void start(const PerLeg<Vec3>& measured) noexcept;

  int failures() const { return failures_; }     ///< of the whole-body QP, in a row
  double solve_us() const { return solve_us_; }  ///< us, of the last update

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, legs, foot_radius, wbc, guard, failures, solve_us] = self;
    visit(guard, failures);
  }

 private:
  JointConfig config_;
  PerLeg<LegGeometry> legs_;
  double foot_radius_;
  WholeBodyControl wbc_;
  CommandGuard guard_;
  int failures_ = 0;
  double solve_us_ = 0.0;
};

}  // namespace pirouette
