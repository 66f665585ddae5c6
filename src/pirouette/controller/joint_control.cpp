#include "pirouette/controller/joint_control.hpp"

#include "pirouette/base/stopwatch.hpp"
#include "pirouette/controller/joint_friction.hpp"

namespace pirouette {

JointControlOutput JointControl::update(const JointControlInput& in, const RobotModel& model,
                                        double dt) noexcept {
  const Stopwatch watch;
  WbcInput wbc_in;
  wbc_in.state = in.state;
  wbc_in.reference = in.reference;
  wbc_in.swing = in.swing;
  wbc_in.contacts = in.contacts;
  wbc_in.mpc = in.mpc;
  wbc_in.contact_radius = contact_radius_;
  wbc_in.n_W = in.contacts[Leg::kFR].n_W;
  const WbcOutput solution = wbc_.update(wbc_in, model);
  solve_us_ = watch.microseconds();

  JointControlOutput out{solution.forces, in.last_command};
  if (solution.forces.status == SolveStatus::kFailed) {
    ++failures_;
    out.wbc.status = SolveStatus::kHeld;
    return out;
  }
  failures_ = 0;
  JointCommand raw;
  for (const Leg leg : kLegs) {
    const bool stance = in.contacts[leg].in_contact;
    LegCommand& c = raw[leg];
    c.q = solution.q[leg];
    c.dq = solution.dq[leg];
    c.tau = solution.tau[leg] +
            config_.friction_compensation * joint_friction(legs_[leg], solution.dq[leg]);
    c.kp.setConstant(stance ? config_.kp_stance : config_.kp_swing);
    c.kd.setConstant(stance ? config_.kd_stance : config_.kd_swing);
  }
  out.finite = guard_.update(raw, dt, out.command);
  return out;
}

void JointControl::start(const PerLeg<Vec3>& measured) noexcept {
  failures_ = 0;
  solve_us_ = 0.0;
  guard_.reset(measured);
}

}  // namespace pirouette
