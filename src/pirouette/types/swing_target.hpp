// Target of a swing foot.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Desired motion of a swing foot's sphere centre, world axes.
struct SwingTarget {
  Vec3 p_WF = Vec3::Zero();    ///< m
  Vec3 v_WF_W = Vec3::Zero();  ///< m/s
  Vec3 a_WF_W = Vec3::Zero();  ///< m/s^2
};

}  // namespace pirouette
