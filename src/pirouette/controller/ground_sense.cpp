#include "pirouette/controller/ground_sense.hpp"

namespace pirouette {

GroundSense::GroundSense(const TerrainConfig& config, const PerLeg<double>& foot_radius,
                         const RobotScale& scale)
    : config_(config),
      foot_radius_(foot_radius),
      plane_estimator_(config),
      classifier_(config),
      memory_(config, scale) {}

TerrainPlane GroundSense::start(const std::array<Vec3, kLegCount>& contacts) {
  const std::array<double, kLegCount> weights = {1.0, 1.0, 1.0, 1.0};
  const bool flat = config_.estimation == TerrainEstimation::kOff;
  // "Flat world": no direction scatters enough to have a slope.
  const double min_scatter = flat ? 1e9 : config_.min_scatter;
  const TerrainPlane plane = fit_plane(contacts, weights, TerrainPlane{}, min_scatter, 0.0);
  plane_estimator_.reset(plane);
  classifier_.reset();
  memory_.reset();
  remembered_stride_ = PerLeg<int>::filled(-1);
  return plane;
}

GroundSenseOutput GroundSense::update(const GroundSenseInput& in, double dt) noexcept {
  PlaneInput plane_input;
  for (const Leg leg : kLegs) {
    plane_input.p_WC[leg] = in.contacts[leg].p_WC;
    plane_input.touching[leg] = in.contacts[leg].in_contact && in.contacts[leg].measured;
  }
  if (classifier_.estimate().stepped) plane_input.remembered = memory_.plane();
  const TerrainPlane plane = plane_estimator_.update(plane_input, dt);
  remember_footholds(in);
  return {plane, classifier_.estimate(), static_cast<int>(memory_.tread_count())};
}

// In the middle of a stance the foot carries, and neither slides in nor lifts off.
void GroundSense::remember_footholds(const GroundSenseInput& in) noexcept {
  constexpr double kMidStance = 0.5;
  for (const Leg leg : kLegs) {
    const LegPhase& phase = in.gait.leg[leg];
    const bool settled = phase.stance && phase.progress >= kMidStance && in.contacts[leg].measured;
    if (!settled || remembered_stride_[leg] == phase.stride) continue;
    remembered_stride_[leg] = phase.stride;
    const Vec3& p_WF = in.state.p_WF[leg];
    const double larger = foot_radius_[leg] - foot_radius_[Leg::kFR];
    classifier_.add(leg, p_WF - larger * Vec3::UnitZ());
    memory_.add(p_WF - foot_radius_[leg] * Vec3::UnitZ(), in.state.p_WG.head<2>());
  }
}

Foothold GroundSense::adapted(const Foothold& planned, Leg leg,
                              double centre_offset) const noexcept {
  Foothold out = planned;
  out.n_W = Vec3::UnitZ();
  if (const auto ground = memory_.at(planned.p_WC.head<2>())) {
    const double hidden_radius = foot_radius_[leg] - centre_offset;
    out.p_WC << ground->p_W, ground->height + hidden_radius;
  }
  out.p_WF = out.p_WC + centre_offset * out.n_W;
  return out;
}

}  // namespace pirouette
