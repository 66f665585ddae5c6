#include "pirouette/terrain/plane_estimator.hpp"

#include <Eigen/Eigenvalues>
#include <array>
#include <cassert>

namespace pirouette {
namespace {

constexpr double kMinTotalWeight = 2.0;  // contacts; with less the plane is kept
constexpr double kNoWeight = 1e-9;

struct WeightedMean {
  Vec3 p_W = Vec3::Zero();
  double weight = 0.0;
};

WeightedMean weighted_mean(std::span<const Vec3> points_W, std::span<const double> weights) {
  WeightedMean mean;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    mean.weight += weights[i];
    mean.p_W += weights[i] * points_W[i];
  }
  if (mean.weight > kNoWeight) mean.p_W /= mean.weight;
  return mean;
}

TerrainPlane plane_through(const Vec3& p_W, const Vec2& slope) {
  return {.a0 = p_W.z() - slope.dot(p_W.head<2>()), .a1 = slope.x(), .a2 = slope.y()};
}

}  // namespace

TerrainPlane fit_plane(std::span<const Vec3> points_W, std::span<const double> weights,
                       const TerrainPlane& previous, double min_scatter, double ridge) noexcept {
  assert(points_W.size() == weights.size());
  const auto [mean, total] = weighted_mean(points_W, weights);
  if (total <= kNoWeight) {
    TerrainPlane kept = previous;
    kept.weight = 0.0;
    return kept;
  }

  Mat2 scatter = Mat2::Zero();
  Vec2 rise = Vec2::Zero();
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const Vec3 d = points_W[i] - mean;
    scatter += weights[i] * d.head<2>() * d.head<2>().transpose();
    rise += weights[i] * d.z() * d.head<2>();
  }

  Eigen::SelfAdjointEigenSolver<Mat2> eigen;
  eigen.computeDirect(scatter);
  const Vec2 previous_slope(previous.a1, previous.a2);
  Vec2 slope = Vec2::Zero();
  for (int k = 0; k < 2; ++k) {
    const Vec2 direction = eigen.eigenvectors().col(k);
    const double spread = eigen.eigenvalues()[k];
    const double kept = direction.dot(previous_slope);
    const bool determined = spread >= min_scatter;
    slope +=
        direction * (determined ? (direction.dot(rise) + ridge * kept) / (spread + ridge) : kept);
  }

  TerrainPlane plane = plane_through(mean, slope);
  double squares = 0.0;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    squares += weights[i] * square(points_W[i].z() - plane.height(points_W[i].head<2>()));
  }
  plane.residual_rms = std::sqrt(squares / total);
  plane.weight = total;
  return plane;
}

RollPitchYaw terrain_aligned_rpy(const TerrainPlane& plane, double yaw) {
  const Vec3 n_H = rot_z(yaw).transpose() * plane.normal();
  return {.roll = std::atan2(-n_H.y(), std::hypot(n_H.x(), n_H.z())),
          .pitch = std::atan2(n_H.x(), n_H.z()),
          .yaw = yaw};
}

Vec3 terrain_aligned_rate(const TerrainPlane& plane, double yaw, double yaw_rate) {
  const Vec3 n_W = plane.normal();
  const double pitch = terrain_aligned_rpy(plane, yaw).pitch;
  return n_W * (yaw_rate * square(std::cos(pitch)) / n_W.z());
}

void PlaneEstimator::reset(const TerrainPlane& plane) noexcept {
  plane_ = plane;
  contacts_ = {};
}

TerrainPlane PlaneEstimator::update(const PlaneInput& in, double dt) noexcept {
  if (config_.estimation == TerrainEstimation::kOff) return plane_;
  remember_contacts(in, dt);

  std::array<Vec3, kLegCount> points_W;
  std::array<double, kLegCount> weights;
  for (const Leg leg : kLegs) {
    points_W[index(leg)] = contacts_[leg].p_WC;
    weights[index(leg)] = weight(contacts_[leg]);
  }
  TerrainPlane fit = fit_plane(points_W, weights, plane_, config_.min_scatter, config_.ridge);
  if (fit.weight < kMinTotalWeight) return plane_;
  if (in.remembered) fit = *in.remembered;

  // Limiting the slope turns the plane about the mean contact.
  const Vec2 mean = weighted_mean(points_W, weights).p_W.head<2>();
  const TerrainPlane limited = plane_through({mean.x(), mean.y(), fit.height(mean)},
                                             clamp_norm(Vec2(fit.a1, fit.a2), config_.max_slope));
  const double share = config_.filter_time > 0.0 ? 1.0 - std::exp(-dt / config_.filter_time) : 1.0;
  plane_.a0 += share * (limited.a0 - plane_.a0);
  plane_.a1 += share * (limited.a1 - plane_.a1);
  plane_.a2 += share * (limited.a2 - plane_.a2);
  plane_.residual_rms = fit.residual_rms;
  plane_.weight = fit.weight;
  return plane_;
}

void PlaneEstimator::remember_contacts(const PlaneInput& in, double dt) noexcept {
  for (const Leg leg : kLegs) {
    Contact& contact = contacts_[leg];
    if (in.touching[leg]) {
      contact = {.p_WC = in.p_WC[leg], .age = 0.0, .known = true};
    } else {
      contact.age += dt;
    }
  }
}

double PlaneEstimator::weight(const Contact& contact) const noexcept {
  if (!contact.known || contact.age > config_.stale_max_age) return 0.0;
  return std::exp(-contact.age / config_.stale_time_constant);
}

}  // namespace pirouette
