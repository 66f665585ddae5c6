#include "pirouette/estimation/tilt_bias.hpp"

#include "pirouette/base/rotation.hpp"

namespace pirouette {

void TiltBias::update(const Vec2& slope, double yaw, double dt) noexcept {
  if (averaging_time_ <= 0.0) return;
  const double share = 1.0 - std::exp(-dt / averaging_time_);
  mean_slope_ += share * (slope - mean_slope_);
  mean_slope_H_ += share * (rot2(yaw).transpose() * slope - mean_slope_H_);
  mean_turn_ += share * (Vec2(std::cos(yaw), std::sin(yaw)) - mean_turn_);
  weight_ += share * (1.0 - weight_);
}

Vec2 TiltBias::slope_H() const noexcept {
  constexpr double kPrior = 0.1;  // what the prior b = 0 weighs against 1 - |M|^2 of all data
  if (weight_ <= 0.0) return Vec2::Zero();
  const Vec2 turn = mean_turn_ / weight_;
  Mat2 M;
  M << turn.x(), -turn.y(), turn.y(), turn.x();
  const Vec2 difference = mean_slope_H_ - M.transpose() * mean_slope_;
  return difference / (weight_ * (1.0 - turn.squaredNorm()) + kPrior);
}

Vec3 TiltBias::rotation_B() const noexcept {
  constexpr double kMaxTilt = 0.02;  // rad, 0.2 m/s^2 of accelerometer bias
  const Vec2 b = clamp_norm(slope_H(), kMaxTilt);
  return {b.y(), -b.x(), 0.0};
}

}  // namespace pirouette
