#include "pirouette/controller/command_guard.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/closed_loop.hpp"

namespace pirouette {
namespace {

using test::equal;
using test::kTick;

const Vec3 kTorqueLimit(18.0, 18.0, 28.0);

class Guard : public testing::Test {
 protected:
  Guard() {
    for (LegGeometry& leg : legs_) {
      leg.tau_max = kTorqueLimit;
      leg.q_min = Vec3(-1.5, -3.0, -2.7);
      leg.q_max = Vec3(1.5, 3.0, 0.0);
    }
    config_.filter_time = kTick;  // takes half of each step
    config_.max_torque_rate = 1e9;
    config_.max_position_rate = 1e9;
  }

  static JointCommand torque(const Vec3& tau) {
    LegCommand leg;
    leg.tau = tau;
    return JointCommand::filled(leg);
  }

  static JointCommand angle(const Vec3& q) {
    LegCommand leg;
    leg.q = q;
    return JointCommand::filled(leg);
  }

  PerLeg<LegGeometry> legs_{};
  JointConfig config_;
  JointCommand command_;
};

TEST_F(Guard, LowPassesTheTorque) {
  CommandGuard guard(config_, legs_);
  const Vec3 tau(4.0, -3.0, 2.0);
  double share = 0.0;
  for (int i = 0; i < 10; ++i) {
    share += 0.5 * (1.0 - share);
    ASSERT_TRUE(guard.update(torque(tau), kTick, command_));
    EXPECT_LT((command_[Leg::kRL].tau - share * tau).norm(), 1e-14);
  }
}

TEST_F(Guard, LimitsTheTorquesRateAfterTheFilter) {
  config_.max_torque_rate = 1.0 / kTick;  // 1 N m a tick
  CommandGuard guard(config_, legs_);
  ASSERT_TRUE(guard.update(torque(Vec3(10.0, -10.0, 0.5)), kTick, command_));
  // The filter gives 5, -5 and 0.25; limited before it, the first two would be 0.5.
  EXPECT_EQ(command_[Leg::kFR].tau, Vec3(1.0, -1.0, 0.25));
  ASSERT_TRUE(guard.update(torque(Vec3(10.0, -10.0, 0.5)), kTick, command_));
  EXPECT_EQ(command_[Leg::kFR].tau, Vec3(2.0, -2.0, 0.375));
}

TEST_F(Guard, KeepsTorquesWithinTheMotors) {
  CommandGuard guard(config_, legs_);
  for (const double sign : {1.0, -1.0}) {
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(guard.update(torque(Vec3::Constant(sign * 100.0)), kTick, command_));
      for (const LegCommand& leg : command_) {
        EXPECT_TRUE((leg.tau.cwiseAbs().array() <= kTorqueLimit.array()).all());
      }
    }
    EXPECT_EQ(command_[Leg::kFL].tau, sign * kTorqueLimit);
  }
}

TEST_F(Guard, KeepsAnglesWithinTheJoints) {
  CommandGuard guard(config_, legs_);
  ASSERT_TRUE(guard.update(angle(Vec3(2.0, 4.0, 1.0)), kTick, command_));
  EXPECT_EQ(command_[Leg::kRR].q, Vec3(1.5, 3.0, 0.0));
  ASSERT_TRUE(guard.update(angle(Vec3(-2.0, -4.0, -3.0)), kTick, command_));
  EXPECT_EQ(command_[Leg::kRR].q, Vec3(-1.5, -3.0, -2.7));
  ASSERT_TRUE(guard.update(angle(Vec3(0.3, 0.8, -1.6)), kTick, command_));
  EXPECT_EQ(command_[Leg::kRR].q, Vec3(0.3, 0.8, -1.6));
}

TEST_F(Guard, MovesAnglesFromTheMeasuredOnesAtALimitedRate) {
  config_.max_position_rate = 0.1 / kTick;  // 0.1 rad a tick
  CommandGuard guard(config_, legs_);
  const Vec3 measured(0.0, 0.8, -1.6);
  guard.reset(PerLeg<Vec3>::filled(measured));
  ASSERT_TRUE(guard.update(angle(Vec3(0.05, 1.8, -2.6)), kTick, command_));
  EXPECT_LT((command_[Leg::kFR].q - Vec3(0.05, 0.9, -1.7)).norm(), 1e-15);
}

TEST_F(Guard, RejectsEveryValueThatIsNotFiniteAndKeepsTheLastCommand) {
  CommandGuard guard(config_, legs_);
  ASSERT_TRUE(guard.update(torque(Vec3(2.0, 2.0, 2.0)), kTick, command_));
  const JointCommand last = command_;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (Vec3 LegCommand::*field :
         {&LegCommand::q, &LegCommand::dq, &LegCommand::kp, &LegCommand::kd, &LegCommand::tau}) {
      JointCommand raw = torque(Vec3(9.0, 9.0, 9.0));
      (raw[Leg::kRL].*field)[1] = bad;
      EXPECT_FALSE(guard.update(raw, kTick, command_));
      EXPECT_TRUE(equal(command_, last));
    }
  }
  // Nor did any of it enter the filter.
  ASSERT_TRUE(guard.update(torque(Vec3(2.0, 2.0, 2.0)), kTick, command_));
  EXPECT_EQ(command_[Leg::kRL].tau, Vec3(1.5, 1.5, 1.5));
}

TEST_F(Guard, PassesGainsAndVelocitiesUnchanged) {
  CommandGuard guard(config_, legs_);
  LegCommand leg;
  leg.dq = {1.0, -2.0, 3.0};
  leg.kp = {10.0, 20.0, 30.0};
  leg.kd = {1.0, 2.0, 3.0};
  ASSERT_TRUE(guard.update(JointCommand::filled(leg), kTick, command_));
  EXPECT_EQ(command_[Leg::kFL].dq, leg.dq);
  EXPECT_EQ(command_[Leg::kFL].kp, leg.kp);
  EXPECT_EQ(command_[Leg::kFL].kd, leg.kd);
}

TEST(DampedStandDown, IsJointDampingAlone) {
  for (const LegCommand& leg : damped_stand_down(2.5)) {
    EXPECT_EQ(leg.kd, Vec3::Constant(2.5));
    for (const Vec3& other : {leg.q, leg.dq, leg.kp, leg.tau}) EXPECT_EQ(other, Vec3::Zero());
  }
}

}  // namespace
}  // namespace pirouette
