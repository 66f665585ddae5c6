#include "pirouette/path/path_reference.hpp"

#include "pirouette/base/planar_twist.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

constexpr double kProjectionWindow = 0.2;  // m, that the nearest point may move in one update

double direction_of(const Vec2& v) { return std::atan2(v.y(), v.x()); }

}  // namespace

void PathReference::follow(std::optional<Path> path) {
  path_ = std::move(path);
  walking_ = false;
}

void PathReference::reset() noexcept {
  PathReference fresh(config_);
  fresh.path_.swap(path_);
  *this = std::move(fresh);
}

PathPoint PathReference::update(const MotionCommand& command, const RobotState& state,
                                double dt) noexcept {
  anchor_when_due(command, state);
  ramp_twist(command, dt);
  const bool on_path = path_ && command.walk;
  return on_path ? follow_path(command, state, dt) : follow_twist(state, dt);
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
  if (path_ && (starts || redirected)) start_path(command, state);
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
  arc_length_ = 0.0;
}

void PathReference::start_path(const MotionCommand& command, const RobotState& state) noexcept {
  travel_direction_ = direction_of(command.v_H);
  path_->start_at(p_WG_, yaw_ + travel_direction_);
  // Without a point the path begins at the robot, even where it crosses itself.
  arc_length_ = command.point ? path_->nearest(state.p_WG.head<2>()) : 0.0;
  robot_arc_length_ = arc_length_;
}

// One factor for all of the twist, so that the ramp leaves the shape of the arc as it is.
void PathReference::ramp_twist(const MotionCommand& command, double dt) noexcept {
  const TwistCommand wanted =
      command.walk ? TwistCommand{command.v_H, command.yaw_rate} : TwistCommand{};
  const Vec2 v_change = wanted.v_H - twist_.v_H;
  const double yaw_change = wanted.yaw_rate - twist_.yaw_rate;
  double v_step = config_.max_acceleration * dt;
  double yaw_step = config_.max_yaw_acceleration * dt;
  const double v_share = std::min(1.0, v_step / v_change.norm());
  const double yaw_share = std::min(1.0, yaw_step / std::abs(yaw_change));
  v_step = std::min(v_step, yaw_share * v_change.norm());
  yaw_step = std::min(yaw_step, v_share * std::abs(yaw_change));
  twist_.v_H += clamp_norm(v_change, v_step);
  twist_.yaw_rate += std::clamp(yaw_change, -yaw_step, yaw_step);
}

double PathReference::yaw_gap(const RobotState& state) noexcept {
  // The same heading on the branch nearest to the robot's: a robot turned round by hand does not
  // unwind whole turns.
  const double gap = wrap_angle(yaw_ - state.rpy.yaw);
  yaw_ = state.rpy.yaw + gap;
  return gap;
}

double PathReference::pace_for(double yaw_gap, double yaw_step) noexcept {
  yaw_gap_limit_ = std::max(config_.max_yaw_lead, std::min(yaw_gap_limit_, std::abs(yaw_gap)));
  if (yaw_step == 0.0) return 1.0;
  const double room = yaw_gap_limit_ - std::copysign(1.0, yaw_step) * yaw_gap;
  return std::clamp(room / std::abs(yaw_step), 0.0, 1.0);
}

PathPoint PathReference::follow_twist(const RobotState& state, double dt) noexcept {
  const double yaw_step = twist_.yaw_rate * dt;
  const double yaw_pace = pace_for(yaw_gap(state), yaw_step);
  const bool fixed_in_world = config_.reference == PathReferenceMode::kAnchored;
  const double pace = fixed_in_world ? yaw_pace : 1.0;

  const double start_yaw = yaw_;
  p_WG_ += rot2(yaw_) * planar_twist_displacement(twist_.v_H, twist_.yaw_rate, pace * dt);
  p_WG_ = kept_near(state.p_WG.head<2>());
  yaw_ = start_yaw + yaw_pace * yaw_step;
  arc_length_ += pace * dt * twist_.v_H.norm();
  return point_with(rot2(yaw_) * twist_.v_H * pace, twist_.yaw_rate, state);
}

PathPoint PathReference::follow_path(const MotionCommand& command, const RobotState& state,
                                     double dt) noexcept {
  const Vec2 com = state.p_WG.head<2>();
  const bool turns = !command.hold_heading;
  if (turns && !command.v_H.isZero(0.0)) travel_direction_ = direction_of(command.v_H);

  const double way_left = std::max(path_->length() - arc_length_, 0.0);
  const double braking_speed = std::sqrt(2.0 * config_.max_acceleration * way_left);
  const double wanted_speed = twist_.v_H.norm();
  const double speed = path_->closed() ? wanted_speed : std::min(wanted_speed, braking_speed);
  double curvature = path_->at(arc_length_).curvature;
  double pace = pace_for(yaw_gap(state), turns ? curvature * speed * dt : 0.0);
  robot_arc_length_ = path_->nearest(com, robot_arc_length_, kProjectionWindow);
  if (speed > 0.0) {
    const double room = robot_arc_length_ + config_.max_path_lead - arc_length_;
    pace = std::clamp(room / (speed * dt), 0.0, pace);
  }
  if (config_.reference != PathReferenceMode::kAnchored) pace = 1.0;

  arc_length_ += pace * speed * dt;
  const PathSample here = path_->at(arc_length_);
  p_WG_ = here.p;
  p_WG_ = kept_near(com);
  if (turns) yaw_ += wrap_angle(here.heading - travel_direction_ - yaw_);
  const Vec2 tangent(std::cos(here.heading), std::sin(here.heading));
  const double yaw_rate = turns ? here.curvature * speed * pace : 0.0;
  return point_with(tangent * (speed * pace), yaw_rate, state);
}

Vec2 PathReference::kept_near(const Vec2& com) const noexcept {
  switch (config_.reference) {
    case PathReferenceMode::kVelocity:
      return com;
    case PathReferenceMode::kIntegrated:
      return com + clamp_norm(Vec2(p_WG_ - com), config_.max_integrated_lead);
    case PathReferenceMode::kAnchored:
      break;
  }
  return p_WG_;
}

PathPoint PathReference::point_with(const Vec2& v_W, double yaw_rate,
                                    const RobotState& state) const noexcept {
  const double lead = std::clamp(yaw_ - state.rpy.yaw, -config_.max_yaw_lead, config_.max_yaw_lead);
  PathPoint point;
  point.p_WG = p_WG_;
  point.yaw = state.rpy.yaw + lead;
  point.v_H = rot2(-point.yaw) * v_W;
  point.yaw_rate = yaw_rate;
  point.arc_length = arc_length_;
  return point;
}

}  // namespace pirouette
