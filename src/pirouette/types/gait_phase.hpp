// Where each leg stands in its stride.
#pragma once

#include "pirouette/base/legs.hpp"

namespace pirouette {

struct LegPhase {
  bool stance = true;           ///< scheduled stance; false: scheduled swing
  double progress = 0.0;        ///< in [0, 1]: share of the current stance or swing that is over
  double duration = 0.0;        ///< s, of the current stance or swing
  double time_remaining = 0.0;  ///< s until the schedule switches this leg; infinite while standing
  int stride = 0;               ///< number of swings begun since the gait started
};

struct GaitPhase {
  bool walking = false;          ///< false: all four feet stay down
  double cycle = 0.0;            ///< in [0, 1): position in the stride of the whole gait
  double stance_duration = 0.0;  ///< s, of one leg
  double swing_duration = 0.0;   ///< s, of one leg
  PerLeg<LegPhase> leg{};
};

}  // namespace pirouette
