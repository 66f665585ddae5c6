#include "pirouette/controller/standing_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

#include "pirouette/foot/leg_kinematics.hpp"

namespace pirouette {
namespace {

constexpr std::array<const char*, kJointsPerLeg> kRoles = {"abad", "hip", "knee"};

template <class... Text>
Error problem(const char* key, const Text&... text) {
  std::ostringstream message;
  message.precision(3);
  (message << ... << text);
  return {"", 0, key, message.str()};
}

}  // namespace

StandingLoad standing_load(RobotModel& robot, double body_height) {
  StandingLoad out;
  constexpr int kPasses = 3;  // the CoM's place depends a little on the legs' posture
  for (int pass = 0; pass < kPasses; ++pass) {
    for (const Leg leg : kLegs) {
      const LegGeometry& g = robot.legs()[leg];
      const double trunk_height = body_height - out.p_BG.z();
      const Vec3 p_HF(0.0, g.abad_offset, g.foot_radius - trunk_height - g.p_BH.z());
      const IkSolution ik = inverse_kinematics(g, p_HF);
      out.q[leg] = ik.q;
      out.reaches[leg] = ik.reachable();
    }
    out.p_BG = robot.com(out.q);
  }
  const Vec3 half_weight(0.0, 0.0, 0.5 * robot.mass() * kGravity);
  for (const Leg leg : kLegs)
    out.torque[leg] = -foot_jacobian(robot.legs()[leg], out.q[leg]).transpose() * half_weight;
  return out;
}

Errors check_standing(const ControllerConfig& config, RobotModel& robot) {
  const double height = config.body.height;
  const StandingLoad load = standing_load(robot, height);
  Errors errors;
  for (const Leg leg : kLegs) {
    if (load.reaches[leg] || !errors.empty()) continue;
    const LegGeometry& g = robot.legs()[leg];
    errors.push_back(problem("body.height", "the robot cannot stand with its CoM ", height,
                             " m above the ground: leg ", name(leg), " is ", g.thigh + g.shank,
                             " m long"));
  }
  if (!errors.empty()) return errors;

  for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
    // Legs are alike: the worst of the four speaks for all.
    const auto at = static_cast<Eigen::Index>(i);
    Leg far = Leg::kFR, weak = Leg::kFR;
    const auto beyond = [&](Leg leg) {
      const LegGeometry& g = robot.legs()[leg];
      return std::max(g.q_min[at] - load.q[leg][at], load.q[leg][at] - g.q_max[at]);
    };
    const auto effort = [&](Leg leg) {
      return std::abs(load.torque[leg][at]) / robot.legs()[leg].tau_max[at];
    };
    for (const Leg leg : kLegs) {
      if (beyond(leg) > beyond(far)) far = leg;
      if (effort(leg) > effort(weak)) weak = leg;
    }
    if (beyond(far) > 0.0) {
      const LegGeometry& g = robot.legs()[far];
      errors.push_back(problem("body.height", "standing with its CoM ", height,
                               " m above the ground, ", name(far), " ", kRoles.at(i), " is at ",
                               load.q[far][at], " rad, beyond its range of ", g.q_min[at], " to ",
                               g.q_max[at], " rad"));
    }
    if (effort(weak) > 1.0) {
      errors.push_back(problem("body.height", "standing with its CoM ", height,
                               " m above the ground, ", name(weak), " ", kRoles.at(i), " needs ",
                               std::abs(load.torque[weak][at]), " N m to carry half the weight of ",
                               robot.mass(), " kg; its motor gives ",
                               robot.legs()[weak].tau_max[at], " N m"));
    }
  }
  const double weight = robot.mass() * kGravity;
  if (2.0 * config.mpc.max_normal_force < weight) {
    errors.push_back(problem("mpc.max_normal_force", "given ", config.mpc.max_normal_force,
                             " N: two feet cannot carry the weight of ", weight,
                             " N; allowed: more than ", 0.5 * weight, " N"));
  }
  return errors;
}

}  // namespace pirouette
