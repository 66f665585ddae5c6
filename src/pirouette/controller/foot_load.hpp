// Contact flags from what the feet's force sensors read.
#pragma once

#include <algorithm>

#include "pirouette/base/legs.hpp"
#include "pirouette/types/gait_phase.hpp"

namespace pirouette {

/// Contact flags from raw foot forces of unknown scale and offset. Each foot's level under load is
/// learned while the robot stands and in the middle of stances, its level in the air in the middle
/// of swings (0 before the first): a foot touches while it reads more than a fifth of the way from
/// one to the other. A sensor that does not feel the load gives a flag that does not follow the
/// schedule, which FlagTrust drops.
class FootLoad {
 public:
  /// The flags of one tick of `dt` (s). `force`: any unit, finite, rising with the load.
  PerLeg<bool> update(const PerLeg<double>& force, const GaitPhase& gait, double dt) noexcept {
    PerLeg<bool> touches{};
    for (const Leg leg : kLegs) {
      Level& level = levels_[leg];
      const LegPhase& phase = gait.leg[leg];
      const bool in_middle = phase.progress > kMiddle && phase.progress < 1.0 - kMiddle;
      if (!gait.walking || (phase.stance && in_middle)) level.loaded.add(force[leg], dt);
      if (gait.walking && !phase.stance && in_middle) level.unloaded.add(force[leg], dt);
      const double span = level.loaded.value - level.unloaded.value;
      touches[leg] = force[leg] - level.unloaded.value > kShare * span && span > 0.0;
    }
    return touches;
  }

  void reset() noexcept { *this = FootLoad(); }  ///< forgets what it has learned

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [levels] = self;
    visit(levels);
  }

 private:
  static constexpr double kShare = 0.2;   // of the way from the level in the air to that under load
  static constexpr double kMiddle = 0.3;  // share of a stance or swing at each end left out
  static constexpr double kMemory = 1.0;  // s, over which a level is averaged

  /// Mean of the samples so far, of the last second of them at most.
  struct Mean {
    double value = 0.0;
    double time = 0.0;  ///< s, of the samples
    void add(double sample, double dt) noexcept {
      time = std::min(time + dt, kMemory);
      value += dt / time * (sample - value);
    }
  };
  struct Level {
    Mean loaded, unloaded;
  };

  PerLeg<Level> levels_{};
};

}  // namespace pirouette
