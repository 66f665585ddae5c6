// The body reference, now and over the MPC's horizon.
#pragma once

#include "pirouette/lowlevel/convex_mpc.hpp"
#include "pirouette/terrain/plane_estimator.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/com_plan.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

/// Input of body_reference(), all of this tick.
struct HorizonInput {
  PathPoint path;            ///< path reference
  TwistCommand twist;        ///< the tracker's velocity command
  ComPlan com_plan;          ///< the CoM planner's target
  TerrainPlane plane;        ///< estimated ground plane
  Vec2 p_WG = Vec2::Zero();  ///< m, measured CoM: the position reference stays near it
  double yaw = 0.0;          ///< rad, measured; the twist is in its heading axes
  double com_height = 0.0;   ///< m, above `plane`, along gravity
  double max_lead = 0.03;    ///< m, largest distance of the position reference from the CoM
};

/// Reference of the body at this moment.
BodyReference body_reference(const HorizonInput& in) noexcept;

/// `reference` moved along its twist for `t` (s), parallel to the plane; `com_height` (m) above the
/// plane, along gravity.
BodyMotion reference_after(const BodyReference& reference, const TerrainPlane& plane,
                           double com_height, double t) noexcept;

}  // namespace pirouette
