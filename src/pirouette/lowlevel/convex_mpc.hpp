// Convex model predictive control of the linearised single rigid body.
#pragma once

#include <array>
#include <span>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/lowlevel/force_recursion.hpp"
#include "pirouette/lowlevel/friction_pyramid.hpp"
#include "pirouette/lowlevel/least_distance.hpp"
#include "pirouette/lowlevel/mpc_config.hpp"
#include "pirouette/types/contact_forces.hpp"

namespace pirouette {

/// State of the single rigid body, world axes.
struct BodyMotion {
  Vec3 rpy = Vec3::Zero();     ///< rad, yaw unwrapped
  Vec3 p_WG = Vec3::Zero();    ///< m, CoM
  Vec3 w_WB_W = Vec3::Zero();  ///< rad/s
  Vec3 v_WG_W = Vec3::Zero();  ///< m/s, CoM
};

/// One step of the prediction: the reference at its end, and the ground during it.
struct MpcStep {
  BodyMotion reference;  ///< at the end of the step
  RollPitchYaw rpy_mid;  ///< rad, reference attitude at the middle of the step
  Vec3 p_WG_mid =
      Vec3::Zero();       ///< m, reference CoM at the middle of the step: lever arms are about it
  PerLeg<bool> stance{};  ///< legs that may push during the step
  PerLeg<Vec3> p_WC{};    ///< m, their contact points
};

/// Input of ConvexMpc::update().
struct MpcInput {
  BodyMotion now;                            ///< present state
  std::array<MpcStep, kMaxHorizon> steps{};  ///< the first mpc.horizon are used
  Vec3 n_W = Vec3::UnitZ();  ///< unit normal of the ground, for the friction pyramids
  double dt = 0.03;          ///< s, length of a step
};

/// [DiCarlo18]: docs/equations.md#convex-mpc, docs/decisions/011-mpc-by-recursion.md.
///
/// The linear dynamics (equations.md section 8) are integrated exactly over each step with forces
/// held. The optimum without force limits comes from a Riccati recursion; where it violates a
/// friction pyramid, an exact active-set solver continues from it. Swing legs have no variables.
/// The prediction ends at the horizon or before the step that would exceed kMaxForces.
class ConvexMpc {
 public:
  /// `mass` in kg; `inertia_B` in kg m^2 about the CoM, trunk axes.
  ConvexMpc(const MpcConfig& config, double mass, const Mat3& inertia_B);

  /// Forces of the first step. On kFailed they are zero.
  ContactForces update(const MpcInput& in) noexcept;

  /// All forces of the last solution (N, world axes), by step and leg; for tests.
  std::span<const Vec3> plan() const;

 private:
  void collect_forces(const MpcInput& in) noexcept;
  void predict_free_motion(const MpcInput& in) noexcept;
  QpSolution solve(const FrictionPyramid& pyramid) noexcept;
  QpSolution solve_nearest(const FrictionPyramid& pyramid, int count, int max_iterations) noexcept;
  int forces_until_last_violation(const FrictionPyramid& pyramid) const noexcept;

  MpcConfig config_;
  Mat3 inertia_B_;
  ForceRecursion recursion_;
  LeastDistance active_set_;

  std::array<Vec3, kMaxForces> f_W_;
  std::array<Mat3, kMaxForces> column_;  ///< of the factor J
};

}  // namespace pirouette
