#include "pirouette/controller/standing_check.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pirouette/base/rotation.hpp"
#include "pirouette/controller/tick_clock.hpp"
#include "pirouette/estimation/attitude_filter.hpp"
#include "pirouette/foot/leg_kinematics.hpp"

namespace pirouette {
namespace {

constexpr double kSettleTime = 0.1;    // s, in which the robot sags into its stance
constexpr double kStillTime = 0.2;     // s, watched standing still
constexpr double kTurnTime = 0.2;      // s, for the turn about one axis
constexpr double kTurnAngle = 0.01;    // rad, its largest
constexpr double kStiffness = 2.0;     // of a joint, in the weight times the leg's length per rad
constexpr double kDampingTime = 0.05;  // s, damping over stiffness
constexpr int kMaxTries = 20;          // of standing still: 6 s

// What is allowed. Wide: it is about wiring, not about calibration.
constexpr double kPeriodError = 0.3;     // share
constexpr double kMillisecond = 1000.0;  // s per s
constexpr double kRangeSlack = 0.15;     // rad, beyond a joint's range
constexpr double kPlaneError = 0.25;     // of the leg's length
constexpr double kGravityError = 0.15;   // share
constexpr double kNearlyNothing = 0.2;   // share of g
constexpr double kUpright = 0.5;         // share of g along z: 60 degrees
constexpr double kMaxBias = 0.2;         // rad/s, mean turn at rest
constexpr double kMaxShake = 0.2;        // rad/s, its deviation
constexpr double kGiveWay = 0.3;         // rad, that a joint may sag
constexpr double kLeastLift = 0.55;      // of the weight
constexpr double kMostLift = 1.8;        // of the weight
constexpr double kGyroError = 0.4;       // share
constexpr double kMisfit = 0.3;          // share of the feet's motion that is not rigid
constexpr double kSwapMisfit = 0.1;  // the same when front and rear are swapped: mirrored legs fit
constexpr double kMinDeterminant = 1e-5;  // of a leg's Jacobian over its length^3: not straight

/// Within `error`, a share of `expected`.
bool is_near(double value, double expected, double error) {
  return std::abs(value / expected - 1.0) < error;
}

/// The leg is not straight: its Jacobian `J` can be inverted.
bool is_bent(const LegGeometry& leg, const Mat3& J) {
  const double length = leg.thigh + leg.shank;
  return std::abs(J.determinant()) > kMinDeterminant * length * length * length;
}

/// Each axis becomes one axis, of either sign.
bool exchanges_axes(const Mat3& axes) {
  for (const auto& row : axes.cwiseAbs().rowwise()) {
    Vec3 sizes = row.transpose();
    std::sort(sizes.begin(), sizes.end());
    if (!is_near(sizes.z(), 1.0, kGyroError) || sizes.y() > kGyroError) return false;
  }
  return true;
}

/// rad/s, of a trunk whose standing feet move with `feet` against it.
Vec3 rate_over_feet(const PerLeg<FootState>& feet) {
  PerLeg<Vec3> before, after;
  for (const Leg leg : kLegs) {
    before[leg] = feet[leg].p_BF;
    after[leg] = feet[leg].p_BF + feet[leg].v_BF_B;  // in 1 s: the least squares are linear
  }
  return turn_over_feet(before, after);
}

}  // namespace

StandingCheck::StandingCheck(const SafetyConfig& config, double period, double mass,
                             const Vec3& p_BG, const PerLeg<LegGeometry>& legs)
    : config_(config), period_(period), mass_(mass), p_BG_(p_BG), legs_(legs) {
  reset();
}

void StandingCheck::reset() noexcept {
  state_ = config_.self_check == SelfCheckMode::kNone ? SelfCheck::kSkipped : SelfCheck::kRunning;
  command_ = {};
  ticks_ = tries_ = 0;
  stance_ = {};
  still_ = {};
  turning_ = {};
}

void StandingCheck::update(const StandingCheckInput& in) noexcept {
  if (ticks_ == 0 && tries_ == 0) {
    begin(in);
    state_ = first_look(in);
  }
  if (state_ != SelfCheck::kRunning) return;
  if (gives_way(in)) {
    state_ = SelfCheck::kLegsGiveWay;
    return;
  }
  const int still_from = ticks_in(kSettleTime, period_);
  const int turn_from = still_from + ticks_in(kStillTime, period_);
  const int end = turn_from + 3 * ticks_in(kTurnTime, period_);
  if (ticks_ >= still_from && ticks_ < turn_from) watch_still(in);
  if (ticks_ == turn_from) {
    const SelfCheck seen = judge_still();
    if (seen == SelfCheck::kNotStill && ++tries_ < kMaxTries) {
      still_ = {};
      ticks_ = 1;
      return;
    }
    const bool turns = config_.self_check == SelfCheckMode::kTurn;
    if (has_failed(seen)) {
      state_ = seen;
    } else if (!turns) {
      state_ = judge_bias();
    }
  }
  if (ticks_ >= turn_from) watch_turn(in);
  if (ticks_ == end && state_ == SelfCheck::kRunning) {
    const SelfCheck seen = judge_turn();
    state_ = has_failed(seen) ? seen : judge_bias();
  }
  ++ticks_;
  hold(turn_at((ticks_ - turn_from) * period_));
}

bool StandingCheck::turns() const noexcept {
  return state_ == SelfCheck::kRunning &&
         ticks_ >= ticks_in(kSettleTime, period_) + ticks_in(kStillTime, period_);
}

void StandingCheck::begin(const StandingCheckInput& in) noexcept {
  stance_.q = in.sensors.joint_position;
  Vec2 centre = Vec2::Zero();
  for (const Leg leg : kLegs) {
    stance_.p_BF[leg] = in.feet[leg].p_BF;
    centre += in.feet[leg].p_BF.head<2>() / kLegCount;
  }
  // The shares of the weight that are nearest to each other and have their centre below the CoM.
  Mat2 spread = Mat2::Zero();
  for (const Leg leg : kLegs) {
    const Vec2 arm = stance_.p_BF[leg].head<2>() - centre;
    spread += arm * arm.transpose();
  }
  const Vec2 tilt = spread.ldlt().solve(Vec2(p_BG_.head<2>() - centre));
  for (const Leg leg : kLegs) {
    const Vec2 arm = stance_.p_BF[leg].head<2>() - centre;
    stance_.f[leg] = mass_ * kGravity * (1.0 / kLegCount + arm.dot(tilt));
  }
  hold({});
}

/// Joint angles at which the feet are where they were and the trunk has turned by `turn`.
void StandingCheck::hold(const Turn& turn) noexcept {
  for (const Leg leg : kLegs) {
    const LegGeometry& g = legs_[leg];
    const double stiffness = kStiffness * mass_ * kGravity * (g.thigh + g.shank);
    const Vec3 p_BF = exp_so3(Vec3(-turn.angle_B)) * stance_.p_BF[leg];
    const bool turns = !turn.angle_B.isZero(0.0);
    LegCommand& c = command_[leg];
    c.q = turns ? inverse_kinematics(g, Vec3(p_BF - g.p_BH)).q : stance_.q[leg];
    const Mat3 J = foot_jacobian(g, c.q);
    c.dq = is_bent(g, J) ? Vec3(J.inverse() * p_BF.cross(turn.rate_B)) : Vec3::Zero();
    c.tau = Vec3(J.transpose() * Vec3(0.0, 0.0, -stance_.f[leg]))
                .cwiseMax(-g.tau_max)
                .cwiseMin(g.tau_max);
    c.kp.setConstant(stiffness);
    c.kd.setConstant(stiffness * kDampingTime);
  }
}

/// Left, right and back, without a jump of the rate, about x, then y, then z: both ways, so that
/// what the feet slip one way they slip back.
StandingCheck::Turn StandingCheck::turn_at(double time) const noexcept {
  Turn turn;
  if (time < 0.0 || time >= 3.0 * kTurnTime) return turn;
  constexpr double kLargest = 1.299038105676658;  // of sin x (1 - cos x): 3 sqrt(3) / 4
  const auto axis = static_cast<Eigen::Index>(time / kTurnTime);
  const double phase = 2.0 * kPi * (time / kTurnTime - static_cast<double>(axis));
  const double angle = kTurnAngle / kLargest;
  turn.angle_B[axis] = angle * std::sin(phase) * (1.0 - std::cos(phase));
  turn.rate_B[axis] = angle * 2.0 * kPi / kTurnTime * (std::cos(phase) - std::cos(2.0 * phase));
  return turn;
}

SelfCheck StandingCheck::first_look(const StandingCheckInput& in) const noexcept {
  std::array<Vec3, kLegCount> feet;
  double length = 0.0;
  for (const Leg leg : kLegs) {
    const Vec3& q = in.sensors.joint_position[leg];
    const LegGeometry& g = legs_[leg];
    if (q.cwiseAbs().maxCoeff() > 4.0 * kPi) return SelfCheck::kJointsInDegrees;
    const bool low = (q.array() < g.q_min.array() - kRangeSlack).any();
    const bool high = (q.array() > g.q_max.array() + kRangeSlack).any();
    if (low || high) return SelfCheck::kJointRange;
    feet[index(leg)] = in.feet[leg].p_BF;
    length = g.thigh + g.shank;
    if (in.feet[leg].p_BF.z() > g.p_BH.z()) return SelfCheck::kFeetNotOnPlane;
  }
  // Four points are coplanar when the diagonals of their quadrangle meet.
  const Vec3 across = (feet[index(Leg::kFR)] + feet[index(Leg::kRL)]) / 2.0 -
                      (feet[index(Leg::kFL)] + feet[index(Leg::kRR)]) / 2.0;
  if (std::abs(across.z()) > kPlaneError * length) return SelfCheck::kFeetNotOnPlane;
  return SelfCheck::kRunning;
}

bool StandingCheck::gives_way(const StandingCheckInput& in) const noexcept {
  for (const Leg leg : kLegs) {
    const Vec3 sag = in.sensors.joint_position[leg] - stance_.q[leg];
    if (sag.cwiseAbs().maxCoeff() > kGiveWay) return true;
  }
  return false;
}

/// N: what the joints' torques, as commanded, press on the ground.
double StandingCheck::lift(const StandingCheckInput& in) const noexcept {
  double sum = 0.0;
  const Vec3 up_B = in.sensors.specific_force_B.normalized();
  for (const Leg leg : kLegs) {
    const Vec3& q = in.sensors.joint_position[leg];
    const Vec3 tau = in.last_command[leg].torque(q, in.sensors.joint_velocity[leg]);
    const Mat3 J = foot_jacobian(legs_[leg], q);
    if (!is_bent(legs_[leg], J)) return mass_ * kGravity;
    sum -= up_B.dot(Vec3(J.transpose().inverse() * tau));
  }
  return sum;
}

void StandingCheck::watch_still(const StandingCheckInput& in) noexcept {
  if (still_.samples == 0.0) still_.first_time = in.sensors.time;
  still_.samples += 1.0;
  still_.last_time = in.sensors.time;
  still_.sum_a += in.sensors.specific_force_B;
  still_.sum_gyro += in.sensors.w_WB_B;
  const Vec3 by_legs = rate_over_feet(in.feet);
  still_.sum_legs += by_legs;
  still_.sum_legs2 += by_legs.squaredNorm();
  still_.sum_lift += lift(in);
}

SelfCheck StandingCheck::judge_clock() const noexcept {
  const double passed = still_.last_time - still_.first_time;
  const double rate = passed / ((still_.samples - 1.0) * period_);
  if (rate <= 0.0) return SelfCheck::kClockStopped;
  if (is_near(rate, kMillisecond, kPeriodError)) return SelfCheck::kClockInMilliseconds;
  return is_near(rate, 1.0, kPeriodError) ? SelfCheck::kRunning : SelfCheck::kClockRate;
}

SelfCheck StandingCheck::judge_accelerometer(const Vec3& a) const noexcept {
  const double size = a.norm();
  if (is_near(size, 1.0, kGravityError)) return SelfCheck::kAccelerometerInG;
  if (size < kNearlyNothing * kGravity) return SelfCheck::kGravityMissing;
  if (!is_near(size, kGravity, kGravityError)) return SelfCheck::kAccelerometerSize;
  if (a.z() < -kUpright * kGravity) return SelfCheck::kAccelerometerUpsideDown;
  if (a.z() < kUpright * kGravity) return SelfCheck::kAccelerometerAxes;
  return SelfCheck::kRunning;
}

SelfCheck StandingCheck::judge_still() const noexcept {
  const SelfCheck clock = judge_clock();
  if (has_failed(clock)) return clock;
  const SelfCheck accelerometer = judge_accelerometer(still_.sum_a / still_.samples);
  if (has_failed(accelerometer)) return accelerometer;
  // The legs tell whether the robot is moved: the gyro is not trusted yet.
  const Vec3 mean = still_.sum_legs / still_.samples;
  const double shake = still_.sum_legs2 / still_.samples - mean.squaredNorm();
  if (mean.norm() > kMaxBias || shake > square(kMaxShake)) return SelfCheck::kNotStill;
  const double lift = still_.sum_lift / still_.samples / (mass_ * kGravity);
  if (lift < kLeastLift || lift > kMostLift) return SelfCheck::kTorqueScale;
  return SelfCheck::kRunning;
}

/// The last of all: a gyro that is right in everything else may have a bias.
SelfCheck StandingCheck::judge_bias() const noexcept {
  const double bias = (still_.sum_gyro / still_.samples).norm();
  return bias > kMaxBias ? SelfCheck::kGyroTurns : SelfCheck::kPassed;
}

void StandingCheck::watch_turn(const StandingCheckInput& in) noexcept {
  const Vec3 by_gyro = in.sensors.w_WB_B - still_.sum_gyro / still_.samples;
  const Vec3 by_legs = rate_over_feet(in.feet);
  turning_.gyro_legs += by_gyro * by_legs.transpose();
  turning_.legs_legs += by_legs * by_legs.transpose();
  Vec3 shift = Vec3::Zero();
  for (const Leg leg : kLegs) {
    shift += (in.feet[leg].v_BF_B + by_legs.cross(in.feet[leg].p_BF)) / kLegCount;
  }
  for (const Leg leg : kLegs) {
    const Vec3 v = in.feet[leg].v_BF_B;
    turning_.foot_speed += v.squaredNorm();
    turning_.misfit += (v + by_legs.cross(in.feet[leg].p_BF) - shift).squaredNorm();
  }
}

SelfCheck StandingCheck::judge_turn() const noexcept {
  // Column by column what the gyro reads when the legs turn about an axis: the identity.
  const Mat3 seen = turning_.gyro_legs * turning_.legs_legs.inverse();
  Vec3 largest = seen.cwiseAbs().rowwise().maxCoeff();
  std::sort(largest.begin(), largest.end());
  const double size = largest.y();
  if (seen.norm() < kNearlyNothing || !seen.allFinite()) return SelfCheck::kGyroStuck;
  if (is_near(size, degrees(1.0), kGyroError)) return SelfCheck::kGyroInDegrees;
  if (turning_.misfit > kMisfit * turning_.foot_speed) return SelfCheck::kLegOrder;
  const Mat3 axes = seen / size;
  if (!exchanges_axes(axes)) {
    // Legs that work against each other: what is left of the turn tells which.
    if (is_near(seen(1, 1), 1.0, kGyroError)) return SelfCheck::kLegsLeftRight;
    const bool rigid = turning_.misfit < kSwapMisfit * turning_.foot_speed;
    if (rigid && is_near(seen(0, 0), 1.0, kGyroError) && is_near(-seen(1, 1), 1.0, kGyroError)) {
      return SelfCheck::kLegsFrontRear;
    }
    return SelfCheck::kLegOrder;
  }
  const Vec3 same = axes.diagonal();
  if (same.cwiseAbs().minCoeff() < 0.5) return SelfCheck::kGyroAxes;
  const bool roll = same.x() > 0.0, pitch = same.y() > 0.0, yaw = same.z() > 0.0;
  if (roll && pitch && yaw)
    return is_near(size, 1.0, kGyroError) ? SelfCheck::kRunning : SelfCheck::kGyroSize;
  if (!roll && !pitch && !yaw) return SelfCheck::kGyroOpposite;
  if (!roll && pitch && !yaw) return SelfCheck::kLegsLeftRight;
  if (roll && !pitch && !yaw) return SelfCheck::kLegsFrontRear;
  if (!roll && !pitch && yaw) return SelfCheck::kLegsDiagonal;
  return SelfCheck::kGyroAxes;
}

}  // namespace pirouette
