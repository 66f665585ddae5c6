// Slope or steps, by how well the last footholds fit a plane. docs/terrain.md#discriminator
#pragma once

#include <array>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/terrain/terrain_config.hpp"
#include "pirouette/types/ground_estimate.hpp"

namespace pirouette {

/// Keeps the last three footholds of each leg and fits a plane to them. On a slope they miss it by
/// the encoders' noise, tenths of a millimetre; on stairs by a large part of the rise. The result
/// changes with hysteresis.
class GroundClassifier {
 public:
  explicit GroundClassifier(const TerrainConfig& config) : config_(config) {}  ///< no footholds

  /// Adds one foothold, once per stance, by its sphere centre `p_WF` (m): the plane through the
  /// centres is parallel to that through the contacts for any normal.
  void add(Leg leg, const Vec3& p_WF) noexcept;

  const GroundEstimate& estimate() const { return estimate_; }  ///< from the footholds so far
  void reset() noexcept;                                        ///< no footholds

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
    std::size_t count = 0;  ///< footholds added
  };

  TerrainConfig config_;
  PerLeg<Recent> recent_;
  GroundEstimate estimate_;
};

}  // namespace pirouette
