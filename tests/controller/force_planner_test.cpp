#include "pirouette/controller/force_planner.hpp"

#include <gtest/gtest.h>

#include "pirouette/controller/body_horizon.hpp"

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

/// A trot that turns by 2 rad/s on a slope, 0.1 s after its start.
class Trotting : public Standing {
 public:
  Trotting() : Standing(MpcConfig{}) {
    for (int i = 0; i < 50; ++i) gait = clock.update(true, kTick);
    plane.a1 = 0.2;
    reference.twist = {Vec2(0.4, 0.1), 2.0};
    reference.v_WG_W = Vec3(0.4, 0.1, 0.08);
    reference.rpy.yaw = 0.3;
    state.p_WG += Vec3(0.02, -0.03, 0.01);  // off the reference
    for (const Leg leg : kLegs) {
      contacts[leg].in_contact = gait.leg[leg].stance;
      contacts[leg].n_W = plane.normal();
      footholds[leg].p_WC = contacts[leg].p_WC + Vec3(0.05, 0.02, 0.01);
    }
  }
  MpcInput input() const {
    return planner.mpc_input({state, gait, clock, contacts, plane, footholds, reference});
  }
};

TEST(ForcePlanner, AStepIsToEndAtTheReferenceAndTurnsAboutItInItsMiddle) {
  const Trotting robot;
  const MpcInput in = robot.input();
  EXPECT_NEAR(in.dt, MpcConfig{}.step_share * GaitConfig{}.period, 1e-15);
  for (int k = 0; k < MpcConfig{}.horizon; ++k) {
    const MpcStep& step = in.steps[static_cast<std::size_t>(k)];
    const BodyMotion end = reference_after(robot.reference, robot.plane, kHeight, (k + 1) * in.dt);
    const BodyMotion middle =
        reference_after(robot.reference, robot.plane, kHeight, (k + 0.5) * in.dt);
    EXPECT_EQ(step.reference.p_WG, end.p_WG) << k;
    EXPECT_EQ(step.reference.v_WG_W, end.v_WG_W) << k;
    EXPECT_EQ(step.reference.rpy, end.rpy) << k;
    EXPECT_EQ(step.p_WG_mid, middle.p_WG) << k;  // not the measured CoM
    EXPECT_EQ(step.rpy_mid.yaw, middle.rpy.z()) << k;
  }
  EXPECT_EQ(in.now.p_WG, robot.state.p_WG);
}

TEST(ForcePlanner, FeetStandAsTheGaitSaysInTheMiddleOfAStep) {
  const Trotting robot;
  const MpcInput in = robot.input();
  int changes_within_first_half = 0;
  for (int k = 1; k < MpcConfig{}.horizon; ++k) {
    for (const Leg leg : kLegs) {
      const bool in_middle = robot.clock.phase_at(leg, (k + 0.5) * in.dt).stance;
      EXPECT_EQ(in.steps[static_cast<std::size_t>(k)].stance[leg], in_middle) << k;
      if (robot.clock.phase_at(leg, k * in.dt).stance != in_middle) ++changes_within_first_half;
    }
  }
  EXPECT_GT(changes_within_first_half, 0);  // else the test could not tell middle from start
}

TEST(ForcePlanner, ForcesActWhereAFootStandsUntilItLiftsAndThenWhereItWillStand) {
  const Trotting robot;
  const MpcInput in = robot.input();
  for (int k = 0; k < MpcConfig{}.horizon; ++k) {
    const MpcStep& step = in.steps[static_cast<std::size_t>(k)];
    for (const Leg leg : kLegs) {
      const LegPhase ahead = robot.clock.phase_at(leg, (k + 0.5) * in.dt);
      const bool still_there =
          robot.contacts[leg].in_contact && ahead.stride == robot.gait.leg[leg].stride;
      EXPECT_EQ(step.p_WC[leg], still_there ? robot.contacts[leg].p_WC : robot.footholds[leg].p_WC);
    }
  }
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
