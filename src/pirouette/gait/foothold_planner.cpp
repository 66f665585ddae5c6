#include "pirouette/gait/foothold_planner.hpp"

#include <algorithm>
#include <cmath>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

// s until the middle of the leg's coming stance; 0 for a foot that stays down.
double time_to_mid_stance(const GaitPhase& gait, const LegPhase& phase) {
  if (!std::isfinite(phase.time_remaining)) return 0.0;
  const double to_touchdown = phase.time_remaining + (phase.stance ? gait.swing_duration : 0.0);
  return to_touchdown + 0.5 * gait.stance_duration;
}

}  // namespace

Vec2 turning_foothold(const Vec2& hip, const Vec2& v, double yaw_rate, double t) {
  return planar_twist_displacement(v, yaw_rate, t) + rot2(yaw_rate * t) * hip;
}

FootholdPlan FootholdPlanner::update(const FootholdInput& in) const noexcept {
  // Raibert's law: the half stance after touchdown is foreseen with the measured velocity, not the
  // commanded one, and the gain adds to that.
  const double lead =
      std::max(0.5 * in.gait.stance_duration + config_.velocity_gain, in.capture_time);
  const Vec2 feedback_H = config_.feedback ? Vec2(lead * (in.v_WG_H - in.twist.v_H)) : Vec2::Zero();
  const Vec3 n_W = in.plane.normal();

  FootholdPlan plan;
  for (const Leg leg : kLegs) {
    const double t = time_to_mid_stance(in.gait, in.gait.leg[leg]);
    const Vec2 aim_H = in.nominal_H[leg] - in.rolling_shift_H[leg];
    const Vec2 foothold_H =
        turning_foothold(aim_H, in.twist.v_H, in.twist.yaw_rate, t) + feedback_H;
    const Vec2 offset_H = clamp_norm(Vec2(foothold_H - in.nominal_H[leg]), config_.max_offset);

    const Vec2 contact = in.p_WG + rot2(in.yaw) * (in.nominal_H[leg] + offset_H);
    Foothold& foothold = plan[leg];
    foothold.n_W = n_W;
    foothold.p_WC << contact, in.plane.height(contact);
    foothold.p_WF = foothold.p_WC + in.centre_offset[leg] * n_W;
  }
  return plan;
}

}  // namespace pirouette
