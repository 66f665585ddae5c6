#include "pirouette/estimation/attitude_filter.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kTick = 0.002;

/// What a perfect accelerometer shows at rest.
Vec3 gravity_B(const Mat3& R_WB) { return kGravity * R_WB.row(2).transpose(); }

/// Sphere centres on the ground below a trunk at `p_WB` (m) and `R_WB`, in trunk axes.
PerLeg<Vec3> feet_B(const Mat3& R_WB, const Vec3& p_WB) {
  PerLeg<Vec3> p_BF;
  for (const Leg leg : kLegs) {
    const Vec3 p_WF(fore_sign(leg) * 0.19, side_sign(leg) * 0.11, leg == Leg::kFR ? 0.03 : 0.0);
    p_BF[leg] = R_WB.transpose() * (p_WF - p_WB);
  }
  return p_BF;
}

const Vec3 kStandingAt(0.005, -0.003, 0.27);

/// Angle between the estimated and the true vertical.
double tilt_error(const Mat3& estimate, const Mat3& truth) {
  return std::acos(std::clamp(estimate.row(2).dot(truth.row(2)), -1.0, 1.0));
}

TEST(AttitudeFilter, KeepsItsAttitudeAtRest) {
  const Mat3 R_WB = rotation_from_rpy({0.2, -0.3, 1.1});
  AttitudeFilter filter{EstimationConfig{}, kTick};
  filter.reset(R_WB);
  Attitude out;
  for (int i = 0; i < 5000; ++i) {
    out = filter.update({Vec3::Zero(), gravity_B(R_WB), Vec3::Zero(), i < 2500}, kTick);
  }
  EXPECT_LT(distance(out.R_WB, R_WB), 1e-11);  // rounding of 5000 products
  EXPECT_LT(out.w_WB_B.norm(), 1e-12);
}

TEST(AttitudeFilter, IntegratesTheGyroExactlyOnSo3) {
  EstimationConfig config;
  config.attitude_time_constant = 1e12;  // gravity has no say
  AttitudeFilter filter{config, kTick};
  const Vec3 w_WB_B(0.4, -0.7, 1.3);
  Attitude out;
  for (int i = 0; i < 500; ++i)
    out = filter.update({w_WB_B, gravity_B(out.R_WB), Vec3::Zero()}, kTick);
  EXPECT_LT(distance(out.R_WB, exp_so3(1.0 * w_WB_B)), 1e-10);
}

TEST(AttitudeFilter, LearnsTheGyroBiasAtRestShrunkTowardsNone) {
  const EstimationConfig config;
  AttitudeFilter filter{config, kTick};
  const Vec3 bias(2e-4, -3e-4, 1e-4);
  const AttitudeInput still{bias, gravity_B(Mat3::Identity()), Vec3::Zero(), true, {}};
  filter.update(still, kTick);
  EXPECT_EQ(filter.gyro_bias(), Vec3::Zero());  // one sample has no slope over time
  for (int n = 2; n <= 1000; ++n) {
    const Attitude out = filter.update(still, kTick);
    const double share = n / (n + config.gyro_rest_time / kTick);
    // The regression's sums of n^4 lose 1e-16 n^2 of its value.
    ASSERT_LT(distance(filter.gyro_bias(), share * bias), 1e-10 * bias.norm());
    ASSERT_LT(distance(out.w_WB_B, (1.0 - share) * bias), 1e-10 * bias.norm());
  }
}

TEST(AttitudeFilter, TiltErrorDecaysWithTheTimeConstant) {
  const EstimationConfig config;
  const Mat3 truth = rotation_from_rpy({0.1, 0.05, 0.4});
  for (const Vec3& axis : {Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.6, -0.8, 0.0)}) {
    AttitudeFilter filter{config, kTick};
    constexpr double kInitial = 1e-3;
    filter.reset(exp_so3(kInitial * axis) * truth);
    const int ticks = static_cast<int>(std::lround(config.attitude_time_constant / kTick));
    Attitude out;
    for (int i = 0; i < ticks; ++i)
      out = filter.update({Vec3::Zero(), gravity_B(truth), Vec3::Zero(), true}, kTick);
    // (1 - dt / T)^(T / dt) against 1 / e: dt / 2T = 2.5e-4; sine against angle: 1e-7.
    EXPECT_NEAR(tilt_error(out.R_WB, truth) / kInitial, std::exp(-1.0), 5e-4);
  }
}

TEST(AttitudeFilter, FindsTheHorizontalGyroBiasWhileWalking) {
  const EstimationConfig config;
  AttitudeFilter filter{config, kTick};
  const Vec3 bias(1e-3, -2e-3, 0.0);
  Attitude out;
  // Ten times the slower of the two time constants.
  const int ticks = static_cast<int>(10.0 * config.gyro_bias_time_constant / kTick);
  for (int i = 0; i < ticks; ++i)
    out = filter.update({bias, gravity_B(Mat3::Identity()), Vec3::Zero()}, kTick);
  EXPECT_LT(distance(filter.gyro_bias(), bias), 1e-6);
  EXPECT_LT(tilt_error(out.R_WB, Mat3::Identity()), 1e-6);
}

TEST(AttitudeFilter, YawIsTheIntegralOfTheGyroBecauseNothingObservesIt) {
  AttitudeFilter filter{EstimationConfig{}, kTick};
  const Vec3 bias(0.0, 0.0, 5e-4);
  Attitude out;
  for (int i = 0; i < 50000; ++i)
    out = filter.update({bias, gravity_B(Mat3::Identity()), Vec3::Zero()}, kTick);
  EXPECT_NEAR(rpy_from_rotation(out.R_WB).yaw, 5e-4 * 50000 * kTick, 1e-9);
  EXPECT_LT(filter.gyro_bias().norm(), 1e-12);
}

TEST(AttitudeFilter, SteadyTurnOffTheAxisGivesNoTiltError) {
  constexpr double kRate = 2.0;  // rad/s
  const Vec3 w_WB_B(0.0, 0.0, kRate);
  const Vec3 p_axis_B(0.008, 0.003, 0.0);  // m, trunk origin from the axis
  const Vec3 a_B = w_WB_B.cross(w_WB_B.cross(p_axis_B));
  const auto tilt_after_turning = [&](bool velocity_known) {
    AttitudeFilter filter{EstimationConfig{}, kTick};
    Mat3 truth = Mat3::Identity();
    Attitude out;
    for (int i = 0; i < 10000; ++i) {
      const Vec3 v_WB_W = velocity_known ? Vec3(truth * w_WB_B.cross(p_axis_B)) : Vec3::Zero();
      out = filter.update({w_WB_B, gravity_B(truth) + a_B, v_WB_W}, kTick);
      truth = truth * exp_so3(kTick * w_WB_B);
    }
    return tilt_error(out.R_WB, truth);
  };
  // The velocity lags the attitude by a tick, 4 mrad: that share of 0.43 mrad.
  EXPECT_LT(tilt_after_turning(true), 5e-6);
  // Otherwise gravity would seem to lean by a / g = 3.5 mrad, fixed to the turning body: an error
  // of a / (g T w) = 0.43 mrad for the filter's time constant T, and the bias estimate adds to it.
  EXPECT_GT(tilt_after_turning(false), 4e-4);
}

TEST(AttitudeFilter, LearnsNothingFromFreeFall) {
  AttitudeFilter filter{EstimationConfig{}, kTick};
  const Mat3 R_WB = rotation_from_rpy({0.1, 0.2, 0.3});
  filter.reset(R_WB);
  Attitude out;
  for (int i = 0; i < 200; ++i) out = filter.update({}, kTick);
  EXPECT_LT(distance(out.R_WB, R_WB), 1e-12);
}

TEST(AttitudeFilter, AccelerationsOfTheGaitThatAverageToZeroLeaveNoTilt) {
  AttitudeFilter filter{EstimationConfig{}, kTick};
  Attitude out;
  double largest = 0.0;
  for (int i = 0; i < 10000; ++i) {
    // 4 Hz, sideways and vertical in step: the mean of the measured direction leans by
    // 2 * 4 / (2 g^2) = 40 mrad, the mean of the measured vector does not.
    const double step = std::cos(2.0 * kPi * 4.0 * i * kTick);
    const Vec3 a_B = step * Vec3(2.0, -2.0, 4.0);
    out = filter.update({Vec3::Zero(), gravity_B(Mat3::Identity()) + a_B, Vec3::Zero()}, kTick);
    largest = std::max(largest, tilt_error(out.R_WB, Mat3::Identity()));
  }
  EXPECT_LT(largest, 5e-3);  // its ripple: 2.8 / g over the time constant and 2 pi 4 Hz, 2.9 mrad
}

TEST(AttitudeFilter, AnImpactTiltsItLittle) {
  const EstimationConfig config;
  AttitudeFilter filter{config, kTick};
  const Vec3 impact(1e4, 0.0, 0.0);
  const Attitude out = filter.update({Vec3::Zero(), impact, Vec3::Zero()}, kTick);
  // Counted as no more than a few g for the one tick.
  EXPECT_LT(tilt_error(out.R_WB, Mat3::Identity()), 5.0 * kTick / config.attitude_time_constant);
}

TEST(TurnOverFeet, IsTheTrunksRotationWhereverItMoves) {
  const PerLeg<Vec3> before = feet_B(Mat3::Identity(), kStandingAt);
  for (const Vec3& turn : {Vec3(1e-3, 0.0, 0.0), Vec3(0.0, -2e-3, 0.0), Vec3(0.0, 0.0, 1e-3),
                           Vec3(-1e-3, 5e-4, 2e-3)}) {
    for (const Vec3& shift : {Vec3(0.0, 0.0, 0.0), Vec3(0.004, -0.002, -0.01)}) {
      const PerLeg<Vec3> now = feet_B(exp_so3(turn), kStandingAt + shift);
      // Second order in the angles: 2e-3 of 2e-3, and of the shift.
      EXPECT_LT(distance(turn_over_feet(before, now), turn), 1e-5);
    }
  }
}

TEST(TurnOverFeet, ANonRotatingTrunkHasNotTurned) {
  const PerLeg<Vec3> before = feet_B(Mat3::Identity(), kStandingAt);
  const PerLeg<Vec3> now = feet_B(Mat3::Identity(), kStandingAt + Vec3(0.01, 0.02, -0.03));
  EXPECT_LT(turn_over_feet(before, now).norm(), 1e-15);
  EXPECT_EQ(turn_over_feet({}, {}), Vec3::Zero());  // no feet reported
}

TEST(TurnOverFeet, OppositeMovesAreOppositeTurnsToFirstOrder) {
  const PerLeg<Vec3> a = feet_B(Mat3::Identity(), kStandingAt);
  const PerLeg<Vec3> b = feet_B(exp_so3(Vec3(1e-4, 2e-4, -1e-4)), kStandingAt);
  EXPECT_LT((turn_over_feet(a, b) + turn_over_feet(b, a)).norm(), 1e-7);
}

/// Stands for a second while the trunk turns towards `sag` (rad, rotation vector) as a leg gives
/// way: fast first, then creeping. Returns the bias that was learnt.
Vec3 bias_after_sagging(const Vec3& sag, const Vec3& bias, bool feet_known) {
  AttitudeFilter filter{EstimationConfig{}, kTick};
  const auto attitude = [&](double t) { return exp_so3(sag * (1.0 - std::exp(-t / 0.4))); };
  for (int i = 1; i <= 500; ++i) {
    const Mat3 R_before = attitude((i - 1) * kTick), R_WB = attitude(i * kTick);
    AttitudeInput in;
    in.w_WB_B = log_so3(R_before.transpose() * R_WB) / kTick + bias;
    in.specific_force_B = gravity_B(R_WB);
    in.at_rest = true;
    if (feet_known) in.p_BF = feet_B(R_WB, kStandingAt - 0.01 * i * kTick * Vec3::UnitZ());
    filter.update(in, kTick);
  }
  return filter.gyro_bias();
}

TEST(AttitudeFilter, ATrunkThatSagsAtRestIsNoGyroBias) {
  const EstimationConfig config;
  const double share = 500.0 / (500.0 + config.gyro_rest_time / kTick);
  const Vec3 sag(2e-3, -1e-3, 1e-3), bias(2e-4, -3e-4, 1e-4);
  // Blind to the feet, the sag itself passes for a bias many times the true one.
  EXPECT_GT((bias_after_sagging(sag, Vec3::Zero(), false)).norm(), 2.0 * bias.norm());
  // The turn over the feet is right to second order: 2 mrad of 2 mrad.
  EXPECT_LT(bias_after_sagging(sag, Vec3::Zero(), true).norm(), 1e-5);
  EXPECT_LT(distance(bias_after_sagging(sag, bias, true), share * bias), 1e-5);
  EXPECT_LT(distance(bias_after_sagging(Vec3::Zero(), bias, true), share * bias), 1e-10);
}

/// A robot whose gyro reads its turn and `bias` (rad/s), both with noise, as does the
/// accelerometer.
class NoisyImu {
 public:
  NoisyImu() { filter.reset(Mat3::Identity()); }

  /// `w_WB_B`: rad/s, of robot and ground together, at rest for the filter unless `walks`.
  void run(double duration, const std::function<Vec3(double)>& w_WB_B, bool walks = false) {
    for (int i = 0; i < static_cast<int>(std::lround(duration / kTick)); ++i) {
      const Vec3 w = w_WB_B(i * kTick);
      R_WB = R_WB * exp_so3(kTick * w);
      AttitudeInput in;
      in.w_WB_B = w + bias + noise(0.005);
      in.specific_force_B = gravity_B(R_WB) + noise(0.05);
      in.at_rest = !walks;
      in.p_BF = feet_B(Mat3::Identity(), kStandingAt);
      out = filter.update(in, kTick);
    }
  }
  void stand(double duration) {
    run(duration, [](double) -> Vec3 { return Vec3::Zero(); });
  }
  double bias_error() const { return distance(filter.gyro_bias(), bias); }

  AttitudeFilter filter{EstimationConfig{}, kTick};
  Mat3 R_WB = Mat3::Identity();
  Vec3 bias = Vec3::Zero();
  Attitude out;

 private:
  Vec3 noise(double deviation) {
    return deviation * Vec3(gaussian_(random_), gaussian_(random_), gaussian_(random_));
  }
  std::mt19937 random_{1};
  std::normal_distribution<double> gaussian_;
};

// rad/s, four deviations of the slope over 500 readings with noise of 5e-3, three axes.
constexpr double kSlopeError = 4.0 * 5e-3 * 0.0849;

TEST(AttitudeFilter, BelievesABiasThatIsManyDeviationsFromThePrior) {
  for (const Vec3& bias : {Vec3(0.0, 0.0, 0.02), Vec3(0.02, -0.02, 0.02), Vec3(0.0, 0.005, 0.0)}) {
    NoisyImu robot;
    robot.bias = bias;
    robot.stand(1.0);
    EXPECT_LT(robot.bias_error(), kSlopeError);
    // The attitude is free of what the bias had turned it by before it was believed: 10 mrad.
    EXPECT_LT(distance(robot.out.R_WB, robot.R_WB), 1.5e-3);
  }
}

TEST(AttitudeFilter, HoldsABiasThatThePriorAllowsToThePrior) {
  const double share = 500.0 / (500.0 + EstimationConfig{}.gyro_rest_time / kTick);
  NoisyImu robot;
  robot.bias = Vec3(0.0, 0.0, 4e-4);
  robot.stand(1.0);
  EXPECT_LT(distance(robot.filter.gyro_bias(), share * robot.bias), share * kSlopeError);
}

TEST(AttitudeFilter, ARobotThatIsTurnedIsNotAtRest) {
  const auto swung = [](double t) -> Vec3 { return Vec3(0.0, 0.0, 0.1 * std::sin(6.0 * t)); };
  const auto turned = [](double) -> Vec3 { return Vec3(0.0, 0.0, 0.2); };
  const auto tilted = [](double) -> Vec3 { return Vec3(0.05, 0.0, 0.0); };
  for (const auto& turn : std::vector<std::function<Vec3(double)>>{swung, turned, tilted}) {
    NoisyImu robot;
    robot.run(1.0, turn);
    EXPECT_EQ(robot.filter.gyro_bias(), Vec3::Zero());
    // Put down: the bias can still be learnt.
    robot.bias = Vec3(0.0, 0.0, 0.02);
    robot.stand(2.0);
    EXPECT_LT(robot.bias_error(), kSlopeError);
  }
}

TEST(AttitudeFilter, ALaterRestDoesNotOverruleTheBiasOfTheFirst) {
  NoisyImu robot;
  robot.stand(1.0);
  robot.run(0.1, [](double) -> Vec3 { return Vec3::Zero(); }, true);
  robot.run(0.6, [](double) -> Vec3 { return Vec3(0.0, 0.0, 0.05); });  // on a turntable
  const double share = 300.0 / (300.0 + EstimationConfig{}.gyro_rest_time / kTick);
  EXPECT_NEAR(robot.filter.gyro_bias().z(), share * 0.05, kSlopeError);
}

TEST(AttitudeFilter, ForgetsItsBiasOnReset) {
  AttitudeFilter filter{EstimationConfig{}, kTick};
  for (int i = 0; i < 2; ++i) {
    filter.update({Vec3(0.01, 0.0, 0.0), gravity_B(Mat3::Identity()), Vec3::Zero(), true}, kTick);
  }
  EXPECT_GT(filter.gyro_bias().norm(), 0.0);
  filter.reset(Mat3::Identity());
  EXPECT_EQ(filter.gyro_bias(), Vec3::Zero());
}

}  // namespace
}  // namespace pirouette
