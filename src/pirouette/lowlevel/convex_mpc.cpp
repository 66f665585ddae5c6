#include "pirouette/lowlevel/convex_mpc.hpp"

#include "pirouette/lowlevel/friction_pyramid.hpp"

namespace pirouette {

namespace {

Vec3 to_vec(const std::array<double, 3>& a) { return Vec3(a[0], a[1], a[2]); }

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
      mass_(mass),
      inertia_B_(inertia_B),
      solver_(3, kPyramidRows, std::min(config.horizon * static_cast<int>(kLegCount), kMaxForces),
              config.max_iterations) {
  problem_ = &solver_.prepare(1);
}

void ConvexMpc::collect_variables(const MpcInput& in) noexcept {
  variable_count_ = 0;
  steps_ = 0;
  for (int j = 0; j < config_.horizon; ++j) {
    const MpcStep& step = in.steps[static_cast<size_t>(j)];
    const auto forces = static_cast<int>(std::count(step.stance.begin(), step.stance.end(), true));
    if (variable_count_ + forces > kMaxForces) return;
    steps_ = j + 1;
    const Mat3 R_WB = rotation_from_rpy(step.rpy_mid);
    const Mat3 inverse_inertia_W = R_WB * inertia_B_.inverse() * R_WB.transpose();
    for (const Leg leg : kLegs) {
      if (!step.stance[leg]) continue;
      Variable& v = variables_[static_cast<size_t>(variable_count_++)];
      v.step = j;
      v.leg = leg;
      v.W = in.dt * inverse_inertia_W * skew(step.p_WC[leg] - step.p_WG_mid);
    }
  }
}

void ConvexMpc::sum_rotations(const MpcInput& in) noexcept {
  S_[0].setZero();
  for (int i = 0; i < steps_; ++i) {
    const auto k = static_cast<size_t>(i);
    T_[k] = attitude_rate_map(in.steps[k].rpy_mid);
    S_[k + 1] = S_[k] + in.dt * T_[k];
    C_[k] = S_[k] + 0.5 * in.dt * T_[k];
  }
}

void ConvexMpc::fill_hessian(double dt) noexcept {
  const int N = steps_;
  const Vec3 weight_rpy = to_vec(config_.weight_rpy);
  const Vec3 weight_p = to_vec(config_.weight_position);
  const Vec3 weight_w = to_vec(config_.weight_angular_velocity);
  const Vec3 weight_v = to_vec(config_.weight_velocity);
  const Eigen::DiagonalMatrix<double, 3> L_rpy(weight_rpy);

  // Sums over the states k = m+1 .. N that forces of step m and earlier reach.
  std::array<Mat3, kMaxHorizon> sum_SLS, sum_LS;
  Mat3 sls = Mat3::Zero(), ls = Mat3::Zero();
  for (int m = N - 1; m >= 0; --m) {
    const Mat3& S = S_[static_cast<size_t>(m) + 1];
    ls += L_rpy * S;
    sls += S.transpose() * L_rpy * S;
    sum_LS[static_cast<size_t>(m)] = ls;
    sum_SLS[static_cast<size_t>(m)] = sls;
  }

  for (int column = 0; column < variable_count_;) {
    const int l = variables_[static_cast<size_t>(column)].step;  // the later step of the pair
    const auto ml = static_cast<size_t>(l);
    const double n = N - l;
    for (int row = 0; row < variable_count_ && variables_[static_cast<size_t>(row)].step <= l;) {
      const int j = variables_[static_cast<size_t>(row)].step;
      const auto mj = static_cast<size_t>(j);
      // Rotation: sum over k of (S_k - C_j)' L (S_k - C_l), and of the angular velocity's weight.
      Mat3 X = sum_SLS[ml] - C_[mj].transpose() * (sum_LS[ml] - n * (L_rpy * C_[ml]).eval()) -
               sum_LS[ml].transpose() * C_[ml];
      X.diagonal() += n * weight_w;
      // Translation: a force of step j moves p by (k - j - 1/2) dt^2/m and v by dt/m.
      double sum_arms = 0.0;
      for (int k = l + 1; k <= N; ++k) sum_arms += (k - j - 0.5) * (k - l - 0.5);
      const Vec3 translation =
          square(dt / mass_) * (square(dt) * sum_arms * weight_p + n * weight_v);

      int a = row;
      for (; a < variable_count_ && variables_[static_cast<size_t>(a)].step == j; ++a) {
        const Mat3 WX = variables_[static_cast<size_t>(a)].W.transpose() * X;
        for (int b = column; b < variable_count_ && variables_[static_cast<size_t>(b)].step == l;
             ++b) {
          Mat3 block = WX * variables_[static_cast<size_t>(b)].W;
          block.diagonal() += translation;
          if (a == b) block.diagonal().array() += config_.weight_force;
          problem_->H.block<3, 3>(3 * a, 3 * b) = 2.0 * block;
          problem_->H.block<3, 3>(3 * b, 3 * a) = 2.0 * block.transpose();
        }
      }
      row = a;
    }
    while (column < variable_count_ && variables_[static_cast<size_t>(column)].step == l) ++column;
  }
}

void ConvexMpc::fill_gradient(const MpcInput& in) noexcept {
  const int N = steps_;
  const double dt = in.dt;
  const Vec3 weight_rpy = to_vec(config_.weight_rpy);
  const Vec3 weight_p = to_vec(config_.weight_position);
  const Vec3 weight_w = to_vec(config_.weight_angular_velocity);
  const Vec3 weight_v = to_vec(config_.weight_velocity);
  const Vec3 gravity(0.0, 0.0, -kGravity);

  // Suffix sums of the weighted errors of the force-free motion, from the horizon's end backwards.
  std::array<Vec3, kMaxHorizon> grad_w, grad_rpy, grad_S_rpy, grad_v, grad_p, grad_kp;
  Vec3 w = Vec3::Zero(), r = Vec3::Zero(), sr = Vec3::Zero();
  Vec3 v = Vec3::Zero(), p = Vec3::Zero(), kp = Vec3::Zero();
  for (int k = N; k >= 1; --k) {
    const auto m = static_cast<size_t>(k) - 1;
    const BodyMotion& reference = in.steps[m].reference;
    const double t = k * dt;
    const Vec3 e_rpy = in.now.rpy + S_[m + 1] * in.now.w_WB_W - reference.rpy;
    const Vec3 e_p = in.now.p_WG + t * in.now.v_WG_W + 0.5 * square(t) * gravity - reference.p_WG;
    const Vec3 weighted_rpy = weight_rpy.cwiseProduct(e_rpy);
    const Vec3 weighted_p = weight_p.cwiseProduct(e_p);
    w += weight_w.cwiseProduct(in.now.w_WB_W - reference.w_WB_W);
    v += weight_v.cwiseProduct(in.now.v_WG_W + t * gravity - reference.v_WG_W);
    r += weighted_rpy;
    sr += S_[m + 1].transpose() * weighted_rpy;
    p += weighted_p;
    kp += k * weighted_p;
    grad_w[m] = w;
    grad_rpy[m] = r;
    grad_S_rpy[m] = sr;
    grad_v[m] = v;
    grad_p[m] = p;
    grad_kp[m] = kp;
  }
  for (int i = 0; i < variable_count_; ++i) {
    const Variable& variable = variables_[static_cast<size_t>(i)];
    const auto j = static_cast<size_t>(variable.step);
    const Vec3 rotation = grad_S_rpy[j] - C_[j].transpose() * grad_rpy[j] + grad_w[j];
    const Vec3 translation =
        dt / mass_ * (dt * (grad_kp[j] - (variable.step + 0.5) * grad_p[j]) + grad_v[j]);
    problem_->g.segment<3>(3 * i) = 2.0 * (variable.W.transpose() * rotation + translation);
  }
}

void ConvexMpc::fill_constraints(const Vec3& n_W) noexcept {
  const FrictionPyramid pyramid(n_W, config_.friction, config_.min_normal_force,
                                config_.max_normal_force);
  for (int i = 0; i < variable_count_; ++i) {
    problem_->C.block<kPyramidRows, 3>(kPyramidRows * i, 3 * i) = pyramid.C;
    problem_->lower.segment<kPyramidRows>(kPyramidRows * i) = pyramid.lower;
  }
}

ContactForces ConvexMpc::update(const MpcInput& in) noexcept {
  ContactForces out;
  collect_variables(in);
  if (variable_count_ == 0) return out;
  problem_ = &solver_.prepare(variable_count_);
  sum_rotations(in);
  fill_hessian(in.dt);
  fill_gradient(in);
  fill_constraints(in.n_W);
  const QpSolution solution = solver_.solve();
  out.status = solution.status;
  out.iterations = solution.iterations;
  for (int i = 0; i < variable_count_ && variables_[static_cast<size_t>(i)].step == 0; ++i) {
    out.f_W[variables_[static_cast<size_t>(i)].leg] = problem_->x.segment<3>(3 * i);
  }
  return out;
}

}  // namespace pirouette
