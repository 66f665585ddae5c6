// Where each foot is to land next.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

struct Foothold {
  Vec3 p_WC = Vec3::Zero();  ///< m, contact point on the ground
  Vec3 p_WF = Vec3::Zero();  ///< m, sphere centre at touchdown
  Vec3 n_W = Vec3::UnitZ();  ///< unit normal expected there
};

using FootholdPlan = PerLeg<Foothold>;

}  // namespace pirouette
