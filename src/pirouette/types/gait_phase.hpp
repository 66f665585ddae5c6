// Phase of each leg in its stride.
#pragma once

#include "pirouette/base/legs.hpp"

namespace pirouette {

/// Phase of one leg.
struct LegPhase {
  bool stance = true;     ///< scheduled stance; false: scheduled swing
  double progress = 0.0;  ///< in [0, 1], elapsed share of the current stance or swing
  double duration = 0.0;  ///< s, of the current stance or swing
  /// s, until the schedule ends the stance or swing; infinite while standing
  double time_remaining = 0.0;
  int stride = 0;  ///< number of swings begun since the gait started
};

/// Phase of the gait.
struct GaitPhase {
  bool walking = false;          ///< false: all four feet stay down
  double cycle = 0.0;            ///< in [0, 1), position in the stride of FR and RL
  double stance_duration = 0.0;  ///< s, of one leg
  double swing_duration = 0.0;   ///< s, of one leg
  PerLeg<LegPhase> leg{};        ///< phase of each leg
};

}  // namespace pirouette
