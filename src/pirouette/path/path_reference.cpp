#include "pirouette/path/path_reference.hpp"

#include "pirouette/base/planar_twist.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {

void PathReference::reset() noexcept { *this = PathReference(config_); }

PathPoint PathReference::update(const MotionCommand& command, const RobotState& state,
                                double dt) noexcept {
  anchor_when_due(command, state);
  ramp_twist(command, dt);
  const double pace = advance(state, dt);

  const double lead = std::clamp(yaw_ - state.rpy.yaw, -config_.max_yaw_lead, config_.max_yaw_lead);
  PathPoint point;
  point.p_WG = p_WG_;
  point.yaw = state.rpy.yaw + lead;
  point.v_H = rot2(yaw_ - point.yaw) * twist_.v_H * pace;
  point.yaw_rate = twist_.yaw_rate;
  return point;
}

void PathReference::anchor_when_due(const MotionCommand& command,
                                    const RobotState& state) noexcept {
  const Vec2 com = state.p_WG.head<2>();
  const bool starts = command.walk && !walking_;
  const bool stops = !command.walk && walking_;
  const bool redirected =
      command.walk && (command.point != command_point_ || command.heading != command_heading_);
  if (starts) {
    anchor(command.point.value_or(com), command.heading.value_or(state.rpy.yaw), state);
  } else if (redirected) {
    anchor(command.point.value_or(p_WG_), command.heading.value_or(yaw_), state);
  } else if (stops || !anchored_) {
    anchor(com, state.rpy.yaw, state);
  }
  walking_ = command.walk;
  if (command.walk) {
    command_point_ = command.point;
    command_heading_ = command.heading;
  }
}

void PathReference::anchor(const Vec2& p_WG, double yaw, const RobotState& state) noexcept {
  const double gap = wrap_angle(yaw - state.rpy.yaw);
  anchored_ = true;
  p_WG_ = p_WG;
  yaw_ = state.rpy.yaw + gap;
  yaw_gap_limit_ = std::abs(gap);
}

void PathReference::ramp_twist(const MotionCommand& command, double dt) noexcept {
  const TwistCommand wanted =
      command.walk ? TwistCommand{command.v_H, command.yaw_rate} : TwistCommand{};
  const double yaw_step = config_.max_yaw_acceleration * dt;
  twist_.v_H += clamp_norm(Vec2(wanted.v_H - twist_.v_H), config_.max_acceleration * dt);
  twist_.yaw_rate += std::clamp(wanted.yaw_rate - twist_.yaw_rate, -yaw_step, yaw_step);
}

double PathReference::pace_for(double yaw_gap, double yaw_step) noexcept {
  yaw_gap_limit_ = std::max(config_.max_yaw_lead, std::min(yaw_gap_limit_, std::abs(yaw_gap)));
  if (yaw_step == 0.0) return 1.0;
  const double room = yaw_gap_limit_ - std::copysign(1.0, yaw_step) * yaw_gap;
  return std::clamp(room / std::abs(yaw_step), 0.0, 1.0);
}

double PathReference::advance(const RobotState& state, double dt) noexcept {
  // The same heading on the branch nearest to the robot's: a robot turned round by hand does not
  // unwind whole turns.
  const double gap = wrap_angle(yaw_ - state.rpy.yaw);
  yaw_ = state.rpy.yaw + gap;
  const double yaw_step = twist_.yaw_rate * dt;
  const double pace = pace_for(gap, yaw_step);

  const Vec2 com = state.p_WG.head<2>();
  const bool fixed_in_world = config_.reference == PathReferenceMode::kAnchored;
  const double path_dt = fixed_in_world ? pace * dt : dt;
  p_WG_ += rot2(yaw_) * planar_twist_displacement(twist_.v_H, twist_.yaw_rate, path_dt);
  yaw_ += pace * yaw_step;
  switch (config_.reference) {
    case PathReferenceMode::kVelocity:
      p_WG_ = com;
      break;
    case PathReferenceMode::kIntegrated:
      p_WG_ = com + clamp_norm(Vec2(p_WG_ - com), config_.max_integrated_lead);
      break;
    case PathReferenceMode::kAnchored:
      break;
  }
  return fixed_in_world ? pace : 1.0;
}

}  // namespace pirouette
