// Last station before the motors: filter, rate limit, finite check, in that order.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/controller/joint_config.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/leg_geometry.hpp"

namespace pirouette {

class CommandGuard {
 public:
  CommandGuard(const JointConfig& config, const PerLeg<LegGeometry>& legs)
      : config_(config), legs_(legs) {}

  /// Low-passes the feed-forward torque, keeps torques and angles within the robot's limits and
  /// limits the rate of both. False: `raw` held a value that is not finite; `command` is then left
  /// as it was.
  bool update(const JointCommand& raw, double dt, JointCommand& command) noexcept;

  /// The next update starts from `measured` joint angles and no torque.
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

/// Pure joint damping: the stated safe state after every failure. The legs give way slowly and the
/// robot sinks.
JointCommand damped_stand_down(double kd);

}  // namespace pirouette
