#include "pirouette/controller/foot_planner.hpp"

#include "pirouette/foot/leg_kinematics.hpp"
#include "pirouette/lowlevel/swing_leg.hpp"

namespace pirouette {

FootPlanner::FootPlanner(const FootholdConfig& foothold, const GaitConfig& gait, double com_height,
                         const PerLeg<RollingFoot>& rolling_feet, const PerLeg<LegGeometry>& legs,
                         const NominalStance& stance)
    : config_(foothold),
      gait_(gait),
      capture_time_(std::sqrt(com_height / kGravity)),
      rolling_feet_(rolling_feet),
      legs_(legs),
      stance_(stance),
      planner_(foothold) {}

FootholdPlan FootPlanner::footholds(const FootholdsInput& in,
                                    const GroundSense& memory) const noexcept {
  const RollPitchYaw& rpy = in.state.rpy;
  FootholdInput planner_in;
  planner_in.gait = in.gait;
  planner_in.nominal_H = stance_.foothold_H;
  for (const Leg leg : kLegs) planner_in.centre_offset[leg] = rolling_feet_[leg].centre_offset();
  planner_in.p_WG = in.state.p_WG.head<2>();
  planner_in.v_WG_H = rot2(rpy.yaw).transpose() * in.state.v_WG_W.head<2>();
  planner_in.yaw = rpy.yaw;
  if (in.recovering) planner_in.capture_time = capture_time_;
  planner_in.twist = in.twist;
  planner_in.plane = in.plane;
  if (config_.rolling_compensation) {
    StanceMotion motion;
    motion.p_BG = stance_.p_BG;
    motion.R_HB = rotation_from_rpy({rpy.roll, rpy.pitch, 0.0});
    motion.n_H = rot_z(rpy.yaw).transpose() * in.plane.normal();
    motion.twist = in.twist;
    motion.duration = in.gait.stance_duration;
    for (const Leg leg : kLegs) {
      if (rolling_feet_[leg].radius() == 0.0) continue;
      motion.p_BF = legs_[leg].p_BH + foot_position_H(legs_[leg], stance_.q[leg]);
      planner_in.rolling_shift_H[leg] =
          0.5 * rolling_feet_[leg].stance_travel(legs_[leg], motion).head<2>();
    }
  }
  FootholdPlan out = planner_.update(planner_in);
  if (in.ground.stepped) {
    for (const Leg leg : kLegs)
      out[leg] = memory.adapted(out[leg], leg, rolling_feet_[leg].centre_offset());
  }
  return out;
}

double FootPlanner::swing_height(const GroundEstimate& ground) const noexcept {
  if (!gait_.adapt || !ground.stepped) return gait_.swing_height;
  const double over_steps = ground.step_height + gait_.step_clearance;
  return std::clamp(over_steps, gait_.swing_height,
                    std::max(gait_.swing_height, gait_.max_swing_height));
}

PerLeg<SwingTarget> FootPlanner::swing_targets(const SwingTargetsInput& in) const noexcept {
  PerLeg<SwingTarget> out;
  for (const Leg leg : kLegs) {
    const LegPhase& phase = in.gait.leg[leg];
    if (in.contacts[leg].in_contact) {
      out[leg] = {in.state.p_WF[leg], in.contacts[leg].v_WF_rolling_W, Vec3::Zero()};
      continue;
    }
    out[leg] = swing_target({in.p_WF_liftoff[leg], in.footholds[leg].p_WF, phase.progress,
                             phase.duration, swing_height(in.ground)});
  }
  return out;
}

}  // namespace pirouette
