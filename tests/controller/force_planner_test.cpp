#include "pirouette/controller/force_planner.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

constexpr double kTick = 0.002;                // s
constexpr double kMass = 9.0, kHeight = 0.29;  // kg, m

/// A robot that stands, and is meant to.
class Standing {
 public:
  explicit Standing(const MpcConfig& config, double tick = kTick)
      : clock(GaitConfig{}),
        planner(config, tick, 0.5, kHeight, kMass, Vec3(0.05, 0.2, 0.25).asDiagonal()) {
    state.p_WG.z() = kHeight;
    reference.p_WG.z() = kHeight;
    gait = clock.update(false, tick);
    for (const Leg leg : kLegs) {
      contacts[leg].in_contact = true;
      contacts[leg].p_WC = Vec3(0.19 * fore_sign(leg), 0.11 * side_sign(leg), 0.0);
      footholds[leg].p_WC = contacts[leg].p_WC;
    }
  }

  ContactForces update() {
    return planner.update({state, gait, clock, contacts, plane, footholds, reference});
  }
  bool solved() const { return planner.solve_us() > 0.0; }

  GaitClock clock;
  ForcePlanner planner;
  RobotState state;
  GaitPhase gait;
  FootContacts contacts;
  TerrainPlane plane;
  FootholdPlan footholds;
  BodyReference reference;
};

double vertical(const ContactForces& forces) {
  double sum = 0.0;
  for (const Vec3& f_W : forces.f_W) sum += f_W.z();
  return sum;
}

TEST(ForcePlanner, CarriesAStandingRobot) {
  Standing robot{MpcConfig{}};
  // The cost of force leaves a little of the weight to the position error.
  EXPECT_NEAR(vertical(robot.update()), kMass * kGravity, 0.05 * kMass * kGravity);
}

TEST(ForcePlanner, SolvesEveryFewTicksAndWhenTheContactsChange) {
  MpcConfig config;
  config.solve_period = 3 * kTick;
  Standing robot(config);
  for (int i = 0; i < 9; ++i) {
    robot.update();
    EXPECT_EQ(robot.solved(), i % 3 == 0) << i;
  }
  robot.update();
  robot.contacts[Leg::kFL].in_contact = false;
  EXPECT_EQ(robot.update().f_W[Leg::kFL], Vec3::Zero());
  EXPECT_TRUE(robot.solved());
}

TEST(ForcePlanner, SolvesAsOftenAtAnyRateAndAtLeastEveryTick) {
  const auto solutions = [](const MpcConfig& config, double rate) {
    Standing robot(config, 1.0 / rate);
    int count = 0;
    for (int i = 0; i < static_cast<int>(rate); ++i) {
      robot.update();
      count += robot.solved() ? 1 : 0;
    }
    return count;
  };
  MpcConfig config;
  config.solve_period = 0.02;
  for (const double rate : {100.0, 200.0, 500.0, 1000.0}) EXPECT_EQ(solutions(config, rate), 50);
  config.solve_period = 0.004;
  EXPECT_EQ(solutions(config, 100.0), 100);
}

TEST(ForcePlanner, HoldsTheLastGoodForcesAndCountsFailures) {
  MpcConfig config;
  config.solve_period = kTick;
  Standing robot(config);
  const ContactForces good = robot.update();
  robot.state.p_WG.x() = std::numeric_limits<double>::quiet_NaN();
  for (int i = 1; i <= 3; ++i) {
    const ContactForces held = robot.update();
    EXPECT_EQ(held.status, SolveStatus::kHeld);
    EXPECT_EQ(held.f_W.values, good.f_W.values);
    EXPECT_EQ(robot.planner.failures(), i);
  }
  robot.state.p_WG.x() = 0.0;
  EXPECT_NE(robot.update().status, SolveStatus::kHeld);
  EXPECT_EQ(robot.planner.failures(), 0);
}

}  // namespace
}  // namespace pirouette
