// Target of the CoM planner.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Horizontal target of the CoM.
struct ComPlan {
  Vec2 p_WG = Vec2::Zero();  ///< m, world
};

}  // namespace pirouette
