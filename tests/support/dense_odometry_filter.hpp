// The leg-odometry Kalman filter written out in full: 18 states, up to 28 measurements, dense
// matrices.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "pirouette/estimation/leg_odometry_filter.hpp"

namespace pirouette::test {

/// equations.md section 9 with feet in the air placed afresh; the reference for the one that falls
/// apart by axes.
class DenseOdometryFilter {
 public:
  explicit DenseOdometryFilter(const EstimationConfig& config) : config_(config) {}

  void reset(const Vec3& p_WB, const PerLeg<Vec3>& p_WF) {
    constexpr double kInitialVariance = 1e-4;
    x_.setZero();
    x_.segment<3>(0) = p_WB;
    for (const Leg leg : kLegs) x_.segment<3>(foot(leg)) = p_WF[leg];
    P_ = kInitialVariance * Matrix::Identity();
  }

  OdometryEstimate update(const OdometryInput& in, double dt) {
    predict(in, dt);
    for (const Leg leg : kLegs) {
      if (in.foot[leg].trust <= 0.0) place(leg, in.foot[leg].p_BF_W);
    }
    correct(in);
    OdometryEstimate out{x_.segment<3>(0), x_.segment<3>(3), {}};
    for (const Leg leg : kLegs) out.p_WF[leg] = x_.segment<3>(foot(leg));
    return out;
  }

 private:
  static constexpr int kStates = 18;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  static int foot(Leg leg) { return 6 + 3 * static_cast<int>(index(leg)); }
  double factor(double trust) const { return 1.0 + config_.swing_noise_factor * (1.0 - trust); }

  void predict(const OdometryInput& in, double dt) {
    Matrix F = Matrix::Identity();
    F.block<3, 3>(0, 3) = dt * Mat3::Identity();
    Vector drift = Vector::Zero(), noise = Vector::Zero();
    drift.segment<3>(0) = 0.5 * dt * dt * in.a_WB_W;
    drift.segment<3>(3) = dt * in.a_WB_W;
    noise.segment<3>(0).setConstant(config_.process_position * dt);
    noise.segment<3>(3).setConstant(config_.process_velocity * dt);
    for (const Leg leg : kLegs) {
      drift.segment<3>(foot(leg)) = dt * in.foot[leg].v_WF_stance_W;
      noise.segment<3>(foot(leg)).setConstant(config_.process_foot * dt *
                                              factor(in.foot[leg].trust));
    }
    x_ = F * x_ + drift;
    P_ = (F * P_ * F.transpose()).eval();
    P_.diagonal() += noise;
  }

  /// c = p + p_BF, known as well as the leg measures it.
  void place(Leg leg, const Vec3& p_BF_W) {
    Matrix T = Matrix::Identity();
    T.block<3, 3>(foot(leg), foot(leg)).setZero();
    T.block<3, 3>(foot(leg), 0).setIdentity();
    x_ = (T * x_).eval();
    x_.segment<3>(foot(leg)) += p_BF_W;
    P_ = (T * P_ * T.transpose()).eval();
    P_.diagonal().segment<3>(foot(leg)).array() += config_.measurement_position;
  }

  struct Row {
    Vector h;
    double value;
    double variance;
  };

  std::vector<Row> rows(const OdometryInput& in) const {
    std::vector<Row> out;
    for (const Leg leg : kLegs) {
      const FootOdometry& f = in.foot[leg];
      if (f.trust <= 0.0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        out.push_back({Vector::Unit(axis) - Vector::Unit(foot(leg) + axis), -f.p_BF_W[axis],
                       config_.measurement_position});
        out.push_back({Vector::Unit(3 + axis), f.v_WF_stance_W[axis] - f.v_BF_W[axis],
                       config_.measurement_velocity * factor(f.trust)});
      }
      if (f.use_height) {
        out.push_back({Vector::Unit(foot(leg) + 2), f.centre_height,
                       config_.measurement_height * factor(f.trust)});
      }
    }
    return out;
  }

  void correct(const OdometryInput& in) {
    const std::vector<Row> measured = rows(in);
    const auto count = static_cast<Eigen::Index>(measured.size());
    if (count == 0) return;
    Eigen::MatrixXd H(count, kStates), R = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd innovation(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Row& row = measured[static_cast<std::size_t>(i)];
      H.row(i) = row.h;
      R(i, i) = row.variance;
      innovation[i] = row.value - row.h.dot(x_);
    }
    const Eigen::MatrixXd gain = P_ * H.transpose() * (H * P_ * H.transpose() + R).inverse();
    x_ += gain * innovation;
    P_ = ((Matrix::Identity() - gain * H) * P_).eval();
  }

  EstimationConfig config_;
  Vector x_ = Vector::Zero();
  Matrix P_ = Matrix::Zero();
};

}  // namespace pirouette::test
