// Position and velocity of the trunk from accelerometer and legs.
#pragma once

#include <optional>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/estimation/estimation_config.hpp"

namespace pirouette {

/// Measurement of one foot, world axes (the attitude is applied).
struct FootOdometry {
  Vec3 p_BF_W = Vec3::Zero();  ///< m, sphere centre from the trunk origin
  Vec3 v_BF_W =
      Vec3::Zero();  ///< m/s, its velocity relative to the trunk origin: omega x R p_BF + R J_v dq
  Vec3 v_WF_stance_W = Vec3::Zero();  ///< m/s, velocity of the sphere centre: rolling and creep
  double trust = 0.0;                 ///< in [0, 1]; 0: in the air, nothing it reports is used
  double centre_height = 0.0;  ///< m, expected height of the sphere centre when on the ground
  bool use_height = false;     ///< false: the height of the ground is not known
};

/// Input of LegOdometryFilter::update().
struct OdometryInput {
  Vec3 a_WB_W = Vec3::Zero();   ///< m/s^2, R_WB * specific force + gravity
  PerLeg<FootOdometry> foot{};  ///< measurement of each foot
};

/// Output of LegOdometryFilter::update(): trunk origin and feet, world axes.
struct OdometryEstimate {
  Vec3 p_WB = Vec3::Zero();    ///< m
  Vec3 v_WB_W = Vec3::Zero();  ///< m/s
  PerLeg<Vec3> p_WF{};         ///< m, filtered sphere centres
};

/// [Bledt18] linear Kalman filter with rolling feet: docs/equations.md#kalman-filter.
///
/// State (18): trunk position and velocity and four sphere centres. Measurements (28): foot
/// positions and velocities relative to the trunk, and foot heights; a foot in the air has none,
/// and its state is set to its kinematic position. Attitude enters only through the inputs, and all
/// noise is isotropic in the horizontal plane, so the filter is exactly one 6-state filter (p, v,
/// c_FR, c_FL, c_RR, c_RL) per world axis; x and y share their covariance.
class LegOdometryFilter {
 public:
  static constexpr int kStates = 6;                            ///< per world axis
  using Covariance = Eigen::Matrix<double, kStates, kStates>;  ///< of the states of one axis

  /// Starts at the origin.
  explicit LegOdometryFilter(const EstimationConfig& config) : config_(config) {
    reset(Vec3::Zero(), PerLeg<Vec3>{});
  }

  /// Estimate after one tick of `dt` (s).
  OdometryEstimate update(const OdometryInput& in, double dt) noexcept;
  /// Starts at rest, with trunk origin `p_WB` (m) and sphere centres `p_WF` (m).
  void reset(const Vec3& p_WB, const PerLeg<Vec3>& p_WF);

  /// Covariance of (p, v, c_FR, c_FL, c_RR, c_RL) along x or y; for tests.
  const Covariance& horizontal_covariance() const { return P_horizontal_; }
  const Covariance& vertical_covariance() const { return P_vertical_; }  ///< the same along z

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, x, P_horizontal, P_vertical] = self;
    visit(x, P_horizontal, P_vertical);
  }

 private:
  using StateByAxis = Eigen::Matrix<double, kStates, 3>;

  void predict(const OdometryInput& in, double dt) noexcept;
  void place_lifted_feet(const OdometryInput& in) noexcept;
  /// Horizontal velocity error (m/s) on which all fully trusted feet agree; absent when it is small
  /// or they do not agree.
  std::optional<double> velocity_jump(const OdometryInput& in) const noexcept;
  double noise_factor(double trust) const {
    return 1.0 + config_.swing_noise_factor * (1.0 - trust);
  }

  EstimationConfig config_;
  StateByAxis x_ = StateByAxis::Zero();
  Covariance P_horizontal_ = Covariance::Identity();
  Covariance P_vertical_ = Covariance::Identity();
};

}  // namespace pirouette
