// State estimation from the sensors: attitude, leg odometry, contacts and creep, with one foot
// model.
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

/// Input of Localization::estimate(). `last_...`: of the tick before.
struct LocalizationInput {
  const SensorReading& sensors;       ///< of this tick
  const RobotState& last_state;       ///< estimated state of the robot
  const FootContacts& last_contacts;  ///< contact of each foot
  const GaitPhase& last_gait;         ///< phase of each leg
  const TerrainPlane& last_plane;     ///< estimated ground plane
  const GroundEstimate& last_ground;  ///< kind of ground
  const PerLeg<Vec3>& last_f_W;  ///< N, forces of the whole-body control on the robot, world axes
  bool turns_on_purpose;         ///< the trunk turns over its feet: StandingCheck
  const JointCommand& last_command;  ///< joint command sent
};

/// Output of Localization::estimate().
struct LocalizationOutput {
  RobotState state;                 ///< estimated state of the robot
  PerLeg<FootState> feet{};         ///< kinematics of each leg
  CreepEstimate creep;              ///< creep of the stance feet
  Vec2 tilt_bias_H = Vec2::Zero();  ///< apparent slope that turns with the trunk, heading axes
};

/// Input of Localization::find_contacts(). `last_...`: of the tick before.
struct ContactInput {
  /// Raw flags; absent: the robot has no contact sensing.
  const std::optional<PerLeg<bool>>& foot_contact;
  const PerLeg<bool>& encoder_stuck;  ///< the leg's joint angles are not used
  const RobotState& state;            ///< estimated state of the robot
  const PerLeg<FootState>& feet;      ///< kinematics of each leg
  const GaitPhase& gait;              ///< phase of each leg
  const TerrainPlane& last_plane;     ///< estimated ground plane
  const GroundEstimate& last_ground;  ///< kind of ground
};

/// Estimates the state of the robot and the contacts of its feet.
class Localization {
 public:
  /// Call reset() and start() before the first estimate.
  Localization(const ControllerConfig& config, const PerLeg<LegGeometry>& legs,
               const RobotScale& scale = {});

  /// Discards all memory and takes attitude and yaw of `start`.
  void reset(const BasePose& start);

  /// Starts the odometry at `start` with all feet on the ground, at `joint_position` (rad). Returns
  /// the state at rest there, of which only the pose of the trunk and `p_WF` are set.
  RobotState start(const BasePose& start, const PerLeg<Vec3>& joint_position);

  /// The robot's state after one tick of `dt` (s); also updates `model` at it.
  LocalizationOutput estimate(const LocalizationInput& in, RobotModel& model, double dt) noexcept;

  /// Contact of each foot: schedule, debounced flags, early contact; `dt` in s.
  FootContacts find_contacts(const ContactInput& in, double dt) noexcept;

  /// Feet whose contact flag is not used because it makes no sense (FlagTrust).
  PerLeg<bool> dropped_flags() const noexcept;

  const PerLeg<RollingFoot>& rolling_feet() const { return rolling_feet_; }  ///< foot models in use

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, legs, scale, rolling_feet, attitude_filter, odometry_filter, creep, tilt_bias,
           yaw, landed_early, flags, flag_trust] = self;
    visit(attitude_filter, odometry_filter, creep, tilt_bias, yaw, landed_early, flags, flag_trust);
  }

 private:
  /// Motion of the trunk in this tick.
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
  RobotScale scale_;
  PerLeg<RollingFoot> rolling_feet_;
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
