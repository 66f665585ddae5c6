// Footholds and swing targets of all feet.
#pragma once

#include "pirouette/controller/ground_sense.hpp"
#include "pirouette/foot/rolling_foot.hpp"
#include "pirouette/gait/foothold_planner.hpp"
#include "pirouette/gait/gait_config.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/foothold_plan.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/ground_estimate.hpp"
#include "pirouette/types/leg_geometry.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/swing_target.hpp"
#include "pirouette/types/terrain_plane.hpp"

namespace pirouette {

/// Nominal posture: joint angles, CoM and footholds.
struct NominalStance {
  PerLeg<Vec3> q{};           ///< rad, joint angles
  Vec3 p_BG = Vec3::Zero();   ///< m, CoM in trunk axes
  PerLeg<Vec2> foothold_H{};  ///< m, from the CoM, heading axes
};

/// Input of FootPlanner::footholds(), all of this tick.
struct FootholdsInput {
  const RobotState& state;       ///< estimated state of the robot
  const GaitPhase& gait;         ///< phase of each leg
  bool recovering = false;       ///< from a push: footholds are at the capture point
  const TwistCommand& twist;     ///< the tracker's velocity command
  const TerrainPlane& plane;     ///< estimated ground plane
  const GroundEstimate& ground;  ///< kind of ground
};

/// Input of FootPlanner::swing_targets(), all of this tick.
struct SwingTargetsInput {
  const RobotState& state;           ///< estimated state of the robot
  const GaitPhase& gait;             ///< phase of each leg
  const FootContacts& contacts;      ///< contact of each foot
  const PerLeg<Vec3>& p_WF_liftoff;  ///< m, sphere centres where the swings began
  const FootholdPlan& footholds;     ///< planned footholds
  const GroundEstimate& ground;      ///< kind of ground
};

/// Plans footholds and swing targets. Has no state.
class FootPlanner {
 public:
  /// `com_height` (m) above the ground.
  FootPlanner(const FootholdConfig& foothold, const GaitConfig& gait, double com_height,
              const PerLeg<RollingFoot>& rolling_feet, const PerLeg<LegGeometry>& legs,
              const NominalStance& stance);

  /// Next foothold of each leg. On stepped ground `memory` moves them off known edges.
  FootholdPlan footholds(const FootholdsInput& in, const GroundSense& memory) const noexcept;

  /// Target of each foot: on the swing trajectory in the air; present position and rolling velocity
  /// in contact.
  PerLeg<SwingTarget> swing_targets(const SwingTargetsInput& in) const noexcept;

 private:
  double swing_height(const GroundEstimate& ground) const noexcept;

  FootholdConfig config_;
  GaitConfig gait_;
  double capture_time_;  ///< s
  PerLeg<RollingFoot> rolling_feet_;
  PerLeg<LegGeometry> legs_;
  NominalStance stance_;
  FootholdPlanner planner_;
};

}  // namespace pirouette
