#include "pirouette/lowlevel/force_recursion.hpp"

#include <Eigen/Cholesky>

namespace pirouette {

namespace {

// First rows of the parts of a deviation.
constexpr int kAttitude = 0, kPosition = 3, kAngular = 6, kVelocity = 9;

}  // namespace

ForceRecursion::ForceRecursion(const MpcConfig& config, double mass)
    : weight_force_(config.weight_force), mass_(mass) {
  weight_ << Eigen::Map<const Vec3>(config.weight_rpy.data()),
      Eigen::Map<const Vec3>(config.weight_position.data()),
      Eigen::Map<const Vec3>(config.weight_angular_velocity.data()),
      Eigen::Map<const Vec3>(config.weight_velocity.data());
}

/// M B, where B f is the deviation that a force f, held over its step, leaves at the step's end.
template <int Rows>
Eigen::Matrix<double, Rows, 3> ForceRecursion::times_input(
    const Eigen::Matrix<double, Rows, 12>& M, const PlannedForce& force) const noexcept {
  const double h = problem_.dt;
  const Mat3& T = problem_.T[static_cast<size_t>(force.step)];
  Eigen::Matrix<double, Rows, 3> turn = M.template middleCols<3>(kAngular);
  turn += 0.5 * h * M.template middleCols<3>(kAttitude).lazyProduct(T);
  return turn.lazyProduct(force.W) +
         h / mass_ *
             (0.5 * h * M.template middleCols<3>(kPosition) + M.template middleCols<3>(kVelocity));
}

/// d += B f.
template <int Columns>
void ForceRecursion::apply(const PlannedForce& force, const Eigen::Matrix<double, 3, Columns>& f,
                           Eigen::Matrix<double, 12, Columns>& d) const noexcept {
  const double h = problem_.dt;
  const Eigen::Matrix<double, 3, Columns> dw = force.W * f;
  d.template middleRows<3>(kAttitude) += 0.5 * h * problem_.T[static_cast<size_t>(force.step)] * dw;
  d.template middleRows<3>(kPosition) += 0.5 * h * h / mass_ * f;
  d.template middleRows<3>(kAngular) += dw;
  d.template middleRows<3>(kVelocity) += h / mass_ * f;
}

/// d = A d over `step`.
template <int Columns>
void ForceRecursion::advance(int step, Eigen::Matrix<double, 12, Columns>& d) const noexcept {
  const double h = problem_.dt;
  d.template middleRows<3>(kAttitude) +=
      h * problem_.T[static_cast<size_t>(step)] * d.template middleRows<3>(kAngular);
  d.template middleRows<3>(kPosition) += h * d.template middleRows<3>(kVelocity);
}

/// The cost to go from the end of `step`, as a function of the deviation at its beginning.
void ForceRecursion::carry_back(int step) noexcept {
  const double h = problem_.dt;
  const Mat3 hT = h * problem_.T[static_cast<size_t>(step)];
  P_.middleCols<3>(kAngular) += P_.middleCols<3>(kAttitude).lazyProduct(hT);
  P_.middleCols<3>(kVelocity) += h * P_.middleCols<3>(kPosition);
  P_.middleRows<3>(kAngular) += hT.transpose().lazyProduct(P_.middleRows<3>(kAttitude));
  P_.middleRows<3>(kVelocity) += h * P_.middleRows<3>(kPosition);
  q_.segment<3>(kAngular) += hT.transpose() * q_.segment<3>(kAttitude);
  q_.segment<3>(kVelocity) += h * q_.segment<3>(kPosition);
}

bool ForceRecursion::sweep() noexcept {
  P_.setZero();
  q_.setZero();
  int i = problem_.forces - 1;
  for (int step = problem_.steps - 1; step >= 0; --step) {
    P_.diagonal() += weight_;
    q_ += weight_.cwiseProduct(problem_.free_error[static_cast<size_t>(step)]);
    for (; i >= 0 && problem_.force[static_cast<size_t>(i)].step == step; --i) {
      const PlannedForce& force = problem_.force[static_cast<size_t>(i)];
      const Mat12x3 PB = times_input<12>(P_, force);
      Mat3 curvature = times_input<3>(PB.transpose(), force);
      curvature.diagonal().array() += weight_force_;
      const Eigen::LLT<Mat3> cholesky(curvature);
      if (cholesky.info() != Eigen::Success) return false;
      Feedback& feedback = feedback_[static_cast<size_t>(i)];
      feedback.Z = cholesky.matrixU().solve(Mat3::Identity());
      feedback.Y = PB.lazyProduct(feedback.Z);
      feedback.y0 = feedback.Z.transpose() * times_input<1>(q_.transpose(), force).transpose();
      P_ -= feedback.Y.lazyProduct(feedback.Y.transpose());
      q_ -= feedback.Y * feedback.y0;
    }
    carry_back(step);
  }
  return true;
}

void ForceRecursion::roll_out(const Eigen::VectorXd& y,
                              std::array<Vec3, kMaxForces>& f_W) const noexcept {
  BodyDeviation d = BodyDeviation::Zero();
  int i = 0;
  for (int step = 0; step < problem_.steps; ++step) {
    advance(step, d);
    for (; i < problem_.forces && problem_.force[static_cast<size_t>(i)].step == step; ++i) {
      const Feedback& feedback = feedback_[static_cast<size_t>(i)];
      Vec3 input = -feedback.y0 - feedback.Y.transpose() * d;
      if (3 * i < y.size()) input += y.segment<3>(3 * i);
      Vec3& f = f_W[static_cast<size_t>(i)];
      f = feedback.Z * input;
      apply(problem_.force[static_cast<size_t>(i)], f, d);
    }
  }
}

void ForceRecursion::factor_column(int j, int count,
                                   std::array<Mat3, kMaxForces>& column) const noexcept {
  column[static_cast<size_t>(j)] = feedback_[static_cast<size_t>(j)].Z;
  Mat12x3 d = Mat12x3::Zero();
  apply(problem_.force[static_cast<size_t>(j)], column[static_cast<size_t>(j)], d);
  int step = problem_.force[static_cast<size_t>(j)].step;
  for (int i = j + 1; i < count; ++i) {
    const PlannedForce& force = problem_.force[static_cast<size_t>(i)];
    while (step < force.step) advance(++step, d);
    const Feedback& feedback = feedback_[static_cast<size_t>(i)];
    Mat3& block = column[static_cast<size_t>(i)];
    block = -feedback.Z * feedback.Y.transpose().lazyProduct(d).eval();
    apply(force, block, d);
  }
}

}  // namespace pirouette
