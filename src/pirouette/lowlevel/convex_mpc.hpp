// Convex model predictive control of the linearised single rigid body.
#pragma once

#include <array>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/lowlevel/qp_solver.hpp"
#include "pirouette/types/contact_forces.hpp"

namespace pirouette {

inline constexpr int kMaxHorizon = 24;
/// Forces planned at once; see QpSolver::kMaxVariables. A trot of duty 0.6 has 40 in 16 steps; four
/// feet that stand have them in 10.
inline constexpr int kMaxForces = QpSolver::kMaxVariables / 3;

/// State of the single rigid body: attitude (rad, yaw unwrapped), CoM position, angular velocity
/// and CoM velocity, all in world axes.
struct BodyMotion {
  Vec3 rpy = Vec3::Zero();
  Vec3 p_WG = Vec3::Zero();
  Vec3 w_WB_W = Vec3::Zero();
  Vec3 v_WG_W = Vec3::Zero();
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

struct MpcInput {
  BodyMotion now;
  std::array<MpcStep, kMaxHorizon> steps{};
  Vec3 n_W = Vec3::UnitZ();  ///< ground normal for the friction pyramids
  double dt = 0.03;          ///< s, length of a step
};

/// [DiCarlo18], condensed in closed form: docs/equations.md#convex-mpc.
///
/// The linear dynamics (equations.md section 8) are integrated exactly over each step with forces
/// held. Since A^3 = 0, the response of a state to a force is a polynomial in the number of steps
/// between them, so each 3x3 block of the Hessian is built from suffix sums in constant time. Swing
/// legs have no variables. The prediction ends at the horizon or before the step that would exceed
/// kMaxForces.
class ConvexMpc {
 public:
  /// `mass` in kg; `inertia_B` in kg m^2 about the CoM, trunk axes.
  ConvexMpc(const MpcConfig& config, double mass, const Mat3& inertia_B);

  /// Forces of the first step. kFailed: the solver gave up and the forces are zero.
  ContactForces update(const MpcInput& in) noexcept;

  /// The condensed problem last built: for tests.
  const QpSolver::Problem& problem() const { return *problem_; }

 private:
  struct Variable {  ///< a force: which step, which leg
    int step;
    Leg leg;
    Mat3 W;  ///< rad/s per N: change of angular velocity by this force over one step
  };

  void collect_variables(const MpcInput& in) noexcept;
  void sum_rotations(const MpcInput& in) noexcept;
  void fill_hessian(double dt) noexcept;
  void fill_gradient(const MpcInput& in) noexcept;
  void fill_constraints(const Vec3& n_W) noexcept;

  MpcConfig config_;
  double mass_;
  Mat3 inertia_B_;
  QpSolver solver_;
  QpSolver::Problem* problem_ = nullptr;

  std::array<Variable, kMaxForces> variables_;
  int variable_count_ = 0;
  int steps_ = 0;                    ///< of the prediction
  std::array<Mat3, kMaxHorizon> T_;  ///< attitude rate per angular velocity, during step i (E24)
  std::array<Mat3, kMaxHorizon + 1> S_;  ///< sum of dt T_i over i < k
  std::array<Mat3, kMaxHorizon> C_;  ///< part of S_k that a force of step j does not act through
};

}  // namespace pirouette
