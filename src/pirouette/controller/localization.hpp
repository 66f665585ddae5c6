// From sensors to state: attitude, leg odometry, contacts and creep, on one foot policy.
#pragma once

#include "pirouette/controller/contact_debounce.hpp"
#include "pirouette/controller/controller_config.hpp"
#include "pirouette/controller/flag_trust.hpp"
#include "pirouette/estimation/attitude_filter.hpp"
#include "pirouette/estimation/leg_odometry_filter.hpp"
#include "pirouette/estimation/spin_creep.hpp"
#include "pirouette/estimation/tilt_bias.hpp"
#include "pirouette/foot/rolling_foot.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/foot_state.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/ground_estimate.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/sensor_reading.hpp"
#include "pirouette/types/terrain_plane.hpp"

namespace pirouette {

/// What the state is estimated from. `last_...`: of the tick before.
struct LocalizationInput {
  const SensorReading& sensors;
  const RobotState& last_state;
  const FootContacts& last_contacts;
  const GaitPhase& last_gait;
  const TerrainPlane& last_plane;
  const GroundEstimate& last_ground;
  const PerLeg<Vec3>& last_f_W;  ///< N, of the whole-body solution, world axes
  const JointCommand& last_command;
};

struct LocalizationOutput {
  RobotState state;
  PerLeg<FootState> feet{};
  CreepEstimate creep;
  Vec2 tilt_bias_H = Vec2::Zero();  ///< apparent slope that turns with the trunk
};

/// What tells where the feet stand. `last_...`: of the tick before.
struct ContactInput {
  const std::optional<PerLeg<bool>>& foot_contact;  ///< raw flags; absent: none are measured
  const PerLeg<bool>& encoder_stuck;
  const RobotState& state;
  const PerLeg<FootState>& feet;
  const GaitPhase& gait;
  const TerrainPlane& last_plane;
  const GroundEstimate& last_ground;
};

class Localization {
 public:
  Localization(const ControllerConfig& config, const PerLeg<LegGeometry>& legs);

  void reset(const BasePose& start);

  /// Starts the odometry at `start` with all feet on the ground, at `joint_position` (rad). Returns
  /// the state at rest there, without what only estimate() knows: the trunk's pose and `p_WF`.
  RobotState start(const BasePose& start, const PerLeg<Vec3>& joint_position);

  /// The robot's state; also brings `model` to it.
  LocalizationOutput estimate(const LocalizationInput& in, RobotModel& model, double dt) noexcept;

  FootContacts find_contacts(const ContactInput& in, double dt) noexcept;

  /// Feet whose contact flag is not believed: the schedule stands in for it.
  PerLeg<bool> dropped_flags() const noexcept;

  const RollingFoot& foot() const { return foot_; }

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, legs, foot, attitude_filter, odometry_filter, creep, tilt_bias, yaw,
           landed_early, flags, flag_trust] = self;
    visit(attitude_filter, odometry_filter, creep, tilt_bias, yaw, landed_early, flags, flag_trust);
  }

 private:
  /// The trunk's motion as this tick knows it.
  struct Trunk {
    Vec3 p_WB;
    Vec3 v_WB_W;
    Mat3 R_WB;
    Vec3 w_WB_B;
  };

  Trunk estimate_trunk(const LocalizationInput& in, const PerLeg<FootState>& feet,
                       const CreepEstimate& creep, double dt) noexcept;
  double trust(const LocalizationInput& in, Leg leg) const;
  FootOdometry foot_odometry(const LocalizationInput& in, const FootState& foot, const Mat3& R_WB,
                             const Vec3& w_WB_B, const CreepEstimate& creep, Leg leg) const;
  Vec3 joint_feedback_force(const LocalizationInput& in, Leg leg) const;
  CreepInput creep_input(const LocalizationInput& in) const;
  Vec3 contact_normal(const ContactInput& in) const;
  bool touches(const ContactInput& in, Leg leg, bool flag_believed) noexcept;

  ControllerConfig config_;
  PerLeg<LegGeometry> legs_;
  RollingFoot foot_;
  AttitudeFilter attitude_filter_;
  LegOdometryFilter odometry_filter_;
  SpinCreep creep_;
  TiltBias tilt_bias_;
  YawUnwrapper yaw_;
  PerLeg<bool> landed_early_{};
  PerLeg<ContactDebounce> flags_;
  PerLeg<FlagTrust> flag_trust_{};
};

}  // namespace pirouette
