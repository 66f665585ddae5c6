#include "pirouette/controller/command_guard.hpp"

namespace pirouette {

namespace {

/// `target` moved at most `step` away from `from`, per entry.
Vec3 limit_step(const Vec3& target, const Vec3& from, double step) {
  return target.cwiseMax(from - Vec3::Constant(step)).cwiseMin(from + Vec3::Constant(step));
}

bool all_finite(const LegCommand& c) {
  return c.q.allFinite() && c.dq.allFinite() && c.kp.allFinite() && c.kd.allFinite() &&
         c.tau.allFinite();
}

}  // namespace

bool CommandGuard::update(const JointCommand& raw, double dt, JointCommand& command) noexcept {
  JointCommand safe = raw;
  const double share = dt / (dt + config_.filter_time);
  for (const Leg leg : kLegs) {
    LegCommand& c = safe[leg];
    const Vec3 filtered = tau_[leg] + share * (c.tau - tau_[leg]);
    c.tau = limit_step(filtered.cwiseMax(-legs_[leg].tau_max).cwiseMin(legs_[leg].tau_max),
                       tau_[leg], config_.max_torque_rate * dt);
    c.q = limit_step(c.q.cwiseMax(legs_[leg].q_min).cwiseMin(legs_[leg].q_max), q_[leg],
                     config_.max_position_rate * dt);
    if (!all_finite(raw[leg]) || !all_finite(c)) return false;
  }
  for (const Leg leg : kLegs) {
    tau_[leg] = safe[leg].tau;
    q_[leg] = safe[leg].q;
  }
  command = safe;
  return true;
}

void CommandGuard::reset(const PerLeg<Vec3>& measured) noexcept {
  q_ = measured;
  tau_ = PerLeg<Vec3>::filled(Vec3::Zero());
}

JointCommand damped_stand_down(double kd) {
  LegCommand damped;
  damped.kd.setConstant(kd);
  return JointCommand::filled(damped);
}

}  // namespace pirouette
