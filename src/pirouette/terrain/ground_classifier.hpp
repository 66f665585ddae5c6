// Slope or steps: do the last footholds fit a plane? docs/terrain.md#discriminator.
#pragma once

#include <array>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/terrain/terrain_config.hpp"
#include "pirouette/types/ground_estimate.hpp"

namespace pirouette {

/// Keeps the last three footholds of each leg and fits a plane to them. On a slope they miss it by
/// the encoders' noise, tenths of a millimetre; on stairs by a good part of the rise. The verdict
/// changes with hysteresis.
class GroundClassifier {
 public:
  explicit GroundClassifier(const TerrainConfig& config) : config_(config) {}

  /// One foothold, once per stance: `p_WF` (m) is the sphere centre, whose plane is parallel to the
  /// contacts' whatever the normal.
  void add(Leg leg, const Vec3& p_WF) noexcept;

  const GroundEstimate& estimate() const { return estimate_; }
  void reset() noexcept;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, recent, estimate] = self;
    visit(recent, estimate);
  }

 private:
  static constexpr std::size_t kPerLeg = 3;
  struct Recent {
    std::array<Vec3, kPerLeg> p_WF = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};  ///< m
    std::size_t count = 0;  ///< footholds ever
  };

  TerrainConfig config_;
  PerLeg<Recent> recent_;
  GroundEstimate estimate_;
};

}  // namespace pirouette
