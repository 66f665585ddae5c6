// What the controller sends to the joints: tau_motor = tau + kp (q - q_measured) + kd (dq -
// dq_measured).
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

/// Command of the joints of one leg: abad, hip, knee.
struct LegCommand {
  Vec3 q = Vec3::Zero();    ///< rad, joint angles
  Vec3 dq = Vec3::Zero();   ///< rad/s, joint velocities
  Vec3 kp = Vec3::Zero();   ///< N m/rad, stiffness
  Vec3 kd = Vec3::Zero();   ///< N m s/rad, damping
  Vec3 tau = Vec3::Zero();  ///< N m, feed-forward torque

  /// N m, that the motors give at the joint angles `q_now` (rad) and velocities `dq_now` (rad/s).
  Vec3 torque(const Vec3& q_now, const Vec3& dq_now) const {
    return tau + kp.cwiseProduct(q - q_now) + kd.cwiseProduct(dq - dq_now);
  }
};

/// Command of all joints.
using JointCommand = PerLeg<LegCommand>;

/// What the controller does, or why it has stopped.
enum class ControllerStatus : int {
  kStanding = 0,         ///< stands on four feet
  kWalking = 1,          ///< walks
  kFallen = 2,           ///< roll, pitch or height out of bounds: damped stand-down
  kBadInput = 3,         ///< inputs not finite, or sensors dead, for too long: damped stand-down
  kSolverFailed = 4,     ///< MPC or WBC failed too often in a row: damped stand-down
  kBadCommand = 5,       ///< the computed command was not finite: damped stand-down
  kCheckFailed = 6,      ///< the self-check found something wrong: damped stand-down
  kGyroAgainstLegs = 7,  ///< gyro and legs contradict each other: damped stand-down
};

/// What the status says, in a few words.
constexpr std::string_view words(ControllerStatus status) {
  constexpr std::array<std::string_view, 8> kWords = {"standing",
                                                      "walking",
                                                      "fallen",
                                                      "bad input",
                                                      "solver failed",
                                                      "bad command",
                                                      "self-check failed",
                                                      "gyro and legs contradict each other"};
  return kWords[static_cast<std::size_t>(status)];
}

/// True for every status in which the controller has stood down; it stays so until reset().
constexpr bool is_stood_down(ControllerStatus s) { return static_cast<int>(s) >= 2; }

}  // namespace pirouette
