// From sensors to state: attitude, leg odometry, contacts and creep, on one foot policy.
#pragma once

#include "pirouette/controller/controller_config.hpp"
#include "pirouette/estimation/attitude_filter.hpp"
#include "pirouette/estimation/leg_odometry_filter.hpp"
#include "pirouette/estimation/spin_creep.hpp"
#include "pirouette/estimation/tilt_bias.hpp"
#include "pirouette/foot/rolling_foot.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/types/tick_trace.hpp"

namespace pirouette {

class Localization {
 public:
  Localization(const ControllerConfig& config, const PerLeg<LegGeometry>& legs);

  void reset(const BasePose& start);

  /// Starts the odometry at `start` with every foot of `trace.feet` on the ground; sets the pose
  /// and `p_WF` of trace.state.
  void start(const BasePose& start, TickTrace& trace);

  /// trace.sensors -> trace.feet, creep, state; also `model`. Uses the contacts, plane, gait and
  /// forces of the last tick.
  void estimate(RobotModel& model, double dt, TickTrace& trace) noexcept;

  /// trace.sensors, gait, state, plane, ground -> trace.contacts.
  void find_contacts(TickTrace& trace) noexcept;

  const RollingFoot& foot() const { return foot_; }

 private:
  void estimate_base(double dt, TickTrace& trace) noexcept;
  bool debounced(const TickTrace& trace, Leg leg) noexcept;
  double trust(const TickTrace& trace, Leg leg) const;
  FootOdometry foot_odometry(const TickTrace& trace, Leg leg) const;
  Vec3 joint_feedback_force(const TickTrace& trace, Leg leg) const;
  CreepInput creep_input(const TickTrace& trace) const;
  Vec3 contact_normal(const TickTrace& trace) const;

  ControllerConfig config_;
  PerLeg<LegGeometry> legs_;
  RollingFoot foot_;
  AttitudeFilter attitude_filter_;
  LegOdometryFilter odometry_filter_;
  SpinCreep creep_;
  TiltBias tilt_bias_;
  YawUnwrapper yaw_;
  PerLeg<bool> landed_early_{};
  PerLeg<int> flag_changed_for_{};  ///< ticks that the raw flag has differed from the accepted one
};

}  // namespace pirouette
