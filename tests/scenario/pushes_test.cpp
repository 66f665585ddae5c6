// Pushes in eight directions during a spin on the flat: Kalman filter, sensor noise and biases on.
#include <gtest/gtest.h>

#include <cmath>

#include "support/closed_loop.hpp"
#include "support/trial.hpp"

namespace pirouette {
namespace {

/// Four pushes, 2.9 s apart so that they meet four moments of the stride.
Metrics pushed(double speed, int direction_deg) {
  return test::spin({"plant.faults.push_speed=" + std::to_string(speed),
                     "plant.faults.push_direction_deg=" + std::to_string(direction_deg),
                     "plant.faults.start=7", "plant.faults.push_period=2.9", "run.turns=1.3"});
}

class PushedSpin : public testing::TestWithParam<int> {};

TEST_P(PushedSpin, DeviatesLittleFromThePointAndNeverFalls) {
  for (const auto& [speed, bound_mm] : {std::pair{0.3, 40.0}, {0.5, 80.0}, {0.8, 160.0}}) {
    const Metrics m = pushed(speed, GetParam());
    EXPECT_FALSE(m.fell) << speed;
    EXPECT_LE(m.com.distance_to_point_max_mm.value_or(1e9), bound_mm) << speed;
  }
  EXPECT_FALSE(pushed(1.0, GetParam()).fell);
}

TEST_P(PushedSpin, EndsInTheStandDownWhenThePushIsTooHard) {
  const Metrics m = pushed(4.0, GetParam());
  ASSERT_TRUE(m.fell);
  ASSERT_TRUE(m.stand_down_delay_s);
  EXPECT_LE(*m.stand_down_delay_s, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Directions, PushedSpin,
                         testing::Values(0, 45, 90, 135, 180, 225, 270, 315),
                         [](const auto& of) { return std::to_string(of.param) + "Degrees"; });

TEST(SpinAfterAPush, ComesBackToItsPointAndItsStride) {
  Config config = test::spin_config({});
  config.plant.faults.start = 5.0;
  config.plant.faults.push_speed = 0.5;
  config.plant.faults.push_direction_deg = 90.0;
  test::ClosedLoop loop(config);
  loop.run(1.0, test::stand_still());
  const Vec2 point = loop.plant.truth().p_WG.head<2>();
  const auto stride = [&] {
    const GaitPhase& gait = loop.controller.trace().gait;
    return gait.stance_duration + gait.swing_duration;
  };
  loop.run(3.9, test::spin(0.7));
  EXPECT_DOUBLE_EQ(stride(), config.gait.period);
  loop.run(0.2, test::spin(0.7));
  EXPECT_DOUBLE_EQ(stride(), config.gait.recovery_period);
  loop.run(6.0, test::spin(0.7));
  EXPECT_DOUBLE_EQ(stride(), config.gait.period);
  // What remains is what the odometry lost while the feet slipped.
  EXPECT_LE((loop.plant.truth().p_WG.head<2>() - point).norm(), 0.015);
}

}  // namespace
}  // namespace pirouette
