// The CoM planner's horizontal target.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

struct ComPlan {
  Vec2 p_WG = Vec2::Zero();  ///< m, world horizontal target of the centre of mass
  Vec2 v_WG = Vec2::Zero();  ///< m/s, its rate along the plan
};

}  // namespace pirouette
