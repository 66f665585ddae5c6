// Ground estimate from the footholds: plane, kind of ground, remembered treads.
#pragma once

#include "pirouette/terrain/foothold_memory.hpp"
#include "pirouette/terrain/ground_classifier.hpp"
#include "pirouette/terrain/plane_estimator.hpp"
#include "pirouette/terrain/terrain_config.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/foothold_plan.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/robot_scale.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

/// Input of GroundSense::update(), all of this tick.
struct GroundSenseInput {
  const FootContacts& contacts;  ///< contact of each foot
  const GaitPhase& gait;         ///< phase of each leg
  const RobotState& state;       ///< estimated state of the robot
};

/// Output of GroundSense::update().
struct GroundSenseOutput {
  TerrainPlane plane;         ///< estimated ground plane
  GroundEstimate ground;      ///< kind of ground
  int remembered_treads = 0;  ///< number of treads in the foothold memory
};

/// Estimates the ground from the footholds.
class GroundSense {
 public:
  /// `foot_radius` (m) of the foot spheres.
  GroundSense(const TerrainConfig& config, const PerLeg<double>& foot_radius,
              const RobotScale& scale = {});

  /// Starts with, and returns, the plane through the contact points `contacts` (m, world).
  TerrainPlane start(const std::array<Vec3, kLegCount>& contacts);

  /// Estimate after one tick of `dt` (s).
  GroundSenseOutput update(const GroundSenseInput& in, double dt) noexcept;

  /// `planned` of `leg`, on stepped ground moved off remembered edges and to the height of its
  /// tread. `centre_offset` (m) is the sphere centre's height above the contact.
  Foothold adapted(const Foothold& planned, Leg leg, double centre_offset) const noexcept;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, foot_radius, plane_estimator, classifier, memory, remembered_stride] = self;
    visit(plane_estimator, classifier, memory, remembered_stride);
  }

 private:
  void remember_footholds(const GroundSenseInput& in) noexcept;

  TerrainConfig config_;
  PerLeg<double> foot_radius_;
  PlaneEstimator plane_estimator_;
  GroundClassifier classifier_;
  FootholdMemory memory_;
  PerLeg<int> remembered_stride_{};  ///< last stride of each leg whose foothold was stored
};

}  // namespace pirouette
