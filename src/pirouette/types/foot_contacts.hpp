// Which feet carry, where they touch and along which normal.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

struct FootContact {
  bool in_contact = false;   ///< this foot may push now: scheduled stance or early contact
  bool measured = false;     ///< the contact sensor (or the schedule, without one) says it touches
  Vec3 p_WC = Vec3::Zero();  ///< m, contact point of the foot model in use
  Vec3 n_W = Vec3::UnitZ();  ///< unit normal of the ground under the foot
  Vec3 v_WF_rolling_W =
      Vec3::Zero();  ///< m/s, sphere-centre velocity when it rolls without slip; 0 for a point foot
};

using FootContacts = PerLeg<FootContact>;

}  // namespace pirouette
