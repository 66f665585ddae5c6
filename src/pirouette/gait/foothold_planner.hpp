// Next foothold of each foot while the body follows a planar twist.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/planar_twist.hpp"
#include "pirouette/gait/gait_config.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/foothold_plan.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/terrain_plane.hpp"

namespace pirouette {

/// Position (m) of a body-fixed point after `t` (s) of the twist `v` (m/s), `yaw_rate` (rad/s), in
/// the present heading axes; `hip` (m) is its present position.
/// [Zhu21] Eqs. (2)-(4), corrected (E1): docs/equations.md#eq-1
Vec2 turning_foothold(const Vec2& hip, const Vec2& v, double yaw_rate, double t);

/// Input of FootholdPlanner::update().
struct FootholdInput {
  GaitPhase gait;  ///< phase of each leg
  PerLeg<Vec2> nominal_H =
      PerLeg<Vec2>::filled(Vec2::Zero());  ///< m, foothold at mid-stance from the CoM, heading axes
  PerLeg<Vec2> rolling_shift_H = PerLeg<Vec2>::filled(
      Vec2::Zero());  ///< m, half the contact's travel in a stance, heading axes at mid-stance
  PerLeg<double> centre_offset{};  ///< m, sphere centre above the contact along the normal
  Vec2 p_WG = Vec2::Zero();        ///< m, CoM
  Vec2 v_WG_H = Vec2::Zero();      ///< m/s, measured velocity of the CoM, heading axes
  double yaw = 0.0;                ///< rad, of the trunk
  /// s, least gain of the velocity error: sqrt(height / g), the time constant of a linear inverted
  /// pendulum, puts footholds at the capture point. 0: Raibert's law alone.
  double capture_time = 0.0;
  TwistCommand twist;  ///< the tracker's velocity command
  TerrainPlane plane;  ///< estimated ground plane
};

/// Plans footholds so that each foot is at its nominal point in the middle of the coming stance.
/// Has no state.
class FootholdPlanner {
 public:
  explicit FootholdPlanner(const FootholdConfig& config) : config_(config) {}  ///< `foothold.*`

  /// Next foothold of each leg.
  FootholdPlan update(const FootholdInput& in) const noexcept;

 private:
  FootholdConfig config_;
};

}  // namespace pirouette
