#include "pirouette/controller/localization.hpp"

namespace pirouette {

Localization::Localization(const ControllerConfig& config, const PerLeg<LegGeometry>& legs)
    : config_(config),
      legs_(legs),
      foot_(config.foot.model, legs[Leg::kFR].foot_radius),
      attitude_filter_(config.estimation),
      odometry_filter_(config.estimation),
      creep_(config.creep),
      tilt_bias_(config.estimation.tilt_bias_time) {}

void Localization::reset(const BasePose& start) {
  attitude_filter_.reset(start.R_WB);
  creep_.reset();
  tilt_bias_.reset();
  yaw_.reset(rpy_from_rotation(start.R_WB).yaw);
  landed_early_ = {};
  flag_changed_for_ = {};
}

void Localization::start(const BasePose& start, TickTrace& trace) {
  RobotState& state = trace.state;
  state.p_WB = start.p_WB;
  state.R_WB = start.R_WB;
  for (const Leg leg : kLegs) {
    state.p_WF[leg] = start.p_WB + start.R_WB * trace.feet[leg].p_BF;
  }
  odometry_filter_.reset(start.p_WB, state.p_WF);
}

/// How much of a foot's word the odometry takes: ramps in after touchdown and out before lift-off.
double Localization::trust(const TickTrace& trace, Leg leg) const {
  if (!trace.gait.walking) return 1.0;
  const LegPhase& phase = trace.gait.leg[leg];
  if (!phase.stance || !trace.contacts[leg].measured) return 0.0;
  const double window = config_.estimation.trust_window;
  if (window <= 0.0) return 1.0;
  return std::clamp(std::min(phase.progress, 1.0 - phase.progress) / window, 0.0, 1.0);
}

FootOdometry Localization::foot_odometry(const TickTrace& trace, Leg leg) const {
  const FootState& state = trace.feet[leg];
  const Mat3& R_WB = trace.state.R_WB;
  FootOdometry out;
  out.p_BF_W = R_WB * state.p_BF;
  out.v_BF_W = R_WB * (trace.state.w_WB_B.cross(state.p_BF) + state.v_BF_B);
  const Vec3 w_WS_W = R_WB * (trace.state.w_WB_B + state.w_BS_B);
  const Vec3& n_W = trace.contacts[leg].n_W;
  out.v_WF_stance_W = foot_.rolling_velocity(w_WS_W, n_W) +
                      std::abs(w_WS_W.dot(n_W)) * trace.creep.slip_per_twist_W;
  out.trust = trust(trace, leg);
  const Vec3 p_WF = trace.state.p_WB + out.p_BF_W;
  const double above_plane =
      foot_.radius() * std::sqrt(1.0 + square(trace.plane.a1) + square(trace.plane.a2));
  out.centre_height = trace.plane.height(p_WF.x(), p_WF.y()) + above_plane;
  // On steps the plane is nobody's ground.
  out.use_height = !trace.ground.stepped;
  return out;
}

/// N, world axes: what the joints' own position control adds to the force of a stance foot.
Vec3 Localization::joint_feedback_force(const TickTrace& trace, Leg leg) const {
  const LegCommand& c = trace.command[leg];
  const Vec3& q = trace.sensors.joint_position[leg];
  const Vec3 tau =
      c.kp.cwiseProduct(c.q - q) + c.kd.cwiseProduct(c.dq - trace.sensors.joint_velocity[leg]);
  const Vec3 n_B = trace.state.R_WB.transpose() * trace.contacts[leg].n_W;
  const Mat3 J_C = foot_.contact_jacobian(legs_[leg], q, n_B);
  // Near a straight leg a small torque would pass for a large force.
  constexpr double kMinDeterminant = 1e-3;  // m^3
  if (std::abs(J_C.determinant()) < kMinDeterminant) return Vec3::Zero();
  return -trace.state.R_WB * (J_C.transpose().inverse() * tau);
}

CreepInput Localization::creep_input(const TickTrace& trace) const {
  CreepInput in;
  in.n_W = trace.plane.normal();
  in.twist_rate = trace.gait.walking ? trace.state.w_WB_W().dot(in.n_W) : 0.0;
  for (const Leg leg : kLegs) {
    if (!trace.contacts[leg].in_contact) continue;
    const Vec3 f_W = trace.wbc.f_W[leg] + joint_feedback_force(trace, leg);
    in.yaw_moment += (trace.contacts[leg].p_WC - trace.state.p_WG).cross(f_W).dot(in.n_W);
    in.normal_force += f_W.dot(in.n_W);
  }
  return in;
}

/// Pose and velocity of the trunk from inertial sensors and leg odometry.
void Localization::estimate_base(double dt, TickTrace& trace) noexcept {
  const SensorReading& sensors = trace.sensors;
  RobotState& state = trace.state;
  AttitudeInput attitude_in{
      sensors.w_WB_B, sensors.specific_force_B, state.v_WB_W, !trace.gait.walking, {}};
  for (const Leg leg : kLegs) attitude_in.p_BF[leg] = trace.feet[leg].p_BF;
  const Attitude attitude = attitude_filter_.update(attitude_in, dt);
  if (trace.gait.walking && trace.ground.known && !trace.ground.stepped) {
    const Vec2 seen(trace.plane.a1, trace.plane.a2);
    const double heading = state.rpy.yaw;
    tilt_bias_.update(seen + rot2(heading) * trace.tilt_bias_H, heading, dt);
  }
  // Steps met late have been in the average for a while.
  if (trace.ground.stepped) tilt_bias_.reset();
  trace.tilt_bias_H = tilt_bias_.slope_H();
  state.R_WB = attitude.R_WB * exp_so3(-tilt_bias_.rotation_B());
  state.w_WB_B = attitude.w_WB_B;
  OdometryInput in;
  // The accelerometer's bias and the tilt that it causes cancel: no correction here.
  in.a_WB_W = attitude.R_WB * sensors.specific_force_B - Vec3(0.0, 0.0, kGravity);
  for (const Leg leg : kLegs) in.foot[leg] = foot_odometry(trace, leg);
  const OdometryEstimate odometry = odometry_filter_.update(in, dt);
  state.p_WB = odometry.p_WB;
  state.v_WB_W = odometry.v_WB_W;
}

void Localization::estimate(RobotModel& model, double dt, TickTrace& trace) noexcept {
  const SensorReading& sensors = trace.sensors;
  RobotState& state = trace.state;
  trace.creep = creep_.update(creep_input(trace), dt);
  // Blocks of a staircase carry level feet: their creep is not the plane's.
  if (trace.ground.stepped) trace.creep.slip_per_twist_W.setZero();

  state.time = sensors.time;
  state.joint_position = sensors.joint_position;
  state.joint_velocity = sensors.joint_velocity;
  for (const Leg leg : kLegs) {
    trace.feet[leg] =
        foot_state(legs_[leg], sensors.joint_position[leg], sensors.joint_velocity[leg]);
  }
  if (config_.estimation.source == EstimatorSource::kTruth && sensors.truth) {
    state.p_WB = sensors.truth->p_WB;
    state.R_WB = sensors.truth->R_WB;
    state.v_WB_W = sensors.truth->v_WB_W;
    state.w_WB_B = sensors.truth->w_WB_B;
  } else {
    estimate_base(dt, trace);
  }
  state.rpy = rpy_from_rotation(state.R_WB);
  state.rpy.yaw = yaw_.update(state.rpy.yaw);
  for (const Leg leg : kLegs) {
    const FootState& f = trace.feet[leg];
    state.p_WF[leg] = state.p_WB + state.R_WB * f.p_BF;
    state.v_WF_W[leg] = state.v_WB_W + state.R_WB * (state.w_WB_B.cross(f.p_BF) + f.v_BF_B);
  }
  model.update(state);
  state.p_WG = model.p_WG();
  state.v_WG_W = model.v_WG_W();
}

Vec3 Localization::contact_normal(const TickTrace& trace) const {
  switch (config_.terrain.contact_normal) {
    case ContactNormal::kVertical:
      return Vec3::UnitZ();
    case ContactNormal::kPlane:
      return trace.plane.normal();
    case ContactNormal::kAuto:
      break;
  }
  return trace.ground.stepped ? Vec3(Vec3::UnitZ()) : trace.plane.normal();
}

/// The foot's contact flag once it has held for long enough; what it was before, until then.
bool Localization::debounced(const TickTrace& trace, Leg leg) noexcept {
  // Nobody knows where the foot of such a leg is.
  if (trace.encoder_stuck[leg]) return false;
  const bool before = trace.contacts[leg].measured;
  if (!trace.sensors.foot_contact) return trace.gait.leg[leg].stance;
  int& changed_for = flag_changed_for_[leg];
  changed_for = (*trace.sensors.foot_contact)[leg] == before ? 0 : changed_for + 1;
  if (changed_for < config_.estimation.contact_debounce) return before;
  changed_for = 0;
  return !before;
}

void Localization::find_contacts(TickTrace& trace) noexcept {
  const SensorReading& sensors = trace.sensors;
  const RobotState& state = trace.state;
  const Vec3 n_W = contact_normal(trace);
  for (const Leg leg : kLegs) {
    FootContact& contact = trace.contacts[leg];
    const LegPhase& phase = trace.gait.leg[leg];
    contact.measured = debounced(trace, leg);
    const bool late_in_swing =
        !phase.stance && phase.progress >= config_.gait.early_contact_progress;
    landed_early_[leg] = late_in_swing && (landed_early_[leg] ||
                                           (sensors.foot_contact.has_value() && contact.measured));
    contact.in_contact = phase.stance || landed_early_[leg];
    contact.n_W = n_W;
    contact.p_WC = foot_.contact_point(state.p_WF[leg], n_W);
    contact.v_WF_rolling_W =
        foot_.rolling_velocity(state.R_WB * (state.w_WB_B + trace.feet[leg].w_BS_B), n_W);
  }
}

}  // namespace pirouette
