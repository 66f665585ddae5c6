// Motions in closed form, as the metrics see them.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "pirouette/base/random.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/metrics/motion_metrics.hpp"

namespace pirouette::test {

using Motion = std::vector<MotionSample>;

inline constexpr double kRate = 500.0;   // Hz
inline constexpr double kYawRate = 0.7;  // rad/s

inline Metrics measure(const Motion& motion, const CommandedMotion& commanded, double rate) {
  MotionMetrics metrics(commanded, rate);
  for (const MotionSample& sample : motion) metrics.add(sample);
  return metrics.result();
}

/// A spin about `centre` whose CoM has the body-fixed velocity `bias` (m/s) and drifts by `drift`
/// (m per turn) along x: a circle of radius |bias| / yaw rate. `roll_amplitude` (rad) swings at 2
/// Hz.
inline Motion synthetic_spin(double turns, const Vec2& centre, const Vec2& bias, double drift,
                             double yaw_rate = kYawRate, double roll_amplitude = 0.0) {
  constexpr double kRollFrequency = 2.0 * 2.0 * kPi;  // rad/s
  Motion motion;
  const auto count = static_cast<int>(std::lround(turns * 2.0 * kPi / std::abs(yaw_rate) * kRate));
  const Vec2 arm = Vec2(bias.y(), -bias.x()) / yaw_rate;
  const Vec2 drift_velocity = Vec2(drift, 0.0) * std::abs(yaw_rate) / (2.0 * kPi);
  for (int i = 0; i <= count; ++i) {
    const double t = i / kRate;
    const double yaw = 3.0 + yaw_rate * t;  // passes +-pi at once
    PlantTruth truth;
    truth.time = 6.0 + t;
    truth.p_WG.head<2>() = centre + rot2(yaw) * arm + drift_velocity * t;
    truth.v_WG_W.head<2>() = rot2(yaw) * bias + drift_velocity;
    const double roll = roll_amplitude * std::sin(kRollFrequency * t);
    truth.base.R_WB = rotation_from_rpy({roll, -0.01, yaw});
    truth.base.w_WB_B.x() = roll_amplitude * kRollFrequency * std::cos(kRollFrequency * t);
    truth.a_WB_W = Vec3(0.3 * std::sin(kRollFrequency * t), 0.0, 0.0);
    RobotState estimate;
    estimate.p_WB = truth.base.p_WB + Vec3(0.003, 0.004, 0.5);
    estimate.rpy.yaw = yaw - 4.0 * kPi + 0.02;  // another branch
    motion.push_back(motion_sample(truth, yaw, estimate, 0.0));
  }
  return motion;
}

/// A robot that turns as a real one does: the trunk sways with the stride, in yaw too, every
/// quantity is noisy, and the CoM wanders.
class WalkingMotion {
 public:
  explicit WalkingMotion(double yaw_rate, double radius = 0.003)
      : yaw_rate_(yaw_rate), radius_(radius) {}

  MotionSample next() {
    constexpr double kStride = 2.0 * kPi * 2.5;  // rad/s
    const double t = static_cast<double>(tick_++) / kRate;
    const double sway = std::sin(kStride * t);
    MotionSample s;
    s.time = 5.0 + t;
    s.yaw = 0.4 + yaw_rate_ * t + 0.01 * sway;
    wander_ += 2e-6 * noise2();
    wander_error_ += 1e-6 * noise2();
    s.p_WG =
        Vec2(0.2, -0.1) + wander_ + rot2(s.yaw) * Vec2(radius_, 0.0005 * sway + 0.0002 * noise());
    s.v_WG_W = rot2(s.yaw) * Vec2(0.01 * sway, yaw_rate_ * radius_) + 0.001 * noise2();
    s.roll = 0.01 + 0.02 * sway + 0.001 * noise();
    s.pitch = -0.02 + 0.005 * sway + 0.001 * noise();
    s.relative_roll = s.roll;
    s.relative_pitch = s.pitch;
    s.a_WB_W = Vec2(0.3 * sway, 0.1) + noise2();
    s.roll_rate = 0.02 * kStride * std::cos(kStride * t) + 0.01 * noise();
    s.pitch_rate = 0.03 * noise();
    s.position_error = wander_error_ + 0.001 * noise2();
    s.yaw_error = std::abs(0.02 * noise());
    s.slip[Leg::kFR] = std::abs(noise());
    return s;
  }

 private:
  double noise() { return 2.0 * unit_interval(generator_()) - 1.0; }
  Vec2 noise2() {
    const double x = noise();
    return {x, noise()};
  }

  double yaw_rate_;  // rad/s
  double radius_;    // m
  std::int64_t tick_ = 0;
  std::mt19937_64 generator_{1};
  Vec2 wander_ = Vec2::Zero(), wander_error_ = Vec2::Zero();
};

inline Motion walking_motion(double yaw_rate, double minutes) {
  WalkingMotion walk(yaw_rate);
  Motion motion;
  for (int i = 0; i < static_cast<int>(minutes * 60.0 * kRate); ++i) motion.push_back(walk.next());
  return motion;
}

}  // namespace pirouette::test
