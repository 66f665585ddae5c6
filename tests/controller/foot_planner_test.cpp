#include "pirouette/controller/foot_planner.hpp"

#include <gtest/gtest.h>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

constexpr double kHeight = 0.29;  // m

/// A robot that spins on the level at the origin, FR in mid-swing.
class Spinning {
 public:
  explicit Spinning(const GaitConfig& gait_config = {}, const FootholdConfig& config = {})
      : memory(TerrainConfig{}, PerLeg<double>::filled(0.0225)) {
    PerLeg<LegGeometry> legs;
    NominalStance stance;
    for (const Leg leg : kLegs) {
      legs[leg] = test::paper_leg(leg);
      const LegGeometry& g = legs[leg];
      stance.q[leg] = inverse_kinematics(g, Vec3(0.0, g.abad_offset, -0.27)).q;
      stance.foothold_H[leg] = g.p_BH.head<2>() + Vec2(0.0, g.abad_offset);
      contacts[leg].in_contact = leg != Leg::kFR;
      state.p_WF[leg] = Vec3(0.1, 0.2, 0.3);
      p_WF_liftoff[leg] = Vec3(0.2, -0.1, 0.0225);
    }
    planner.emplace(config, gait_config, kHeight, rolling_feet(FootModel::kRolling, legs), legs,
                    stance);
    gait.walking = true;
    gait.stance_duration = 0.3;
    gait.swing_duration = 0.2;
    gait.leg[Leg::kFR] = {
        .stance = false, .progress = 0.5, .duration = 0.2, .time_remaining = 0.1, .stride = 1};
  }

  FootholdPlan footholds() const {
    return planner->footholds({state, gait, recovering, twist, plane, ground}, memory);
  }
  PerLeg<SwingTarget> swing_targets() const {
    return planner->swing_targets({state, gait, contacts, p_WF_liftoff, footholds(), ground});
  }

  std::optional<FootPlanner> planner;
  GroundSense memory;
  RobotState state;
  GaitPhase gait;
  bool recovering = false;
  TwistCommand twist;
  TerrainPlane plane;
  GroundEstimate ground;
  FootContacts contacts;
  PerLeg<Vec3> p_WF_liftoff;
};

TEST(FootPlanner, PlansTheNominalStanceOfARobotThatTrotsOnTheSpot) {
  const Spinning robot;
  const LegGeometry leg = test::paper_leg(Leg::kFR);
  const Foothold foothold = robot.footholds()[Leg::kFR];
  EXPECT_LT(
      distance(foothold.p_WC.head<2>(), Vec2(leg.p_BH.head<2>() + Vec2(0.0, leg.abad_offset))),
      1e-12);
  EXPECT_LT(distance(foothold.p_WF, foothold.p_WC + 0.0225 * Vec3::UnitZ()), 1e-15);
}

TEST(FootPlanner, AfterAPushTheFeetGoToTheCapturePoint) {
  FootholdConfig config;
  config.velocity_gain = 0.0;
  Spinning robot({}, config);
  robot.state.v_WG_W.x() = 0.1;
  const double half_stance = 0.5 * robot.gait.stance_duration;
  const double calm = robot.footholds()[Leg::kFR].p_WC.x();
  robot.recovering = true;
  const double recovering = robot.footholds()[Leg::kFR].p_WC.x();
  EXPECT_NEAR(recovering - calm, 0.1 * (std::sqrt(kHeight / kGravity) - half_stance), 1e-12);
}

TEST(FootPlanner, AFootInContactIsToStayAndRoll) {
  Spinning robot;
  robot.contacts[Leg::kRL].v_WF_rolling_W = Vec3(0.01, -0.02, 0.0);
  const SwingTarget target = robot.swing_targets()[Leg::kRL];
  EXPECT_EQ(target.p_WF, robot.state.p_WF[Leg::kRL]);
  EXPECT_EQ(target.v_WF_W, robot.contacts[Leg::kRL].v_WF_rolling_W);
  EXPECT_EQ(target.a_WF_W, Vec3::Zero());
}

TEST(FootPlanner, ASwingClearsTheStepsThatAreKnownUpToItsLimit) {
  const GaitConfig config;
  const auto apex = [&](bool stepped, double step_height) {
    Spinning robot(config);
    robot.ground = {.known = true, .stepped = stepped, .residual = 0.0, .step_height = step_height};
    const Vec3 landing = robot.footholds()[Leg::kFR].p_WF;
    return robot.swing_targets()[Leg::kFR].p_WF.z() -
           std::max(robot.p_WF_liftoff[Leg::kFR].z(), landing.z());
  };
  EXPECT_NEAR(apex(false, 0.1), config.swing_height, 1e-12);
  const double step = config.max_swing_height - config.step_clearance - 0.01;
  EXPECT_NEAR(apex(true, step), step + config.step_clearance, 1e-12);
  EXPECT_NEAR(apex(true, 1.0), config.max_swing_height, 1e-12);
}

}  // namespace
}  // namespace pirouette
