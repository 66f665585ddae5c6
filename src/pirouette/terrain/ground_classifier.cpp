#include "pirouette/terrain/ground_classifier.hpp"

#include "pirouette/terrain/plane_estimator.hpp"

namespace pirouette {

void GroundClassifier::reset() noexcept {
  recent_ = {};
  estimate_ = {};
}

void GroundClassifier::add(Leg leg, const Vec3& p_WF) noexcept {
  if (config_.estimation == TerrainEstimation::kOff) return;
  Recent& own = recent_[leg];
  own.p_WF[own.count++ % kPerLeg] = p_WF;

  std::array<Vec3, kPerLeg * kLegCount> points;
  std::array<double, kPerLeg * kLegCount> weights;
  weights.fill(1.0);
  std::size_t n = 0;
  for (const Recent& foot : recent_) {
    const std::size_t known = std::min(foot.count, kPerLeg);
    if (known == 0) return;
    for (std::size_t i = 0; i < known; ++i) points[n++] = foot.p_WF[i];
  }
  const std::span<const Vec3> footholds(points.data(), n);
  const TerrainPlane plane =
      fit_plane(footholds, {weights.data(), n}, TerrainPlane{}, config_.min_scatter, 0.0);

  double lowest = 0.0, highest = 0.0;
  for (const Vec3& p : footholds) {
    const double above = p.z() - plane.height(p.head<2>());
    lowest = std::min(lowest, above);
    highest = std::max(highest, above);
  }
  estimate_.known = n == points.size();
  estimate_.residual = plane.residual_rms;
  estimate_.step_height = highest - lowest;
  estimate_.stepped = estimate_.residual >
                      (estimate_.stepped ? config_.step_residual_release : config_.step_residual);
}

}  // namespace pirouette
