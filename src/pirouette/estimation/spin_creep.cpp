#include "pirouette/estimation/spin_creep.hpp"

namespace pirouette {
namespace {

// Of a robot of scale 1.
constexpr double kPriorForce = 100.0;     // N, gives the prior moment its size
constexpr double kMinTwistRate = 0.1;     // rad/s, below it the feet may stick
constexpr double kMinTorsional = 1e-4;    // m
constexpr double kMaxCoefficient = 0.15;  // m, k of mu_t = 0.02 and mu = 0.4 with a margin

constexpr double kMaxConeShare = 0.95;  // of sliding friction that the slope may take

/// Share of torsional friction that is left beside the tangential force.
double cone_factor(double force_share, double friction) {
  return std::sqrt(1.0 - square(std::min(force_share / friction, kMaxConeShare)));
}

}  // namespace

void SpinCreep::reset() noexcept {
  mean_force_ = kPriorForce * scale_.mass;
  mean_moment_ = config_.calibrated_torsion * mean_force_;
}

void SpinCreep::observe(const CreepInput& in, double dt) noexcept {
  if (std::abs(in.twist_rate) < kMinTwistRate / scale_.time()) return;
  const double share = 1.0 - std::exp(-dt / config_.averaging_time);
  mean_force_ += share * (in.normal_force - mean_force_);
  mean_moment_ += share * (std::copysign(1.0, in.twist_rate) * in.yaw_moment - mean_moment_);
}

double SpinCreep::coefficient(double force_share) const noexcept {
  const double cone = cone_factor(force_share, config_.calibrated_friction);
  if (config_.mode == CreepModelMode::kStored) {
    return config_.calibrated_torsion / (square(config_.calibrated_friction) * cone);
  }
  const double moment =
      std::max(kMinTorsional * scale_.length,
               std::min(mean_moment_ / mean_force_, config_.max_torsional_friction));
  if (config_.patch_ratio > 0.0) return square(config_.patch_ratio) / moment;
  return moment / square(config_.calibrated_friction * cone);
}

CreepEstimate SpinCreep::update(const CreepInput& in, double dt) noexcept {
  CreepEstimate out;
  if (config_.mode == CreepModelMode::kOff) return out;
  observe(in, dt);
  const Vec3 gravity_along = -Vec3::UnitZ() + in.n_W.z() * in.n_W;
  const double force_share = gravity_along.norm() / in.n_W.z();
  out.torsional_friction = mean_moment_ / mean_force_;
  out.coefficient = std::min(coefficient(force_share), kMaxCoefficient * scale_.length);
  out.slip_per_twist_W = out.coefficient / in.n_W.z() * gravity_along;
  return out;
}

}  // namespace pirouette
