// Creep of twisting feet down a slope: docs/terrain.md#creep.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/estimation/estimation_config.hpp"
#include "pirouette/types/creep_estimate.hpp"
#include "pirouette/types/robot_scale.hpp"

namespace pirouette {

/// Input of SpinCreep::update().
struct CreepInput {
  Vec3 n_W = Vec3::UnitZ();   ///< unit normal of the slope
  double twist_rate = 0.0;    ///< rad/s, of the trunk about n_W
  double yaw_moment = 0.0;    ///< N m, of the stance forces about the CoM, about n_W
  double normal_force = 0.0;  ///< N, sum of the stance forces along n_W
};

/// Creep model. A foot that twists under torsional friction mu_t has no static friction along the
/// ground: elliptic Coulomb friction shares one cone between force and moment, so that the slip is
///   v = |w| k f_t / N,   k = mu_t^2 / (mu^2 m),   m = mu_t sqrt(1 - (f_t / (mu N))^2),
/// with w the twist rate of the foot (the shank's, not the trunk's), f_t the force along the ground
/// and m the moment per normal force. Leg odometry cannot see it. f_t / N of the mean stance force
/// follows from gravity and the slope.
///
/// The stance forces balance the torsional friction: over whole strides of a steady spin their mean
/// yaw moment per normal force is m. With the ratio mu_t / mu calibrated that alone gives k.
class SpinCreep {
 public:
  /// Starts from the calibrated values.
  explicit SpinCreep(const CreepConfig& config, const RobotScale& scale = {})
      : config_(config), scale_(scale) {
    reset();
  }

  /// Estimate after one tick of `dt` (s).
  CreepEstimate update(const CreepInput& in, double dt) noexcept;
  void reset() noexcept;  ///< back to the calibrated values

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, scale, mean_moment, mean_force] = self;
    visit(mean_moment, mean_force);
  }

 private:
  void observe(const CreepInput& in, double dt) noexcept;
  double coefficient(double force_share) const noexcept;

  CreepConfig config_;
  RobotScale scale_;
  double mean_moment_ = 0.0;  ///< N m, against the twist
  double mean_force_ = 0.0;   ///< N
};

}  // namespace pirouette
