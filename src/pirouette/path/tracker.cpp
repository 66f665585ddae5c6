#include "pirouette/path/tracker.hpp"

#include "pirouette/base/rotation.hpp"
#include "pirouette/path/lqr.hpp"

namespace pirouette {
namespace {

constexpr double kGainRefresh = 0.01;  // rad/s, change of the yaw rate that is worth a new gain

Mat3 diagonal_matrix(const std::array<double, 3>& entries) {
  return Vec3(entries[0], entries[1], entries[2]).asDiagonal();
}

}  // namespace

Tracker::Tracker(const PathConfig& config, double control_rate)
    : config_(config), control_period_(1.0 / control_rate) {
  solve_gain(0.0);
}

void Tracker::reset() noexcept {
  integral_H_.setZero();
  correction_H_.setZero();
  yaw_rate_correction_ = 0.0;
}

TwistCommand Tracker::update(const PathPoint& reference, const RobotState& state,
                             double dt) noexcept {
  // Exact variant of the law: the feed-forward turns into the robot's heading, so that the heading
  // error drops out of the position error (docs/equations.md#eq-22).
  const double e_yaw = wrap_angle(state.rpy.yaw - reference.yaw);
  const Mat2 R_HR = rot2(-e_yaw);
  const TwistCommand feed_forward{R_HR * reference.v_H, reference.yaw_rate};
  if (config_.tracker == PathTracker::kNone) return feed_forward;

  if (std::abs(reference.yaw_rate - gain_yaw_rate_) > kGainRefresh) solve_gain(reference.yaw_rate);
  const Vec2 e_R = rot2(-reference.yaw) * (state.p_WG.head<2>() - reference.p_WG);
  const Vec3 feedback = -gain_ * Vec3(e_R.x(), e_R.y(), e_yaw);
  const Vec2 proportional_H = R_HR * feedback.head<2>();
  if (config_.tracker == PathTracker::kLqi) integrate(R_HR * e_R, proportional_H, dt);

  const Vec2 wanted_H =
      clamp_norm(Vec2(proportional_H + integral_H_), config_.max_velocity_correction);
  correction_H_ += clamp_norm(Vec2(wanted_H - correction_H_), config_.max_correction_rate * dt);
  const double wanted_yaw_rate =
      std::clamp(feedback.z(), -config_.max_yaw_rate_correction, config_.max_yaw_rate_correction);
  const double yaw_step = config_.max_yaw_acceleration * dt;
  yaw_rate_correction_ += std::clamp(wanted_yaw_rate - yaw_rate_correction_, -yaw_step, yaw_step);
  return {feed_forward.v_H + correction_H_, feed_forward.yaw_rate + yaw_rate_correction_};
}

// With the exact variant the error moves as if the reference stood still, so v_r = 0 in its
// dynamics.
void Tracker::solve_gain(double yaw_rate) noexcept {
  const auto solution =
      solve_dare(discretise_zoh(Vec2::Zero(), yaw_rate, control_period_),
                 diagonal_matrix(config_.state_weight), diagonal_matrix(config_.input_weight));
  if (!solution) return;
  gain_ = solution->K;
  gain_yaw_rate_ = yaw_rate;
}

void Tracker::integrate(const Vec2& e_H, const Vec2& proportional_H, double dt) noexcept {
  const Vec2 next =
      clamp_norm(Vec2(integral_H_ - config_.integral_gain * dt * e_H), config_.integral_limit);
  const bool saturated = (proportional_H + next).norm() > config_.max_velocity_correction;
  if (saturated && next.norm() > integral_H_.norm()) return;
  integral_H_ = next;
}

}  // namespace pirouette
