// A robot that is nothing but kinematics: it does what the tracker says, up to a lag and a bias.
#pragma once

#include <algorithm>

#include "pirouette/path/path_reference.hpp"
#include "pirouette/path/tracker.hpp"

namespace pirouette::test {

struct KinematicRobot {
  Vec2 p_WG = Vec2::Zero();
  double yaw = 0.0;            ///< rad, unwrapped
  Vec2 v_H = Vec2::Zero();     ///< m/s
  double yaw_rate = 0.0;       ///< rad/s
  Vec2 bias_H = Vec2::Zero();  ///< m/s, on top of what is commanded, fixed to the body
  double lag = 0.0;            ///< s, time constant with which velocities follow the command
  double max_yaw_rate = 10.0;  ///< rad/s

  RobotState state() const {
    RobotState s;
    s.p_WG << p_WG, 0.27;
    s.rpy.yaw = yaw;
    return s;
  }

  void step(const TwistCommand& twist, double dt) {
    const double share = lag > 0.0 ? 1.0 - std::exp(-dt / lag) : 1.0;
    v_H += share * (twist.v_H - v_H);
    yaw_rate += share * (std::clamp(twist.yaw_rate, -max_yaw_rate, max_yaw_rate) - yaw_rate);
    p_WG += dt * (rot2(yaw + 0.5 * dt * yaw_rate) * (v_H + bias_H));
    yaw += dt * yaw_rate;
  }
};

/// Path reference, tracker and kinematic robot in a closed loop at 500 Hz.
struct PathLoop {
  static constexpr double kDt = 0.002;

  explicit PathLoop(const PathConfig& config) : reference(config), tracker(config, 1.0 / kDt) {}

  void step(const MotionCommand& command) {
    point = reference.update(command, robot.state(), kDt);
    twist = tracker.update(point, robot.state(), kDt);
    robot.step(twist, kDt);
  }
  void run(const MotionCommand& command, double duration) {
    for (int i = 0; i < static_cast<int>(std::lround(duration / kDt)); ++i) step(command);
  }

  PathReference reference;
  Tracker tracker;
  KinematicRobot robot;
  PathPoint point;
  TwistCommand twist;
};

inline MotionCommand walk(const Vec2& v_H, double yaw_rate) {
  MotionCommand command;
  command.walk = true;
  command.v_H = v_H;
  command.yaw_rate = yaw_rate;
  return command;
}

}  // namespace pirouette::test
