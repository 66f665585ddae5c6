// Draws for tests that hold in any posture.
#pragma once

#include <random>

#include "pirouette/model/robot_model.hpp"

namespace pirouette::test {

class RandomRobot {
 public:
  explicit RandomRobot(unsigned seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  Vec3 vec3(double limit) {
    const double x = uniform(-limit, limit), y = uniform(-limit, limit), z = uniform(-limit, limit);
    return {x, y, z};
  }

  /// What RobotModel::update reads: any attitude, legs away from their singular postures.
  RobotState state() {
    RobotState s;
    s.p_WB = vec3(2.0);
    s.v_WB_W = vec3(1.0);
    s.R_WB = exp_so3(vec3(1.5));
    s.w_WB_B = vec3(2.0);
    for (const Leg leg : kLegs) {
      s.joint_position[leg] = Vec3(uniform(-0.5, 0.5), uniform(0.3, 1.2), uniform(-2.2, -0.8));
      s.joint_velocity[leg] = vec3(4.0);
    }
    return s;
  }

 private:
  std::mt19937 generator_;
};

/// nu = [v_WB_W; w_WB_B; joint velocities].
inline VecDof velocity_of(const RobotState& s) {
  VecDof nu;
  nu << s.v_WB_W, s.w_WB_B, s.joint_velocity[Leg::kFR], s.joint_velocity[Leg::kFL],
      s.joint_velocity[Leg::kRR], s.joint_velocity[Leg::kRL];
  return nu;
}

/// `s` after `t` seconds of its own generalised velocity, held constant.
inline RobotState moved(RobotState s, double t) {
  s.p_WB += t * s.v_WB_W;
  s.R_WB = s.R_WB * exp_so3(t * s.w_WB_B);
  for (const Leg leg : kLegs) s.joint_position[leg] += t * s.joint_velocity[leg];
  return s;
}

/// Column of a leg's first joint in a generalised velocity.
constexpr int leg_column(Leg leg) { return 6 + 3 * static_cast<int>(index(leg)); }

}  // namespace pirouette::test
