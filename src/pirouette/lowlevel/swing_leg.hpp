// Swing trajectory of a foot.
#pragma once

#include "pirouette/types/swing_target.hpp"

namespace pirouette {

/// Input of swing_target().
struct SwingInput {
  Vec3 p_WF_liftoff = Vec3::Zero();  ///< m, sphere centre where the swing began
  Vec3 p_WF_target = Vec3::Zero();   ///< m, sphere centre at touchdown
  double progress = 0.0;             ///< in [0, 1], elapsed share of the swing
  double duration = 0.2;             ///< s, of the whole swing
  double clearance = 0.05;           ///< m, apex above the higher end
};

/// Target of the swing foot: minimum-jerk motion in the horizontal plane; vertically a minimum-jerk
/// rise to the apex at mid-swing and a fall from it. Velocity and acceleration are zero at both
/// ends, so that the foot lands softly and a moving target causes no jump. World axes.
SwingTarget swing_target(const SwingInput& in) noexcept;

}  // namespace pirouette
