// Where the feet are to land, and how those in the air get there.
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

/// The stance that the robot works in.
struct NominalStance {
  PerLeg<Vec3> q{};           ///< rad
  Vec3 p_BG = Vec3::Zero();   ///< m, CoM
  PerLeg<Vec2> foothold_H{};  ///< m, from the CoM, heading axes
};

/// All of this tick.
struct FootholdsInput {
  const RobotState& state;
  const GaitPhase& gait;
  bool recovering = false;  ///< from a push: footholds go to the capture point
  const TwistCommand& twist;
  const TerrainPlane& plane;
  const GroundEstimate& ground;
};

/// All of this tick.
struct SwingTargetsInput {
  const RobotState& state;
  const GaitPhase& gait;
  const FootContacts& contacts;
  const PerLeg<Vec3>& p_WF_liftoff;  ///< m, sphere centres where the swings began
  const FootholdPlan& footholds;
  const GroundEstimate& ground;
};

/// Remembers nothing.
class FootPlanner {
 public:
  FootPlanner(const FootholdConfig& foothold, const GaitConfig& gait, double com_height,
              const RollingFoot& foot, const PerLeg<LegGeometry>& legs,
              const NominalStance& stance);

  /// On stepped ground `memory` moves the footholds off the edges that it knows.
  FootholdPlan footholds(const FootholdsInput& in, const GroundSense& memory) const noexcept;

  /// A foot in contact stays where it is and rolls.
  PerLeg<SwingTarget> swing_targets(const SwingTargetsInput& in) const noexcept;

 private:
  double swing_height(const GroundEstimate& ground) const noexcept;

  FootholdConfig config_;
  GaitConfig gait_;
  double capture_time_;  ///< s
  RollingFoot foot_;
  PerLeg<LegGeometry> legs_;
  NominalStance stance_;
  FootholdPlanner planner_;
};

}  // namespace pirouette
