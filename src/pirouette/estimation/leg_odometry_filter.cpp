#include "pirouette/estimation/leg_odometry_filter.hpp"

namespace pirouette {

namespace {

constexpr int kPosition = 0;
constexpr int kVelocity = 1;
constexpr double kInitialVariance = 1e-4;
// Absolute position is unobservable blind: the variance of a common shift of trunk and feet grows
// for ever. Whenever it reaches this limit, that one direction is scaled to half the variance, so
// that an hour-long run loses no precision. Scaling, unlike subtracting, keeps every covariance
// positive semidefinite.
constexpr double kMaxPositionVariance = 1.0;

constexpr double kFirmTrust = 0.999;     // of a foot in the middle of its stance
constexpr double kLargestDissent = 0.5;  // of a foot from the feet's mean, as a share of that

bool stands_firmly(const FootOdometry& foot) { return foot.trust >= kFirmTrust; }

/// m/s, the trunk's velocity that a foot on the ground tells of.
Vec3 measured_velocity(const FootOdometry& foot) { return foot.v_WF_stance_W - foot.v_BF_W; }

constexpr int foot_state(Leg leg) { return 2 + static_cast<int>(index(leg)); }

/// Scalar measurement updates are exact because the measurement noise is diagonal. `h` selects
/// state `plus` minus state `minus` (minus < 0: none).
template <int N, class Axes>
void update_scalar(Eigen::Matrix<double, N, N>& P, Axes&& x, int plus, int minus, const auto& z,
                   double variance) {
  Eigen::Matrix<double, N, 1> Ph = P.col(plus);
  if (minus >= 0) Ph -= P.col(minus);
  const double s = Ph(plus) - (minus >= 0 ? Ph(minus) : 0.0) + variance;
  const Eigen::Matrix<double, N, 1> gain = Ph / s;
  for (int axis = 0; axis < x.cols(); ++axis) {
    const double predicted = x(plus, axis) - (minus >= 0 ? x(minus, axis) : 0.0);
    x.col(axis) += gain * (z(axis) - predicted);
  }
  P.noalias() -= gain * Ph.transpose();
}

}  // namespace

void LegOdometryFilter::predict(const OdometryInput& in, double dt) noexcept {
  x_.row(kPosition) += dt * x_.row(kVelocity) + 0.5 * square(dt) * in.a_WB_W.transpose();
  x_.row(kVelocity) += dt * in.a_WB_W.transpose();

  Covariance F = Covariance::Identity();
  F(kPosition, kVelocity) = dt;
  Covariance Q = Covariance::Zero();
  Q(kPosition, kPosition) = config_.process_position * dt;
  Q(kVelocity, kVelocity) = config_.process_velocity * dt;
  for (const Leg leg : kLegs) {
    const FootOdometry& foot = in.foot[leg];
    x_.row(foot_state(leg)) += dt * foot.v_WF_stance_W.transpose();
    Q(foot_state(leg), foot_state(leg)) = config_.process_foot * dt * noise_factor(foot.trust);
  }
  for (Covariance* P : {&P_horizontal_, &P_vertical_}) {
    const Covariance FP = F * *P;
    P->noalias() = FP * F.transpose() + Q;
  }
}

/// A foot in the air is wherever the leg holds it: its state starts afresh from the trunk's at
/// every tick, so that at touchdown it knows nothing of its last stand.
void LegOdometryFilter::place_lifted_feet(const OdometryInput& in) noexcept {
  for (const Leg leg : kLegs) {
    if (in.foot[leg].trust > 0.0) continue;
    const int i = foot_state(leg);
    x_.row(i) = x_.row(kPosition) + in.foot[leg].p_BF_W.transpose();
    for (Covariance* P : {&P_horizontal_, &P_vertical_}) {
      P->row(i) = P->row(kPosition).eval();
      P->col(i) = P->col(kPosition).eval();
      (*P)(i, i) = (*P)(kPosition, kPosition) + config_.measurement_position;
    }
  }
}

std::optional<double> LegOdometryFilter::velocity_jump(const OdometryInput& in) const noexcept {
  PerLeg<Vec2> error_xy;
  Vec2 mean = Vec2::Zero();
  int firm = 0;
  for (const Leg leg : kLegs) {
    if (!stands_firmly(in.foot[leg])) continue;
    const Vec3 v_measured = measured_velocity(in.foot[leg]);
    error_xy[leg] = v_measured.head<2>() - x_.row(kVelocity).head<2>().transpose();
    mean += error_xy[leg];
    ++firm;
  }
  if (firm < 2) return std::nullopt;
  mean /= firm;
  if (mean.norm() < config_.velocity_jump) return std::nullopt;
  for (const Leg leg : kLegs) {
    if (!stands_firmly(in.foot[leg])) continue;
    if ((error_xy[leg] - mean).norm() > kLargestDissent * mean.norm()) return std::nullopt;
  }
  return mean.norm();
}

OdometryEstimate LegOdometryFilter::update(const OdometryInput& in, double dt) noexcept {
  predict(in, dt);
  place_lifted_feet(in);
  if (const std::optional<double> jump = velocity_jump(in))
    P_horizontal_(kVelocity, kVelocity) += square(*jump);
  auto horizontal = x_.leftCols<2>();
  auto vertical = x_.rightCols<1>();

  for (const Leg leg : kLegs) {
    const FootOdometry& foot = in.foot[leg];
    if (foot.trust <= 0.0) continue;
    const double factor = noise_factor(foot.trust);
    const Vec3 p_relative = -foot.p_BF_W;
    const Vec3 v_measured = measured_velocity(foot);
    const auto update_axes = [&](auto& P, auto&& x, auto axes) {
      update_scalar<kStates>(P, x, kPosition, foot_state(leg), axes(p_relative),
                             config_.measurement_position);
      update_scalar<kStates>(P, x, kVelocity, -1, axes(v_measured),
                             config_.measurement_velocity * factor);
    };
    update_axes(P_horizontal_, horizontal, [](const Vec3& v) -> Vec2 { return v.head<2>(); });
    update_axes(P_vertical_, vertical, [](const Vec3& v) { return v.tail<1>().eval(); });
    if (foot.use_height) {
      const Eigen::Matrix<double, 1, 1> height(foot.centre_height);
      update_scalar<kStates>(P_vertical_, vertical, foot_state(leg), -1, height,
                             config_.measurement_height * factor);
    }
  }

  for (Covariance* P : {&P_horizontal_, &P_vertical_}) {
    *P = 0.5 * (*P + P->transpose().eval());
    if ((*P)(kPosition, kPosition) > kMaxPositionVariance) {
      // p becomes k p, and the feet keep their place relative to it.
      Covariance scale = Covariance::Identity();
      for (int i = 0; i < kStates; ++i) {
        if (i != kVelocity) scale(i, kPosition) += std::sqrt(0.5) - 1.0;
      }
      *P = (scale * *P * scale.transpose()).eval();
    }
  }

  OdometryEstimate out;
  out.p_WB = x_.row(kPosition);
  out.v_WB_W = x_.row(kVelocity);
  for (const Leg leg : kLegs) out.p_WF[leg] = x_.row(foot_state(leg));
  return out;
}

void LegOdometryFilter::reset(const Vec3& p_WB, const PerLeg<Vec3>& p_WF) {
  x_.setZero();
  x_.row(kPosition) = p_WB;
  for (const Leg leg : kLegs) x_.row(foot_state(leg)) = p_WF[leg];
  P_horizontal_ = kInitialVariance * Covariance::Identity();
  P_vertical_ = P_horizontal_;
}

}  // namespace pirouette
