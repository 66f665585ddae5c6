#include "pirouette/controller/motion_planner.hpp"

namespace pirouette {

MotionPlan MotionPlanner::update(const MotionPlannerInput& in, double dt) noexcept {
  MotionPlan out;
  out.aid_offset = aid_offset_.update(in.aid, in.state.p_WB.head<2>(), in.state.time, dt);
  // The set-point lives in the aid's frame, everything else in the odometry's.
  RobotState in_aid_frame = in.state;
  in_aid_frame.p_WG.head<2>() += out.aid_offset;
  out.path = path_reference_.update(in.command, in_aid_frame, dt);
  out.path.p_WG -= out.aid_offset;
  out.twist = tracker_.update(out.path, in.state, dt);
  out.integral_H = tracker_.integral_H();
  return out;
}

void MotionPlanner::reset() noexcept {
  aid_offset_.reset();
  path_reference_.reset();
  tracker_.reset();
}

}  // namespace pirouette
