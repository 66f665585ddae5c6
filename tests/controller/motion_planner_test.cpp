#include "pirouette/controller/motion_planner.hpp"

#include <gtest/gtest.h>

#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;

// The odometry believes that the robot stands at the commanded point; the aid sees it elsewhere.
TEST(MotionPlanner, TheReferenceIsWhereTheAidSeesThePoint) {
  constexpr double kTick = 0.002;  // s
  const Vec2 drift(0.03, -0.02);   // m, of the odometry: what it adds to the truth
  PathConfig path;
  AidConfig aid_config;
  aid_config.enabled = true;
  MotionPlanner planner(path, aid_config, 1.0 / kTick);
  RobotState state;
  MotionCommand command;
  command.walk = true;
  command.point = Vec2::Zero();
  command.heading = 0.0;
  MotionPlan plan;
  for (int i = 0; i < 20000; ++i) {
    state.time = i * kTick;
    std::optional<PositionAid> aid;
    if (i % 50 == 0) aid = PositionAid{Vec3(-drift.x(), -drift.y(), 0.3), 0.0, state.time};
    plan = planner.update({command, state, aid}, kTick);
  }
  EXPECT_LT(distance(plan.aid_offset, (-drift).eval()), 1e-3);
  // In the odometry's frame the point lies where the drift has carried it.
  EXPECT_LT(distance(plan.path.p_WG, drift), 1e-3);
  EXPECT_GT(plan.twist.v_H.dot(drift), 0.0);  // and there the robot goes
}

}  // namespace
}  // namespace pirouette
