// Filter, rate limit and finite check of the joint command, in that order, before it is sent to the
// motors.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/controller/joint_config.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/leg_geometry.hpp"

namespace pirouette {

/// Limits of the joint command. Remembers the last torques and angles sent.
class CommandGuard {
 public:
  /// `legs` holds the limits of torque and angle.
  CommandGuard(const JointConfig& config, const PerLeg<LegGeometry>& legs)
      : config_(config), legs_(legs) {}

  /// Low-passes the feed-forward torque, keeps torques and angles within the robot's limits and
  /// limits the rate of both over `dt` (s). Returns false and leaves `command` unchanged when a
  /// value of `raw` is not finite.
  bool update(const JointCommand& raw, double dt, JointCommand& command) noexcept;

  /// The next update starts from the `measured` joint angles (rad) and no torque.
  void reset(const PerLeg<Vec3>& measured) noexcept;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, legs, tau, q] = self;
    visit(tau, q);
  }

 private:
  JointConfig config_;
  PerLeg<LegGeometry> legs_;
  PerLeg<Vec3> tau_{};
  PerLeg<Vec3> q_{};
};

/// Command of pure joint damping `kd` (N m s/rad): the safe state after every failure, in which the
/// robot sinks slowly.
JointCommand damped_stand_down(double kd);

}  // namespace pirouette
