#include "pirouette/controller/localization.hpp"

#include "pirouette/controller/tick_clock.hpp"

namespace pirouette {

namespace {

/// The measurement variances are those of kVariancesAt readings a second. What a second of readings
/// tells is the same at any rate.
EstimationConfig at_rate(EstimationConfig config, double rate) {
  constexpr double kVariancesAt = 500.0;  // Hz
  const double factor = rate / kVariancesAt;
  config.measurement_position *= factor;
  config.measurement_velocity *= factor;
  config.measurement_height *= factor;
  return config;
}

}  // namespace

Localization::Localization(const ControllerConfig& config, const PerLeg<LegGeometry>& legs,
                           const RobotScale& scale)
    : config_(config),
      legs_(legs),
      scale_(scale),
      rolling_feet_(pirouette::rolling_feet(config.foot.model, legs)),
      attitude_filter_(config.estimation, 1.0 / config.control.rate),
      odometry_filter_(at_rate(config.estimation, config.control.rate)),
      creep_(config.creep, scale),
      tilt_bias_(config.estimation.tilt_bias_time),
      flags_(PerLeg<ContactDebounce>::filled(ContactDebounce(std::max(
          1, ticks_in(config.estimation.contact_debounce_time, 1.0 / config.control.rate))))) {}

void Localization::reset(const BasePose& start) {
  attitude_filter_.reset(start.R_WB);
  creep_.reset();
  tilt_bias_.reset();
  yaw_.reset(rpy_from_rotation(start.R_WB).yaw);
  landed_early_ = {};
  for (ContactDebounce& flag : flags_) flag.reset();
  for (FlagTrust& trust : flag_trust_) trust.reset();
}

RobotState Localization::start(const BasePose& start, const PerLeg<Vec3>& joint_position) {
  RobotState state;
  state.p_WB = start.p_WB;
  state.R_WB = start.R_WB;
  for (const Leg leg : kLegs) {
    const FootState foot = foot_state(legs_[leg], joint_position[leg], Vec3::Zero());
    state.p_WF[leg] = start.p_WB + start.R_WB * foot.p_BF;
  }
  odometry_filter_.reset(start.p_WB, state.p_WF);
  return state;
}

/// Weight in [0, 1] of the foot's measurement in the odometry: ramps in after touchdown and out
/// before lift-off.
double Localization::trust(const LocalizationInput& in, Leg leg) const {
  if (!in.last_gait.walking) return 1.0;
  const LegPhase& phase = in.last_gait.leg[leg];
  if (!phase.stance || !in.last_contacts[leg].measured) return 0.0;
  const double window = config_.estimation.trust_window;
  if (window <= 0.0) return 1.0;
  return std::clamp(std::min(phase.progress, 1.0 - phase.progress) / window, 0.0, 1.0);
}

FootOdometry Localization::foot_odometry(const LocalizationInput& in, const FootState& foot,
                                         const Mat3& R_WB, const Vec3& w_WB_B,
                                         const CreepEstimate& creep, Leg leg) const {
  FootOdometry out;
  out.p_BF_W = R_WB * foot.p_BF;
  out.v_BF_W = R_WB * (w_WB_B.cross(foot.p_BF) + foot.v_BF_B);
  const Vec3 w_WS_W = R_WB * (w_WB_B + foot.w_BS_B);
  const Vec3& n_W = in.last_contacts[leg].n_W;
  out.v_WF_stance_W = rolling_feet_[leg].rolling_velocity(w_WS_W, n_W) +
                      std::abs(w_WS_W.dot(n_W)) * creep.slip_per_twist_W;
  out.trust = trust(in, leg);
  const TerrainPlane& plane = in.last_plane;
  const Vec3 p_WF = in.last_state.p_WB + out.p_BF_W;
  const double above_plane =
      rolling_feet_[leg].radius() * std::sqrt(1.0 + square(plane.a1) + square(plane.a2));
  out.centre_height = plane.height(p_WF.x(), p_WF.y()) + above_plane;
  // On steps the plane is nobody's ground.
  out.use_height = !in.last_ground.stepped;
  return out;
}

/// N, world axes: what the joints' own position control adds to the force of a stance foot.
Vec3 Localization::joint_feedback_force(const LocalizationInput& in, Leg leg) const {
  const LegCommand& c = in.last_command[leg];
  const Mat3& R_WB = in.last_state.R_WB;
  const Vec3& q = in.sensors.joint_position[leg];
  const Vec3 tau =
      c.kp.cwiseProduct(c.q - q) + c.kd.cwiseProduct(c.dq - in.sensors.joint_velocity[leg]);
  const Vec3 n_B = R_WB.transpose() * in.last_contacts[leg].n_W;
  const Mat3 J_C = rolling_feet_[leg].contact_jacobian(legs_[leg], q, n_B);
  // Near a straight leg a small torque would pass for a large force.
  constexpr double kMinDeterminant = 1e-3;  // m^3, of a robot of scale 1
  if (std::abs(J_C.determinant()) < kMinDeterminant * scale_.volume()) return Vec3::Zero();
  return -R_WB * (J_C.transpose().inverse() * tau);
}

CreepInput Localization::creep_input(const LocalizationInput& in) const {
  CreepInput out;
  out.n_W = in.last_plane.normal();
  out.twist_rate = in.last_gait.walking ? in.last_state.w_WB_W().dot(out.n_W) : 0.0;
  for (const Leg leg : kLegs) {
    const FootContact& contact = in.last_contacts[leg];
    if (!contact.in_contact) continue;
    const Vec3 f_W = in.last_f_W[leg] + joint_feedback_force(in, leg);
    out.yaw_moment += (contact.p_WC - in.last_state.p_WG).cross(f_W).dot(out.n_W);
    out.normal_force += f_W.dot(out.n_W);
  }
  return out;
}

/// Pose and velocity of the trunk from inertial sensors and leg odometry.
Localization::Trunk Localization::estimate_trunk(const LocalizationInput& in,
                                                 const PerLeg<FootState>& feet,
                                                 const CreepEstimate& creep, double dt) noexcept {
  const SensorReading& sensors = in.sensors;
  AttitudeInput attitude_in;
  attitude_in.w_WB_B = sensors.w_WB_B;
  attitude_in.specific_force_B = sensors.specific_force_B;
  attitude_in.v_WB_W = in.last_state.v_WB_W;
  attitude_in.at_rest = !in.last_gait.walking;
  attitude_in.turns_on_purpose = in.turns_on_purpose;
  for (const Leg leg : kLegs) attitude_in.p_BF[leg] = feet[leg].p_BF;
  const Attitude attitude = attitude_filter_.update(attitude_in, dt);
  if (in.last_gait.walking && in.last_ground.known && !in.last_ground.stepped) {
    const Vec2 seen(in.last_plane.a1, in.last_plane.a2);
    const double heading = in.last_state.rpy.yaw;
    tilt_bias_.update(seen + rot2(heading) * tilt_bias_.slope_H(), heading, dt);
  }
  // Steps met late have been in the average for a while.
  if (in.last_ground.stepped) tilt_bias_.reset();
  const Mat3 R_WB = attitude.R_WB * exp_so3(-tilt_bias_.rotation_B());
  OdometryInput odometry_in;
  // The accelerometer's bias and the tilt that it causes cancel: no correction here.
  odometry_in.a_WB_W = attitude.R_WB * sensors.specific_force_B - Vec3(0.0, 0.0, kGravity);
  for (const Leg leg : kLegs) {
    odometry_in.foot[leg] = foot_odometry(in, feet[leg], R_WB, attitude.w_WB_B, creep, leg);
  }
  const OdometryEstimate odometry = odometry_filter_.update(odometry_in, dt);
  return {odometry.p_WB, odometry.v_WB_W, R_WB, attitude.w_WB_B};
}

LocalizationOutput Localization::estimate(const LocalizationInput& in, RobotModel& model,
                                          double dt) noexcept {
  const SensorReading& sensors = in.sensors;
  CreepEstimate creep = creep_.update(creep_input(in), dt);
  // Blocks of a staircase carry level feet: their creep is not the plane's.
  if (in.last_ground.stepped) creep.slip_per_twist_W.setZero();

  PerLeg<FootState> feet;
  for (const Leg leg : kLegs) {
    feet[leg] = foot_state(legs_[leg], sensors.joint_position[leg], sensors.joint_velocity[leg]);
  }
  const bool from_truth =
      config_.estimation.source == EstimatorSource::kTruth && sensors.truth.has_value();
  const Trunk trunk = from_truth ? Trunk{sensors.truth->p_WB, sensors.truth->v_WB_W,
                                         sensors.truth->R_WB, sensors.truth->w_WB_B}
                                 : estimate_trunk(in, feet, creep, dt);

  LocalizationOutput out{{}, feet, creep, tilt_bias_.slope_H()};
  RobotState& state = out.state;
  state.time = sensors.time;
  state.joint_position = sensors.joint_position;
  state.joint_velocity = sensors.joint_velocity;
  state.p_WB = trunk.p_WB;
  state.v_WB_W = trunk.v_WB_W;
  state.R_WB = trunk.R_WB;
  state.w_WB_B = trunk.w_WB_B;
  state.rpy = rpy_from_rotation(trunk.R_WB);
  state.rpy.yaw = yaw_.update(state.rpy.yaw);
  for (const Leg leg : kLegs) {
    const FootState& f = feet[leg];
    state.p_WF[leg] = trunk.p_WB + trunk.R_WB * f.p_BF;
    state.v_WF_W[leg] = trunk.v_WB_W + trunk.R_WB * (trunk.w_WB_B.cross(f.p_BF) + f.v_BF_B);
  }
  model.update(state);
  state.p_WG = model.p_WG();
  state.v_WG_W = model.v_WG_W();
  return out;
}

Vec3 Localization::contact_normal(const ContactInput& in) const {
  switch (config_.terrain.contact_normal) {
    case ContactNormal::kVertical:
      return Vec3::UnitZ();
    case ContactNormal::kPlane:
      return in.last_plane.normal();
    case ContactNormal::kAuto:
      break;
  }
  return in.last_ground.stepped ? Vec3(Vec3::UnitZ()) : in.last_plane.normal();
}

PerLeg<bool> Localization::dropped_flags() const noexcept {
  PerLeg<bool> dropped{};
  for (const Leg leg : kLegs) dropped[leg] = !flag_trust_[leg].believed();
  return dropped;
}

/// The foot's contact flag, debounced; the schedule's where there is none to believe.
bool Localization::touches(const ContactInput& in, Leg leg, bool flag_believed) noexcept {
  ContactDebounce& flag = flags_[leg];
  // Nobody knows where the foot of such a leg is.
  if (in.encoder_stuck[leg]) return flag.set(false);
  if (!flag_believed) return flag.set(in.gait.leg[leg].stance);
  return flag.update((*in.foot_contact)[leg]);
}

FootContacts Localization::find_contacts(const ContactInput& in, double dt) noexcept {
  const RobotState& state = in.state;
  const Vec3 n_W = contact_normal(in);
  FootContacts out;
  for (const Leg leg : kLegs) {
    FootContact& contact = out[leg];
    const LegPhase& phase = in.gait.leg[leg];
    const bool flag_believed =
        in.foot_contact &&
        flag_trust_[leg].update((*in.foot_contact)[leg], phase, in.gait.walking, dt);
    contact.measured = touches(in, leg, flag_believed);
    const bool late_in_swing =
        !phase.stance && phase.progress >= config_.gait.early_contact_progress;
    landed_early_[leg] =
        late_in_swing && (landed_early_[leg] || (flag_believed && contact.measured));
    contact.in_contact = phase.stance || landed_early_[leg];
    contact.n_W = n_W;
    contact.p_WC = rolling_feet_[leg].contact_point(state.p_WF[leg], n_W);
    contact.v_WF_rolling_W =
        rolling_feet_[leg].rolling_velocity(state.R_WB * (state.w_WB_B + in.feet[leg].w_BS_B), n_W);
  }
  return out;
}

}  // namespace pirouette
