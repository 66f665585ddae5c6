// Contact of each foot: flag, contact point and ground normal.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

/// Contact of one foot.
struct FootContact {
  bool in_contact = false;  ///< the foot may push now: scheduled stance or early contact
  /// the foot touches, by its contact sensor or, without one, by the schedule
  bool measured = false;
  Vec3 p_WC = Vec3::Zero();  ///< m, contact point of the foot model in use
  Vec3 n_W = Vec3::UnitZ();  ///< unit normal of the ground under the foot
  Vec3 v_WF_rolling_W =
      Vec3::Zero();  ///< m/s, sphere-centre velocity when it rolls without slip; 0 for a point foot
};

/// Contact of each foot.
using FootContacts = PerLeg<FootContact>;

}  // namespace pirouette
