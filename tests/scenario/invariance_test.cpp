// What must not matter: where the robot faces, the order of its legs in the file, left or right,
// the length of the physics step.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
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
  test::ClosedLoop loop(test::create_plant(config, mjcf, xy, yaw).value(),
                        SpinController::create(config, mjcf).value());
  Path path;
  for (int i = 0; i < static_cast<int>(3.0 / test::kTick); ++i) {
    loop.tick(test::spin(kRate));
    path.p_WG.push_back(loop.plant.truth().p_WG);
    path.yaw.push_back(rpy_from_rotation(loop.plant.truth().base.R_WB).yaw);
  }
  return path;
}

// Rounding only: a physics step rounds some hundred times in a row, numbers of up to 4 m or rad,
// and what a step leaves does not grow, for the closed loop draws the paths together. Measured:
// 1e-13.
constexpr double kSteps = 3.0 / 0.001, kRoundingsInARow = 100.0, kSize = 4.0;
constexpr double kRounding =
    kSteps * kRoundingsInARow * kSize * std::numeric_limits<double>::epsilon();  // m, rad; 3e-10

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

double value(const Number& number) { return number.value_or(1e9); }

// The trot begins with the same two legs either way, so the mirrored robot is half a stride behind.
// A record of whole strides makes that matter no more than half a stride more or less does to a
// mean: by its share of what the quantity goes through in a stride. Measured: a tenth of that and
// less.
TEST(Spin, ToTheRightMirrorsTheSpinToTheLeft) {
  constexpr double kStride = 0.5, kRecord = 18.0;  // s
  constexpr double kShare = 0.5 * kStride / kRecord;
  const auto spin_at = [](double rate) {
    const double turns = std::abs(rate) * kRecord / (2.0 * std::numbers::pi);
    // The self-check turns the trunk to the left, whatever comes after it.
    return test::spin({"plant.sensors.ideal=true", "safety.self_check=none",
                       "gait.period=" + std::to_string(kStride), "run.rate=" + std::to_string(rate),
                       "run.turns=" + std::to_string(turns)});
  };
  const Metrics left = spin_at(kRate), right = spin_at(-kRate);
  const AttitudeMetrics &l = left.attitude, &r = right.attitude;
  EXPECT_NEAR(value(left.com.radius_mean_mm), value(right.com.radius_mean_mm),
              kShare * left.com.radius_max_mm.value());
  EXPECT_NEAR(value(l.roll_mean), -value(r.roll_mean), kShare * l.roll_range.value());
  EXPECT_NEAR(value(l.pitch_mean), value(r.pitch_mean), kShare * l.pitch_range.value());
  // The trunk yaws to and fro in a stride by about what it pitches, 3 mrad.
  EXPECT_NEAR(value(left.yaw_rate_mean), -value(right.yaw_rate_mean),
              kShare * l.pitch_range.value() / kStride);
}

struct Sample {
  double mean = 0.0, deviation = 0.0;
};

Sample sample_of(std::span<const double> x) {
  const auto n = static_cast<double>(x.size());
  Sample sample;
  for (const double v : x) sample.mean += v / n;
  for (const double v : x) sample.deviation += (v - sample.mean) * (v - sample.mean) / (n - 1.0);
  sample.deviation = std::sqrt(sample.deviation);
  return sample;
}

// The step decides how late a foot is found on the ground and how old a reading is: an error of
// first order, 0.02 mm of radius per ms. Without noise all landings are alike and the error jumps
// with their instant; with noise it is a mean over seeds: from 1 ms to 0.5 ms -0.007 mm, to 0.25 ms
// -0.010 mm (fifteen seeds, standard error 0.005 mm). It is small if a number hangs on it less than
// on the draw of the noise, whose standard deviation is 0.05 mm there.
TEST(Spin, DependsOnThePhysicsStepLessThanOnTheSeed) {
  constexpr int kSeeds = 5;
  struct Numbers {
    std::vector<double> radius_mm, yaw_rate;
  };
  const auto spins_at = [](const std::string& step) {
    Numbers numbers;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const Metrics spin =
          test::spin({"plant.timestep=" + step, "run.turns=1", "run.seed=" + std::to_string(seed)});
      EXPECT_FALSE(spin.fell) << step;
      numbers.radius_mm.push_back(value(spin.com.radius_mean_mm));
      numbers.yaw_rate.push_back(value(spin.yaw_rate_mean));
    }
    return numbers;
  };
  const auto expect_small_change = [](const std::vector<double>& coarse,
                                      const std::vector<double>& fine, const std::string& what) {
    std::vector<double> change;  // of the same draw
    for (std::size_t i = 0; i < coarse.size(); ++i) change.push_back(fine[i] - coarse[i]);
    EXPECT_LT(std::abs(sample_of(change).mean), sample_of(coarse).deviation) << what;
  };
  const Numbers coarse = spins_at("0.001");
  for (const char* step : {"0.0005", "0.00025"}) {
    const Numbers fine = spins_at(step);
    expect_small_change(coarse.radius_mm, fine.radius_mm, std::string("radius, ") + step);
    expect_small_change(coarse.yaw_rate, fine.yaw_rate, std::string("yaw rate, ") + step);
  }
}

}  // namespace
}  // namespace pirouette
