// Faults in the closed loop: what docs/faults.md says the robot does, it does.
#include <gtest/gtest.h>

#include <cmath>

#include "pirouette/base/random.hpp"
#include "pirouette/controller/command_guard.hpp"
#include "pirouette/plant/simulated_world.hpp"
#include "support/closed_loop.hpp"
#include "support/trial.hpp"

namespace pirouette {
namespace {

using test::ClosedLoop;

constexpr double kFaultStart = 7.0;  ///< s

struct Endured {
  const char* name;
  std::vector<std::string> overrides;
  double largest_mm;      ///< CoM to the commanded point
  double yaw_rate_error;  ///< share
};

class EnduredFault : public testing::TestWithParam<Endured> {};

TEST_P(EnduredFault, TheRobotKeepsSpinningNearThePoint) {
  std::vector<std::string> overrides = GetParam().overrides;
  overrides.insert(overrides.end(), {"plant.faults.start=7", "run.turns=3"});
  const Metrics m = test::spin(overrides);
  EXPECT_FALSE(m.fell);
  EXPECT_GE(m.turns_done, 2.9);
  EXPECT_LE(m.com.distance_to_point_max_mm.value_or(1e9), GetParam().largest_mm);
  EXPECT_LE(std::abs(m.yaw_rate_error.value_or(1.0)), GetParam().yaw_rate_error);
}

const std::string kFault = "plant.faults.";

INSTANTIATE_TEST_SUITE_P(
    Faults, EnduredFault,
    testing::Values(
        Endured{"Latency2ms", {"plant.command_latency=0.002"}, 4.0, 1e-3},
        Endured{"Latency4ms", {"plant.command_latency=0.004"}, 4.0, 1e-3},
        Endured{"Latency8ms", {"plant.command_latency=0.008"}, 4.0, 1e-3},
        Endured{"LostCommands", {kFault + "command_loss=0.2"}, 4.0, 1e-3},
        Endured{"Payload", {"plant.payload=2.0"}, 8.0, 1e-3},
        Endured{"WeakTorqueConstants", {"plant.torque_scale=0.9"}, 4.0, 1e-3},
        Endured{"StrongTorqueConstants", {"plant.torque_scale=1.1"}, 4.0, 1e-3},
        Endured{"HeavyTrunk", {"plant.trunk_mass_scale=1.2"}, 4.0, 1e-3},
        Endured{"ShiftedTrunk", {"plant.trunk_com_offset=[0.02, 0.02, 0.0]"}, 40.0, 1e-3},
        Endured{"WeakKnee", {kFault + "motor_strength=0.5"}, 60.0, 2e-3},
        Endured{"WeakHip", {kFault + "motor_strength=0.5", kFault + "joint='hip'"}, 5.0, 1e-3},
        Endured{"WeakAbad", {kFault + "motor_strength=0.5", kFault + "joint='abad'"}, 15.0, 1e-3},
        Endured{"LowTorqueLimit", {kFault + "torque_limit_scale=0.3"}, 4.0, 1e-3},
        Endured{"FlagStuckOn", {kFault + "contact='stuck_on'"}, 10.0, 1e-3},
        Endured{"FlagStuckOff", {kFault + "contact='stuck_off'"}, 5.0, 1e-3},
        // The heading is the gyro's integral: 0.01 of 0.7 rad/s.
        Endured{"GyroBias", {kFault + "gyro_bias=0.01"}, 30.0, 0.02},
        Endured{"AccelerometerBias", {kFault + "accelerometer_bias=0.1"}, 6.0, 1e-3},
        Endured{"ImuSpikes", {kFault + "imu='spikes'"}, 6.0, 2e-3},
        Endured{"ImuSilentFor80ms", {kFault + "imu='stuck'", kFault + "duration=0.08"}, 10.0, 2e-3},
        Endured{"ImuNoNumberFor20ms", {kFault + "imu='nan'", kFault + "duration=0.02"}, 5.0, 2e-3},
        Endured{"EncoderNoNumberFor20ms",
                {kFault + "encoder='nan'", kFault + "duration=0.02"},
                5.0,
                2e-3},
        Endured{"KneeEncoderStuck", {kFault + "encoder='stuck'"}, 60.0, 2e-3},
        Endured{
            "HipEncoderStuck", {kFault + "encoder='stuck'", kFault + "joint='hip'"}, 60.0, 2e-3},
        Endured{
            "AbadEncoderStuck", {kFault + "encoder='stuck'", kFault + "joint='abad'"}, 60.0, 2e-3}),
    [](const auto& of) { return of.param.name; });

/// Spins with `faults` until the controller stands down, and for two seconds after.
void expect_stand_down(const FaultConfig& faults, ControllerStatus expected, double within) {
  Config config = test::spin_config({});
  config.plant.faults = faults;
  config.plant.faults.start = kFaultStart;
  ClosedLoop loop(config);
  loop.run(1.0, test::stand_still());
  while (!is_stood_down(loop.controller.status()) && loop.plant.truth().time < 20.0)
    ASSERT_TRUE(test::is_finite(loop.tick(test::spin(0.7))));
  EXPECT_EQ(loop.controller.status(), expected);
  EXPECT_GE(loop.plant.truth().time, kFaultStart);
  EXPECT_LE(loop.plant.truth().time, kFaultStart + within);
  // Upright when it gives up, and lying still after.
  EXPECT_GT(loop.plant.truth().base.R_WB(2, 2), std::cos(0.2));
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(test::equal(loop.tick(test::spin(0.7)), damped_stand_down(config.joint.kd_stand)));
  }
  EXPECT_EQ(loop.controller.status(), expected);
  EXPECT_TRUE(loop.plant.truth().p_WG.allFinite());
  EXPECT_LT(loop.plant.truth().v_WG_W.norm(), 0.1);
}

TEST(DeadSensor, AnImuThatRepeatsItselfEndsInTheStandDown) {
  FaultConfig faults;
  faults.imu = ImuFault::kStuck;
  expect_stand_down(faults, ControllerStatus::kBadInput, 0.11);
}

TEST(DeadSensor, AnImuThatIsNoNumberEndsInTheStandDown) {
  FaultConfig faults;
  faults.imu = ImuFault::kNan;
  expect_stand_down(faults, ControllerStatus::kBadInput, 0.03);
}

TEST(DeadSensor, AnEncoderThatIsNoNumberEndsInTheStandDown) {
  FaultConfig faults;
  faults.encoder = EncoderFault::kNan;
  expect_stand_down(faults, ControllerStatus::kBadInput, 0.03);
}

TEST(DeadMotor, TheFallEndsInTheStandDown) {
  Config config = test::spin_config({});
  config.plant.faults.start = kFaultStart;
  config.plant.faults.motor_strength = 0.0;
  ClosedLoop loop(config);
  loop.run(1.0, test::stand_still());
  while (!is_stood_down(loop.controller.status()) && loop.plant.truth().time < 12.0)
    ASSERT_TRUE(test::is_finite(loop.tick(test::spin(0.7))));
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kFallen);
  loop.run(3.0, test::spin(0.7));
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kFallen);
  EXPECT_TRUE(loop.plant.truth().p_WG.allFinite());
  EXPECT_LT(loop.plant.truth().v_WG_W.norm(), 0.1);
}

/// Misses a fifth of its ticks, in which the last command stands.
class LossyController final : public Controller {
 public:
  explicit LossyController(Controller& controller) : controller_(controller) {}

  void reset(const BasePose& start) override { controller_.reset(start); }
  const JointCommand& tick(const SensorReading& sensors,
                           const MotionCommand& command) noexcept override {
    if (lost_.uniform() > 0.2) last_ = controller_.tick(sensors, command);
    return last_;
  }
  ControllerStatus status() const noexcept override { return controller_.status(); }

 private:
  Controller& controller_;
  RandomStream lost_{1, RandomPurpose::kLostCommands};
  JointCommand last_;
};

TEST(LostTicks, AFifthOfTheTicksMayBeMissed) {
  ClosedLoop loop(test::spin_config({}));
  loop.run(1.0, test::stand_still());
  const Vec2 point = loop.plant.truth().p_WG.head<2>();
  SimulatedWorld world(loop.plant);
  LossyController lossy(loop.controller);
  ControlLoop lossy_loop(world, lossy);
  double farthest = 0.0;
  for (int i = 0; i < 10000; ++i) {
    lossy_loop.tick(test::spin(0.7));
    lossy_loop.send();
    farthest = std::max(farthest, (loop.plant.truth().p_WG.head<2>() - point).norm());
  }
  EXPECT_EQ(loop.controller.status(), ControllerStatus::kWalking);
  EXPECT_LT(farthest, 0.01);
}

}  // namespace
}  // namespace pirouette
