// The ground as the feet have met it: plane, kind of ground, remembered treads.
#pragma once

#include "pirouette/terrain/foothold_memory.hpp"
#include "pirouette/terrain/ground_classifier.hpp"
#include "pirouette/terrain/plane_estimator.hpp"
#include "pirouette/terrain/terrain_config.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/foothold_plan.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

/// All of this tick.
struct GroundSenseInput {
  const FootContacts& contacts;
  const GaitPhase& gait;
  const RobotState& state;
};

struct GroundSenseOutput {
  TerrainPlane plane;
  GroundEstimate ground;
  int remembered_treads = 0;  ///< of the stairs in the foothold memory
};

class GroundSense {
 public:
  GroundSense(const TerrainConfig& config, double foot_radius);

  /// The ground is the plane through `contacts` (m) until feet say otherwise.
  TerrainPlane start(const std::array<Vec3, kLegCount>& contacts);

  GroundSenseOutput update(const GroundSenseInput& in, double dt) noexcept;

  /// On stepped ground: the planned foothold moved off the edges that the memory knows, at the
  /// height of its tread. `centre_offset` (m) is the sphere centre's height above the contact.
  Foothold adapted(const Foothold& planned, double centre_offset) const noexcept;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, foot_radius, plane_estimator, classifier, memory, remembered_stride] = self;
    visit(plane_estimator, classifier, memory, remembered_stride);
  }

 private:
  void remember_footholds(const GroundSenseInput& in) noexcept;

  TerrainConfig config_;
  double foot_radius_;
  PlaneEstimator plane_estimator_;
  GroundClassifier classifier_;
  FootholdMemory memory_;
  PerLeg<int> remembered_stride_{};  ///< last stance of each leg that was taken down
};

}  // namespace pirouette
