// The body reference, now and over the MPC's horizon.
#pragma once

#include "pirouette/lowlevel/convex_mpc.hpp"
#include "pirouette/terrain/plane_estimator.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/com_plan.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

struct HorizonInput {
  PathPoint path;
  TwistCommand twist;
  ComPlan com_plan;
  TerrainPlane plane;
  Vec2 p_WG = Vec2::Zero();  ///< m, measured CoM: the position reference stays near it
  double yaw = 0.0;          ///< rad, measured; the twist is in its heading axes
  double com_height = 0.0;   ///< m, above `plane`, along gravity
  double max_lead = 0.03;    ///< m, largest distance of the position reference from the CoM
};

/// What the body should do at this moment.
BodyReference body_reference(const HorizonInput& in) noexcept;

/// The same reference carried `t` seconds along its twist, parallel to the plane.
BodyMotion reference_after(const BodyReference& reference, const TerrainPlane& plane,
                           double com_height, double t) noexcept;

}  // namespace pirouette
