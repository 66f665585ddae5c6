// What must not matter: where the robot faces, the order of its legs in the file, left or right,
// the length of the physics step.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "support/closed_loop.hpp"
#include "support/robot_text.hpp"
#include "support/temp_folder.hpp"
#include "support/trial.hpp"

namespace pirouette {
namespace {

constexpr double kRate = 0.7;  // rad/s

struct Path {
  std::vector<Vec3> p_WG;   ///< m, true CoM, every tick
  std::vector<double> yaw;  ///< rad, true
};

/// Three seconds of the closed loop with perfect sensors: standing, then spinning.
Path spin_for_three_seconds(const std::string& mjcf, const Vec2& xy, double yaw) {
  const Config config = test::ideal_config();
  Plant plant = test::create_plant(config, mjcf, xy, yaw).value();
  SpinController controller = SpinController::create(config, mjcf).value();
  controller.reset({plant.truth().base.p_WB, plant.truth().base.R_WB});
  Path path;
  for (int i = 0; i < static_cast<int>(3.0 / test::kTick); ++i) {
    plant.advance(controller.tick(plant.sense(), test::spin(kRate)));
    path.p_WG.push_back(plant.truth().p_WG);
    path.yaw.push_back(rpy_from_rotation(plant.truth().base.R_WB).yaw);
  }
  return path;
}

// Rounding, as contacts that open and close magnify it within three seconds; a dependence on the
// heading or on the order would show as millimetres.
constexpr double kRounding = 1e-5;  // m, rad

TEST(Spin, IsTheSameWhereverTheRobotStandsAndFaces) {
  const Vec2 xy(3.0, -2.0);
  const double yaw = 2.2;
  const Path here = spin_for_three_seconds(test::kRobot, Vec2::Zero(), 0.0);
  const Path there = spin_for_three_seconds(test::kRobot, xy, yaw);
  for (std::size_t i = 0; i < here.yaw.size(); ++i) {
    Vec3 moved = here.p_WG[i];
    moved.head<2>() = xy + rot2(yaw) * here.p_WG[i].head<2>();
    ASSERT_LT((moved - there.p_WG[i]).norm(), kRounding) << "tick " << i;
    ASSERT_LT(std::abs(wrap_angle(here.yaw[i] + yaw - there.yaw[i])), kRounding) << "tick " << i;
  }
}

class SpinOfAnotherFile : public test::TempFolderTest {};

TEST_F(SpinOfAnotherFile, DoesNotDependOnTheOrderOfTheLegs) {
  const std::string reversed =
      test::write(folder_ / "reversed.xml", test::with_legs_reversed(test::text_of_robot()));
  const Path one = spin_for_three_seconds(test::kRobot, Vec2::Zero(), 0.0);
  const Path other = spin_for_three_seconds(reversed, Vec2::Zero(), 0.0);
  for (std::size_t i = 0; i < one.yaw.size(); ++i) {
    ASSERT_LT((one.p_WG[i] - other.p_WG[i]).norm(), kRounding) << "tick " << i;
    ASSERT_LT(std::abs(one.yaw[i] - other.yaw[i]), kRounding) << "tick " << i;
  }
}

/// Without noise, two turns.
Metrics clean_spin(std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), {"plant.sensors.ideal=true", "run.turns=2"});
  return test::spin(overrides);
}

double value(const Number& number) { return number.value_or(1e9); }

TEST(Spin, ToTheRightMirrorsTheSpinToTheLeft) {
  const Metrics left = clean_spin({"run.rate=0.7"}), right = clean_spin({"run.rate=-0.7"});
  // The trot begins with the same two legs either way, so only the steady spin is mirrored.
  constexpr double kMillimetre = 0.1, kRadian = 1e-4;
  EXPECT_NEAR(value(left.com.radius_mean_mm), value(right.com.radius_mean_mm), kMillimetre);
  EXPECT_NEAR(value(left.yaw_rate_mean), -value(right.yaw_rate_mean), 1e-4);
  EXPECT_NEAR(value(left.attitude.roll_mean), -value(right.attitude.roll_mean), kRadian);
  EXPECT_NEAR(value(left.attitude.pitch_mean), value(right.attitude.pitch_mean), kRadian);
}

TEST(Spin, DoesNotDependOnThePhysicsStep) {
  const Metrics coarse = clean_spin({"plant.timestep=0.001"});
  for (const char* finer : {"plant.timestep=0.0005", "plant.timestep=0.00025"}) {
    const Metrics fine = clean_spin({finer});
    EXPECT_FALSE(fine.fell) << finer;
    EXPECT_NEAR(value(fine.com.radius_mean_mm), value(coarse.com.radius_mean_mm), 0.3) << finer;
    EXPECT_NEAR(value(fine.yaw_rate_mean), value(coarse.yaw_rate_mean), 5e-4) << finer;
  }
}

}  // namespace
}  // namespace pirouette
