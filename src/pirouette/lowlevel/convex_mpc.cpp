#include "pirouette/lowlevel/convex_mpc.hpp"

namespace pirouette {

namespace {

/// E24: d(rpy)/dt = T omega, omega in world axes.
Mat3 attitude_rate_map(const RollPitchYaw& rpy) {
  const double c = std::cos(rpy.yaw), s = std::sin(rpy.yaw);
  const double cos_pitch = std::cos(rpy.pitch), tan_pitch = std::tan(rpy.pitch);
  Mat3 T;
  T << c / cos_pitch, s / cos_pitch, 0.0,  //
      -s, c, 0.0,                          //
      c * tan_pitch, s * tan_pitch, 1.0;
  return T;
}

}  // namespace

ConvexMpc::ConvexMpc(const MpcConfig& config, double mass, const Mat3& inertia_B)
    : config_(config),
      inertia_B_(inertia_B),
      recursion_(config, mass),
      active_set_(3, kPyramidRows,
                  std::min(config.horizon * static_cast<int>(kLegCount), kMaxForces)) {}

void ConvexMpc::collect_forces(const MpcInput& in) noexcept {
  ForceProblem& problem = recursion_.problem();
  problem.dt = in.dt;
  problem.forces = 0;
  problem.steps = 0;
  const Mat3 inverse_inertia_B = inertia_B_.inverse();
  for (int j = 0; j < config_.horizon; ++j) {
    const MpcStep& step = in.steps[static_cast<size_t>(j)];
    const auto forces = static_cast<int>(std::count(step.stance.begin(), step.stance.end(), true));
    if (problem.forces + forces > kMaxForces) return;
    problem.steps = j + 1;
    problem.T[static_cast<size_t>(j)] = attitude_rate_map(step.rpy_mid);
    const Mat3 R_WB = rotation_from_rpy(step.rpy_mid);
    const Mat3 inverse_inertia_W = R_WB * inverse_inertia_B * R_WB.transpose();
    for (const Leg leg : kLegs) {
      if (!step.stance[leg]) continue;
      PlannedForce& force = problem.force[static_cast<size_t>(problem.forces++)];
      force.step = j;
      force.leg = leg;
      force.W = in.dt * inverse_inertia_W * skew(step.p_WC[leg] - step.p_WG_mid);
    }
  }
}

void ConvexMpc::predict_free_motion(const MpcInput& in) noexcept {
  ForceProblem& problem = recursion_.problem();
  const Vec3 gravity(0.0, 0.0, -kGravity);
  Vec3 rpy = in.now.rpy;
  for (int j = 0; j < problem.steps; ++j) {
    const auto k = static_cast<size_t>(j);
    const BodyMotion& reference = in.steps[k].reference;
    const double t = (j + 1) * in.dt;
    rpy += in.dt * problem.T[k] * in.now.w_WB_W;
    problem.free_error[k] << rpy - reference.rpy,
        in.now.p_WG + t * in.now.v_WG_W + 0.5 * square(t) * gravity - reference.p_WG,
        in.now.w_WB_W - reference.w_WB_W, in.now.v_WG_W + t * gravity - reference.v_WG_W;
  }
}

/// Forces of the steps up to the last one in which a planned force violates its limits; 0: none
/// does.
int ConvexMpc::forces_until_last_violation(const FrictionPyramid& pyramid) const noexcept {
  const ForceProblem& problem = recursion_.problem();
  int count = problem.forces;
  while (count > 0 &&
         pyramid.slack(f_W_[static_cast<size_t>(count) - 1]).minCoeff() >= -kFeasibilityTolerance) {
    --count;
  }
  if (count == 0) return 0;
  const int last_step = problem.force[static_cast<size_t>(count) - 1].step;
  while (count < problem.forces && problem.force[static_cast<size_t>(count)].step == last_step) {
    ++count;
  }
  return count;
}

/// The optimum with limits on the first `count` forces only. Starts from the optimum without limits
/// in f_W_ and leaves its plan there.
QpSolution ConvexMpc::solve_nearest(const FrictionPyramid& pyramid, int count,
                                    int max_iterations) noexcept {
  LeastDistance::Problem& nearest = active_set_.prepare(count);
  for (int j = 0; j < count; ++j) {
    nearest.lower.segment<kPyramidRows>(kPyramidRows * j) =
        -pyramid.slack(f_W_[static_cast<size_t>(j)]);
    nearest.C.block(0, 3 * j, kPyramidRows * j, 3).setZero();
    recursion_.factor_column(j, count, column_);
    for (int i = j; i < count; ++i) {
      nearest.C.block<kPyramidRows, 3>(kPyramidRows * i, 3 * j) =
          pyramid.C.lazyProduct(column_[static_cast<size_t>(i)]);
    }
  }
  const QpSolution solution = active_set_.solve(max_iterations);
  recursion_.roll_out(nearest.y, f_W_);
  return solution;
}

/// Without limits first; then with limits up to the last step that violates one; and if the plan
/// beyond that step now violates one in turn, with all limits.
QpSolution ConvexMpc::solve(const FrictionPyramid& pyramid) noexcept {
  const Eigen::VectorXd optimum;  // y = 0
  const int forces = recursion_.problem().forces;
  if (!recursion_.sweep()) return {SolveStatus::kFailed, 0};
  recursion_.roll_out(optimum, f_W_);
  const auto is_finite = [](const Vec3& f_W) { return f_W.allFinite(); };
  if (!std::all_of(f_W_.begin(), f_W_.begin() + forces, is_finite)) {
    return {SolveStatus::kFailed, 0};
  }

  const int limited = forces_until_last_violation(pyramid);
  if (limited == 0) return {SolveStatus::kUnconstrained, 0};
  const QpSolution first = solve_nearest(pyramid, limited, config_.max_iterations);
  if (first.status == SolveStatus::kFailed || forces_until_last_violation(pyramid) <= limited) {
    return first;
  }
  recursion_.roll_out(optimum, f_W_);
  QpSolution second = solve_nearest(pyramid, forces, config_.max_iterations - first.iterations);
  second.iterations += first.iterations;
  return second;
}

ContactForces ConvexMpc::update(const MpcInput& in) noexcept {
  ContactForces out;
  collect_forces(in);
  const ForceProblem& problem = recursion_.problem();
  if (problem.forces == 0) return out;
  predict_free_motion(in);
  const QpSolution solution = solve(FrictionPyramid(
      in.n_W, config_.friction, config_.min_normal_force, config_.max_normal_force));
  out.status = solution.status;
  out.iterations = solution.iterations;
  if (solution.status == SolveStatus::kFailed) f_W_.fill(Vec3::Zero());
  for (int i = 0; i < problem.forces && problem.force[static_cast<size_t>(i)].step == 0; ++i) {
    out.f_W[problem.force[static_cast<size_t>(i)].leg] = f_W_[static_cast<size_t>(i)];
  }
  return out;
}

std::span<const Vec3> ConvexMpc::plan() const {
  return {f_W_.data(), static_cast<size_t>(recursion_.problem().forces)};
}

}  // namespace pirouette
