#include "pirouette/controller/force_planner.hpp"

#include "pirouette/base/stopwatch.hpp"
#include "pirouette/controller/body_horizon.hpp"

namespace pirouette {

MpcInput ForcePlanner::mpc_input(const ForcePlannerInput& in) const noexcept {
  const RobotState& state = in.state;
  MpcInput out;
  const double stride = in.gait.stance_duration + in.gait.swing_duration;
  out.dt = config_.step_share * (in.gait.walking ? stride : standing_period_);
  out.n_W = in.contacts[Leg::kFR].n_W;
  out.now.rpy = Vec3(state.rpy.roll, state.rpy.pitch, state.rpy.yaw);
  out.now.p_WG = state.p_WG;
  out.now.v_WG_W = state.v_WG_W;
  out.now.w_WB_W = state.w_WB_W();
  for (int k = 0; k < config_.horizon; ++k) {
    MpcStep& step = out.steps[static_cast<size_t>(k)];
    const double middle = (k + 0.5) * out.dt;
    const BodyMotion mid = reference_after(in.reference, in.plane, com_height_, middle);
    step.reference = reference_after(in.reference, in.plane, com_height_, (k + 1) * out.dt);
    step.rpy_mid = {mid.rpy.x(), mid.rpy.y(), mid.rpy.z()};
    step.p_WG_mid = mid.p_WG;
    for (const Leg leg : kLegs) {
      const LegPhase ahead = in.clock.phase_at(leg, middle);
      const FootContact& contact = in.contacts[leg];
      const bool same_stance = contact.in_contact && ahead.stride == in.gait.leg[leg].stride;
      step.stance[leg] = k == 0 ? contact.in_contact : ahead.stance;
      step.p_WC[leg] = same_stance ? contact.p_WC : in.footholds[leg].p_WC;
    }
  }
  return out;
}

ContactForces ForcePlanner::update(const ForcePlannerInput& in) noexcept {
  PerLeg<bool> contacts{};
  bool changed = false;
  for (const Leg leg : kLegs) {
    contacts[leg] = in.contacts[leg].in_contact;
    changed = changed || contacts[leg] != solved_contacts_[leg];
  }
  solve_us_ = 0.0;
  if (ticks_until_solve_-- > 0 && !changed) return forces_;
  ticks_until_solve_ = ticks_per_solve_ - 1;
  solved_contacts_ = contacts;
  const Stopwatch watch;
  const ContactForces forces = mpc_.update(mpc_input(in));
  solve_us_ = watch.microseconds();
  if (forces.status == SolveStatus::kFailed) {
    ++failures_;
    forces_.status = SolveStatus::kHeld;
  } else {
    failures_ = 0;
    forces_ = forces;
  }
  return forces_;
}

void ForcePlanner::reset() noexcept {
  failures_ = ticks_until_solve_ = 0;
  solved_contacts_ = {};
  forces_ = ContactForces{};
  solve_us_ = 0.0;
}

}  // namespace pirouette
