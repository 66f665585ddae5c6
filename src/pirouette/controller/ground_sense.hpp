// The ground as the feet have met it: plane, kind of ground, remembered treads.
#pragma once

#include "pirouette/terrain/foothold_memory.hpp"
#include "pirouette/terrain/ground_classifier.hpp"
#include "pirouette/terrain/plane_estimator.hpp"
#include "pirouette/terrain/terrain_config.hpp"
#include "pirouette/types/tick_trace.hpp"

namespace pirouette {

class GroundSense {
 public:
  GroundSense(const TerrainConfig& config, double foot_radius);

  /// The ground is the plane through `contacts` (m) until feet say otherwise.
  TerrainPlane start(const std::array<Vec3, kLegCount>& contacts);

  /// trace.contacts, gait, state -> trace.plane, ground, remembered_treads.
  void update(double dt, TickTrace& trace) noexcept;

  /// On stepped ground: the planned foothold moved off the edges that the memory knows, at the
  /// height of its tread. `centre_offset` (m) is the sphere centre's height above the contact.
  Foothold adapted(const Foothold& planned, double centre_offset) const noexcept;

 private:
  void remember_footholds(TickTrace& trace) noexcept;

  TerrainConfig config_;
  double foot_radius_;
  PlaneEstimator plane_estimator_;
  GroundClassifier classifier_;
  FootholdMemory memory_;
  PerLeg<int> remembered_stride_{};  ///< last stance of each leg that was taken down
};

}  // namespace pirouette
