// Next foothold of each leg.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

/// Where a foot is to land.
struct Foothold {
  Vec3 p_WC = Vec3::Zero();  ///< m, contact point on the ground
  Vec3 p_WF = Vec3::Zero();  ///< m, sphere centre at touchdown
  Vec3 n_W = Vec3::UnitZ();  ///< unit normal of the ground expected there
};

/// Next foothold of each leg.
using FootholdPlan = PerLeg<Foothold>;

}  // namespace pirouette
