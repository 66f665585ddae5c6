#include "pirouette/controller/spin_controller.hpp"

#include <chrono>

#include "pirouette/com/com_planner.hpp"
#include "pirouette/controller/body_horizon.hpp"
#include "pirouette/controller/command_guard.hpp"
#include "pirouette/controller/ground_sense.hpp"
#include "pirouette/controller/localization.hpp"
#include "pirouette/controller/push_recovery.hpp"
#include "pirouette/controller/sensor_guard.hpp"
#include "pirouette/foot/leg_kinematics.hpp"
#include "pirouette/gait/foothold_planner.hpp"
#include "pirouette/gait/gait_clock.hpp"
#include "pirouette/lowlevel/convex_mpc.hpp"
#include "pirouette/lowlevel/swing_leg.hpp"
#include "pirouette/lowlevel/whole_body_control.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/path/path_reference.hpp"
#include "pirouette/path/position_aid.hpp"
#include "pirouette/path/tracker.hpp"

namespace pirouette {

namespace {

using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// Joint angles with every foot below its hip, CoM (taken at the trunk origin) at the working
/// height.
PerLeg<Vec3> nominal_posture(const PerLeg<LegGeometry>& legs, double com_height) {
  PerLeg<Vec3> q;
  for (const Leg leg : kLegs) {
    const LegGeometry& g = legs[leg];
    const Vec3 p_HF(0.0, g.abad_offset, g.foot_radius - com_height - g.p_BH.z());
    q[leg] = inverse_kinematics(g, p_HF).q;
  }
  return q;
}

Vec2 hip_centre(const PerLeg<LegGeometry>& legs) {
  Vec2 sum = Vec2::Zero();
  for (const LegGeometry& g : legs) sum += g.p_BH.head<2>() + Vec2(0.0, g.abad_offset);
  return sum / static_cast<double>(kLegCount);
}

}  // namespace

struct SpinController::Impl {
  Impl(const ControllerConfig& c, RobotModel robot)
      : config(c),
        model(std::move(robot)),
        legs(model.legs()),
        posture(nominal_posture(legs, c.body.height)),
        sensor_guard(c.safety, 1.0 / c.control.rate),
        localization(c, legs),
        ground(c.terrain, legs[Leg::kFR].foot_radius),
        push_recovery(c.gait),
        clock(c.gait),
        aid_offset(c.aid),
        path_reference(c.path),
        tracker(c.path, c.control.rate),
        foothold_planner(c.foothold),
        com_planner(c.com),
        mpc(c.mpc, model.mass(), model.inertia(posture)),
        wbc(c.wbc, c.mpc),
        guard(c.joint, legs) {
    p_BG_nominal = model.com(posture);
    const Vec2 centre = hip_centre(legs);
    for (const Leg leg : kLegs) {
      const LegGeometry& g = legs[leg];
      nominal_H[leg] =
          g.p_BH.head<2>() + Vec2(0.0, g.abad_offset) - centre +
          Vec2(fore_sign(leg) * c.body.stance_offset[0], side_sign(leg) * c.body.stance_offset[1]);
    }
    reset(BasePose{});
  }

  void reset(const BasePose& pose);
  void start_from_first_reading();
  double measured_period(const SensorReading& sensors) const;

  // The stages of a tick, in their order.
  void follow_contacts();
  void set_gait(const MotionCommand& command, double dt);
  void plan_body(const MotionCommand& command, double dt);
  void plan_feet(double dt);
  void solve_mpc();
  void solve_whole_body(double dt);

  double swing_height() const;
  Vec3 friction_torque(Leg leg, const Vec3& dq) const;
  double com_height_above_plane() const;
  MpcInput mpc_input() const;
  bool has_fallen() const;
  void stand_down(ControllerStatus why);

  ControllerConfig config;
  RobotModel model;
  PerLeg<LegGeometry> legs;
  PerLeg<Vec3> posture;  ///< rad, nominal joint angles
  Vec3 p_BG_nominal;
  PerLeg<Vec2> nominal_H{};  ///< m, footholds from the CoM

  SensorGuard sensor_guard;
  Localization localization;
  GroundSense ground;
  PushRecovery push_recovery;
  GaitClock clock;
  PositionAidOffset aid_offset;
  PathReference path_reference;
  Tracker tracker;
  FootholdPlanner foothold_planner;
  CentreOfMassPlanner com_planner;
  ConvexMpc mpc;
  WholeBodyControl wbc;
  CommandGuard guard;

  BasePose start;
  bool started = false;
  bool recovering = false;  ///< from a push
  int mpc_failures = 0;     ///< solutions in a row
  int wbc_failures = 0;
  int ticks_until_mpc = 0;
  PerLeg<bool> solved_contacts{};  ///< contact set of the last MPC solution
  PerLeg<bool> was_in_contact{};
  PerLeg<Vec3> p_WF_liftoff{};
  ContactForces last_forces;

  TickTrace trace;
  TickTiming timing;
};

void SpinController::Impl::reset(const BasePose& pose) {
  start = pose;
  started = recovering = false;
  trace = TickTrace{};
  timing = TickTiming{};
  mpc_failures = wbc_failures = ticks_until_mpc = 0;
  was_in_contact = {};
  last_forces = ContactForces{};
  sensor_guard.reset();
  localization.reset(pose);
  push_recovery.reset();
  clock.reset();
  aid_offset.reset();
  path_reference.reset();
  tracker.reset();
  com_planner.reset();
}

void SpinController::Impl::start_from_first_reading() {
  const SensorReading& first = sensor_guard.input().sensors;
  for (const Leg leg : kLegs) {
    trace.feet[leg] = foot_state(legs[leg], first.joint_position[leg], first.joint_velocity[leg]);
  }
  localization.start(start, trace);
  p_WF_liftoff = trace.state.p_WF;
  std::array<Vec3, kLegCount> contacts;
  for (const Leg leg : kLegs) {
    contacts[index(leg)] = localization.foot().contact_point(p_WF_liftoff[leg], Vec3::UnitZ());
  }
  trace.plane = ground.start(contacts);
  guard.reset(first.joint_position);
  started = true;
}

double SpinController::Impl::measured_period(const SensorReading& sensors) const {
  const double nominal = 1.0 / config.control.rate;
  if (!started) return nominal;
  return std::clamp(sensors.time - trace.sensors.time, 0.5 * nominal, 10.0 * nominal);
}

/// With the point-foot model the terrain plane runs through the sphere centres.
double SpinController::Impl::com_height_above_plane() const {
  const double hidden_radius = legs[Leg::kFR].foot_radius - localization.foot().radius();
  return config.body.height - hidden_radius;
}

/// Duty and stride by rule: the yaw rate shortens the stride, steps lengthen the stance; both take
/// effect at the next touchdown. A push shortens the stride at once, and sets the feet on the
/// capture point (plan_feet).
void SpinController::Impl::set_gait(const MotionCommand& command, double dt) {
  const GaitConfig& gait = config.gait;
  const bool careful = gait.adapt && trace.ground.stepped;
  const Vec2 v_error = (trace.state.v_WG_W - trace.reference.v_WG_W).head<2>();
  recovering = push_recovery.update(v_error, dt) && trace.gait.walking && gait.adapt && !careful;
  const double yaw_rate = path_reference.follows_path() ? trace.path.yaw_rate : command.yaw_rate;
  const double stride = recovering ? gait.recovery_period_at(yaw_rate) : gait.period_at(yaw_rate);
  clock.set_timing(stride, careful ? gait.step_duty_at(stride) : gait.duty);
  if (recovering) clock.hurry();
  trace.gait = clock.update(command.walk, dt);
  trace.status = trace.gait.walking ? ControllerStatus::kWalking : ControllerStatus::kStanding;
}

double SpinController::Impl::swing_height() const {
  const GaitConfig& gait = config.gait;
  if (!gait.adapt || !trace.ground.stepped) return gait.swing_height;
  const double over_steps = trace.ground.step_height + gait.step_clearance;
  return std::clamp(over_steps, gait.swing_height,
                    std::max(gait.swing_height, gait.max_swing_height));
}

void SpinController::Impl::follow_contacts() {
  for (const Leg leg : kLegs) {
    const bool in_contact = trace.contacts[leg].in_contact;
    if (was_in_contact[leg] && !in_contact) p_WF_liftoff[leg] = trace.state.p_WF[leg];
    was_in_contact[leg] = in_contact;
  }
}

void SpinController::Impl::plan_body(const MotionCommand& command, double dt) {
  trace.aid_offset =
      aid_offset.update(trace.sensors.aid, trace.state.p_WB.head<2>(), trace.state.time, dt);
  // The set-point lives in the aid's frame, everything else in the odometry's.
  RobotState in_aid_frame = trace.state;
  in_aid_frame.p_WG.head<2>() += trace.aid_offset;
  trace.path = path_reference.update(command, in_aid_frame, dt);
  trace.path.p_WG -= trace.aid_offset;
  trace.twist = tracker.update(trace.path, trace.state, dt);
  trace.integral_H = tracker.integral_H();
}

void SpinController::Impl::plan_feet(double dt) {
  const RobotState& state = trace.state;
  FootholdInput in;
  in.gait = trace.gait;
  in.nominal_H = nominal_H;
  const RollingFoot& foot = localization.foot();
  in.centre_offset = foot.centre_offset();
  in.p_WG = state.p_WG.head<2>();
  in.v_WG_H = rot2(state.rpy.yaw).transpose() * state.v_WG_W.head<2>();
  in.yaw = state.rpy.yaw;
  if (recovering) in.capture_time = std::sqrt(config.body.height / kGravity);
  in.twist = trace.twist;
  in.plane = trace.plane;
  if (config.foothold.rolling_compensation && foot.radius() > 0.0) {
    StanceMotion motion;
    motion.p_BG = p_BG_nominal;
    motion.R_HB = rotation_from_rpy({state.rpy.roll, state.rpy.pitch, 0.0});
    motion.n_H = rot_z(state.rpy.yaw).transpose() * trace.plane.normal();
    motion.twist = trace.twist;
    motion.duration = trace.gait.stance_duration;
    for (const Leg leg : kLegs) {
      motion.p_BF = legs[leg].p_BH + foot_position_H(legs[leg], posture[leg]);
      in.rolling_shift_H[leg] = 0.5 * foot.stance_travel(legs[leg], motion).head<2>();
    }
  }
  trace.footholds = foothold_planner.update(in);
  if (trace.ground.stepped) {
    for (Foothold& foothold : trace.footholds)
      foothold = ground.adapted(foothold, foot.centre_offset());
  }

  ComPlannerInput com;
  com.gait = trace.gait;
  com.reference = trace.path.p_WG;
  com.com = state.p_WG.head<2>();
  for (const Leg leg : kLegs) {
    com.contact[leg] = trace.contacts[leg].p_WC.head<2>();
    com.lift_off[leg] = p_WF_liftoff[leg].head<2>();
    com.next_foothold[leg] = trace.footholds[leg].p_WC.head<2>();
    com.touching[leg] = trace.contacts[leg].in_contact;
  }
  const ComTarget target = com_planner.update(com, dt);
  trace.com_plan = target.plan;
  trace.psp_weight = target.weight;

  HorizonInput horizon;
  horizon.path = trace.path;
  horizon.twist = trace.twist;
  horizon.com_plan = trace.com_plan;
  horizon.plane = trace.plane;
  horizon.p_WG = com.com;
  horizon.yaw = state.rpy.yaw;
  horizon.com_height = com_height_above_plane();
  horizon.max_lead = config.path.reference == PathReferenceMode::kIntegrated
                         ? config.path.max_integrated_lead
                         : config.path.max_position_lead;
  trace.reference = body_reference(horizon);

  for (const Leg leg : kLegs) {
    const LegPhase& phase = trace.gait.leg[leg];
    if (trace.contacts[leg].in_contact) {
      trace.swing[leg] = {state.p_WF[leg], trace.contacts[leg].v_WF_rolling_W, Vec3::Zero()};
      continue;
    }
    trace.swing[leg] = swing_target({p_WF_liftoff[leg], trace.footholds[leg].p_WF, phase.progress,
                                     phase.duration, swing_height()});
  }
}

MpcInput SpinController::Impl::mpc_input() const {
  const RobotState& state = trace.state;
  MpcInput in;
  const double stride = trace.gait.stance_duration + trace.gait.swing_duration;
  in.dt = config.mpc.step_share * (trace.gait.walking ? stride : config.gait.period);
  in.n_W = trace.contacts[Leg::kFR].n_W;
  in.now.rpy = Vec3(state.rpy.roll, state.rpy.pitch, state.rpy.yaw);
  in.now.p_WG = state.p_WG;
  in.now.v_WG_W = state.v_WG_W;
  in.now.w_WB_W = state.w_WB_W();
  const double height = com_height_above_plane();
  for (int k = 0; k < config.mpc.horizon; ++k) {
    MpcStep& step = in.steps[static_cast<size_t>(k)];
    const double middle = (k + 0.5) * in.dt;
    const BodyMotion mid = reference_after(trace.reference, trace.plane, height, middle);
    step.reference = reference_after(trace.reference, trace.plane, height, (k + 1) * in.dt);
    step.rpy_mid = {mid.rpy.x(), mid.rpy.y(), mid.rpy.z()};
    step.p_WG_mid = mid.p_WG;
    for (const Leg leg : kLegs) {
      const LegPhase ahead = clock.phase_at(leg, middle);
      const bool same_stance =
          trace.contacts[leg].in_contact && ahead.stride == trace.gait.leg[leg].stride;
      step.stance[leg] = k == 0 ? trace.contacts[leg].in_contact : ahead.stance;
      step.p_WC[leg] = same_stance ? trace.contacts[leg].p_WC : trace.footholds[leg].p_WC;
    }
  }
  return in;
}

void SpinController::Impl::solve_mpc() {
  PerLeg<bool> contacts{};
  bool changed = false;
  for (const Leg leg : kLegs) {
    contacts[leg] = trace.contacts[leg].in_contact;
    changed = changed || contacts[leg] != solved_contacts[leg];
  }
  timing.mpc_us = 0.0;
  if (ticks_until_mpc-- > 0 && !changed) {
    trace.mpc = last_forces;
    return;
  }
  ticks_until_mpc = config.mpc.ticks_per_solve - 1;
  solved_contacts = contacts;
  const auto begin = Clock::now();
  const ContactForces forces = mpc.update(mpc_input());
  timing.mpc_us = microseconds_since(begin);
  if (forces.status == SolveStatus::kFailed) {
    ++mpc_failures;
    last_forces.status = SolveStatus::kHeld;
  } else {
    mpc_failures = 0;
    last_forces = forces;
  }
  trace.mpc = last_forces;
}

void SpinController::Impl::solve_whole_body(double dt) {
  const auto begin = Clock::now();
  WbcInput in;
  in.state = trace.state;
  in.reference = trace.reference;
  in.swing = trace.swing;
  in.contacts = trace.contacts;
  in.mpc = trace.mpc;
  in.contact_radius = localization.foot().radius();
  in.n_W = trace.contacts[Leg::kFR].n_W;
  const WbcOutput out = wbc.update(in, model);
  timing.wbc_us = microseconds_since(begin);

  trace.wbc = out.forces;
  if (out.forces.status == SolveStatus::kFailed) {
    // The previous command stands for this tick.
    ++wbc_failures;
    trace.wbc.status = SolveStatus::kHeld;
    return;
  }
  wbc_failures = 0;
  JointCommand raw;
  for (const Leg leg : kLegs) {
    const bool stance = trace.contacts[leg].in_contact;
    LegCommand& c = raw[leg];
    c.q = out.q[leg];
    c.dq = out.dq[leg];
    c.tau = out.tau[leg] + friction_torque(leg, out.dq[leg]);
    c.kp.setConstant(stance ? config.joint.kp_stance : config.joint.kp_swing);
    c.kd.setConstant(stance ? config.joint.kd_stance : config.joint.kd_swing);
  }
  if (!guard.update(raw, dt, trace.command)) stand_down(ControllerStatus::kBadCommand);
}

/// N m, to overcome the joints' own friction at the commanded rates, whose sign noise does not
/// flip.
Vec3 SpinController::Impl::friction_torque(Leg leg, const Vec3& dq) const {
  constexpr double kSmoothRate = 0.05;  // rad/s
  const LegGeometry& g = legs[leg];
  const Vec3 direction = (dq / kSmoothRate).array().tanh();
  return config.joint.friction_compensation *
         (g.dry_friction.cwiseProduct(direction) + g.damping.cwiseProduct(dq));
}

bool SpinController::Impl::has_fallen() const {
  const RobotState& state = trace.state;
  const double tilt = std::acos(std::clamp(state.R_WB.col(2).dot(trace.plane.normal()), -1.0, 1.0));
  const double height = state.p_WG.z() - trace.plane.height(state.p_WG.x(), state.p_WG.y());
  return tilt > config.safety.max_tilt ||
         height < config.safety.min_height_share * com_height_above_plane();
}

void SpinController::Impl::stand_down(ControllerStatus why) {
  trace.status = why;
  trace.command = damped_stand_down(config.joint.kd_stand);
}

Result<SpinController> SpinController::create(const ControllerConfig& config,
                                              const std::string& mjcf) {
  Result<RobotModel> model = RobotModel::load(mjcf);
  if (!model.ok()) return model.errors();
  return SpinController(std::make_unique<Impl>(config, std::move(model).value()));
}

SpinController::SpinController(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SpinController::SpinController(SpinController&&) noexcept = default;
SpinController& SpinController::operator=(SpinController&&) noexcept = default;
SpinController::~SpinController() = default;

void SpinController::reset(const BasePose& start) { impl_->reset(start); }
void SpinController::follow(std::optional<Path> path) {
  impl_->path_reference.follow(std::move(path));
}
ControllerStatus SpinController::status() const noexcept { return impl_->trace.status; }
const RobotState* SpinController::estimate() const noexcept { return &impl_->trace.state; }
std::optional<double> SpinController::path_progress() const noexcept {
  return impl_->trace.path.arc_length;
}
const TickTrace& SpinController::trace() const { return impl_->trace; }
const TickTiming& SpinController::timing() const { return impl_->timing; }

const JointCommand& SpinController::tick(const SensorReading& sensors,
                                         const MotionCommand& command) noexcept {
  Impl& s = *impl_;
  TickTrace& t = s.trace;
  if (is_stood_down(t.status)) return t.command;
  if (!s.sensor_guard.update(sensors, command, t.command, t.gait.walking)) {
    s.stand_down(ControllerStatus::kBadInput);
    return t.command;
  }
  const GuardedInput& in = s.sensor_guard.input();
  const double dt = s.measured_period(in.sensors);
  if (!s.started) s.start_from_first_reading();
  t.sensors = in.sensors;
  t.encoder_stuck = in.encoder_stuck;

  s.localization.estimate(s.model, dt, t);
  s.set_gait(in.command, dt);
  s.localization.find_contacts(t);
  s.follow_contacts();
  s.ground.update(dt, t);
  s.plan_body(in.command, dt);
  s.plan_feet(dt);
  s.solve_mpc();
  s.solve_whole_body(dt);

  if (std::max(s.mpc_failures, s.wbc_failures) > s.config.safety.max_solver_failures) {
    s.stand_down(ControllerStatus::kSolverFailed);
  }
  if (s.has_fallen()) s.stand_down(ControllerStatus::kFallen);
  return t.command;
}

}  // namespace pirouette
