// The CoM planner's horizontal target.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

struct ComPlan {
  Vec2 p_WG = Vec2::Zero();  ///< m, world horizontal target of the centre of mass
};

}  // namespace pirouette
