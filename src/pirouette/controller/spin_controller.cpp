#include "pirouette/controller/spin_controller.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "pirouette/base/fingerprint.hpp"
#include "pirouette/base/memory.hpp"
#include "pirouette/com/com_planner.hpp"
#include "pirouette/controller/body_horizon.hpp"
#include "pirouette/controller/command_guard.hpp"
#include "pirouette/controller/foot_load.hpp"
#include "pirouette/controller/foot_planner.hpp"
#include "pirouette/controller/force_planner.hpp"
#include "pirouette/controller/gait_timing.hpp"
#include "pirouette/controller/ground_sense.hpp"
#include "pirouette/controller/gyro_watch.hpp"
#include "pirouette/controller/joint_control.hpp"
#include "pirouette/controller/lift_off_points.hpp"
#include "pirouette/controller/localization.hpp"
#include "pirouette/controller/motion_planner.hpp"
#include "pirouette/controller/sensor_guard.hpp"
#include "pirouette/controller/standing_check.hpp"
#include "pirouette/controller/standing_load.hpp"
#include "pirouette/controller/tick_clock.hpp"
#include "pirouette/foot/leg_kinematics.hpp"
#include "pirouette/model/robot_model.hpp"

namespace pirouette {

namespace {

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

PerLeg<double> foot_radii(const PerLeg<LegGeometry>& legs) {
  PerLeg<double> radii;
  for (const Leg leg : kLegs) radii[leg] = legs[leg].foot_radius;
  return radii;
}

PerLeg<double> contact_radii(const PerLeg<RollingFoot>& feet) {
  PerLeg<double> radii;
  for (const Leg leg : kLegs) radii[leg] = feet[leg].radius();
  return radii;
}

Vec2 hip_centre(const PerLeg<LegGeometry>& legs) {
  Vec2 sum = Vec2::Zero();
  for (const LegGeometry& g : legs) sum += g.p_BH.head<2>() + Vec2(0.0, g.abad_offset);
  return sum / static_cast<double>(kLegCount);
}

NominalStance nominal_stance(const BodyConfig& body, RobotModel& model) {
  NominalStance stance;
  const PerLeg<LegGeometry>& legs = model.legs();
  stance.q = nominal_posture(legs, body.height);
  stance.p_BG = model.com(stance.q);
  const Vec2 centre = hip_centre(legs);
  for (const Leg leg : kLegs) {
    const LegGeometry& g = legs[leg];
    stance.foothold_H[leg] =
        g.p_BH.head<2>() + Vec2(0.0, g.abad_offset) - centre +
        Vec2(fore_sign(leg) * body.stance_offset[0], side_sign(leg) * body.stance_offset[1]);
  }
  return stance;
}

/// m. With the point-foot model the terrain plane runs through the sphere centres.
double com_height_above_plane(const ControllerConfig& config, const PerLeg<LegGeometry>& legs) {
  const double foot_radius = legs[Leg::kFR].foot_radius;
  const double hidden_radius = foot_radius - RollingFoot(config.foot.model, foot_radius).radius();
  return config.body.height - hidden_radius;
}

ComPlannerInput com_planner_input(const RobotState& state, const GaitPhase& gait,
                                  const FootContacts& contacts, const PerLeg<Vec3>& p_WF_liftoff,
                                  const FootholdPlan& footholds, const PathPoint& path) {
  ComPlannerInput in;
  in.gait = gait;
  in.reference = path.p_WG;
  in.com = state.p_WG.head<2>();
  for (const Leg leg : kLegs) {
    in.contact[leg] = contacts[leg].p_WC.head<2>();
    in.lift_off[leg] = p_WF_liftoff[leg].head<2>();
    in.next_foothold[leg] = footholds[leg].p_WC.head<2>();
    in.touching[leg] = contacts[leg].in_contact;
  }
  return in;
}

/// Counts up when what a snapshot holds changes without a change of its size.
constexpr std::uint64_t kSnapshotVersion = 3;
constexpr std::size_t kHeaderSize = 2 * sizeof(std::uint64_t);  ///< version and checksum

std::uint64_t checksum(std::span<const std::byte> content) {
  Fingerprint sum;
  sum.add({reinterpret_cast<const char*>(content.data()), content.size()});
  return sum.value();
}

}  // namespace

/// The stages, and what is kept of the last tick. A tick reads `last` only as `last_...` of a
/// stage's input; its own values are constants of tick() until they become the next `last`.
struct SpinController::Impl {
  Impl(const ControllerConfig& c, RobotModel robot)
      : config(c),
        model(std::move(robot)),
        com_height(com_height_above_plane(c, model.legs())),
        stance(nominal_stance(c.body, model)),
        tick_clock(1.0 / c.control.rate),
        sensor_guard(c.safety, 1.0 / c.control.rate),
        standing_check(c.safety, 1.0 / c.control.rate, model.mass(), stance.p_BG, model.legs()),
        localization(c, model.legs(), model.scale()),
        gait_timing(c.gait),
        ground_sense(c.terrain, foot_radii(model.legs()), model.scale()),
        motion_planner(c.path, c.aid, c.control.rate),
        foot_planner(c.foothold, c.gait, c.body.height, localization.rolling_feet(), model.legs(),
                     stance),
        com_planner(c.com),
        force_planner(c.mpc, 1.0 / c.control.rate, c.gait.period, com_height, model.mass(),
                      model.inertia(stance.q)),
        joint_control(c.wbc, c.mpc, c.joint, model.legs(),
                      contact_radii(localization.rolling_feet()), model.scale()) {
    reset(BasePose{});
  }

  void reset(const BasePose& pose);
  void start_from(const SensorReading& first);
  const JointCommand& tick(const SensorReading& sensors, const MotionCommand& command) noexcept;

  /// A reading in the joints of LegGeometry, and a command in those of the robot's file.
  const SensorReading& from_file(const SensorReading& given) noexcept;
  const JointCommand& to_file(const JointCommand& command) noexcept;

  std::vector<std::byte> snapshot() const;
  bool restore(std::span<const std::byte> snapshot);

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [configuration, robot, height, nominal, clock, guard, check, gyro, localization_, timing_,
           load, lift_off, ground, motion, feet, com, forces, joints, start_, started_, last_, cost,
           in_, out_] = self;
    visit(clock, guard, check, gyro, localization_, timing_, load, lift_off, ground, motion, com,
          forces, joints, start_, started_, last_);
  }

  BodyReference reference(const MotionPlan& motion, const ComPlan& com_plan,
                          const TerrainPlane& plane, const RobotState& state) const;
  bool has_fallen(const RobotState& state, const TerrainPlane& plane) const;
  void stand_down(ControllerStatus why);

  ControllerConfig config;
  RobotModel model;
  double com_height;  ///< m, above the plane
  NominalStance stance;

  TickClock tick_clock;
  SensorGuard sensor_guard;
  StandingCheck standing_check;
  GyroWatch gyro_watch;
  Localization localization;
  GaitTiming gait_timing;
  FootLoad foot_load;
  LiftOffPoints lift_off_points;
  GroundSense ground_sense;
  MotionPlanner motion_planner;
  FootPlanner foot_planner;
  CentreOfMassPlanner com_planner;
  ForcePlanner force_planner;
  JointControl joint_control;

  BasePose start;
  bool started = false;
  TickTrace last;
  TickTiming timing;
  SensorReading reading_in_model;
  JointCommand command_in_file;
};

void SpinController::Impl::reset(const BasePose& pose) {
  start = pose;
  started = false;
  last = TickTrace{};
  timing = TickTiming{};
  tick_clock.reset();
  sensor_guard.reset();
  standing_check.reset();
  gyro_watch.reset();
  localization.reset(pose);
  foot_load.reset();
  gait_timing.reset();
  motion_planner.reset();
  com_planner.reset();
  force_planner.reset();
}

void SpinController::Impl::start_from(const SensorReading& first) {
  last.state = localization.start(start, first.joint_position);
  lift_off_points.start(last.state.p_WF);
  std::array<Vec3, kLegCount> contacts;
  for (const Leg leg : kLegs) {
    contacts[index(leg)] =
        localization.rolling_feet()[leg].contact_point(last.state.p_WF[leg], Vec3::UnitZ());
  }
  last.plane = ground_sense.start(contacts);
  joint_control.start(first.joint_position);
  started = true;
}

BodyReference SpinController::Impl::reference(const MotionPlan& motion, const ComPlan& com_plan,
                                              const TerrainPlane& plane,
                                              const RobotState& state) const {
  HorizonInput in;
  in.path = motion.path;
  in.twist = motion.twist;
  in.com_plan = com_plan;
  in.plane = plane;
  in.p_WG = state.p_WG.head<2>();
  in.yaw = state.rpy.yaw;
  in.com_height = com_height;
  in.max_lead = config.path.reference == PathReferenceMode::kIntegrated
                    ? config.path.max_integrated_lead
                    : config.path.max_position_lead;
  return body_reference(in);
}

bool SpinController::Impl::has_fallen(const RobotState& state, const TerrainPlane& plane) const {
  const double tilt = std::acos(std::clamp(state.R_WB.col(2).dot(plane.normal()), -1.0, 1.0));
  const double height = state.p_WG.z() - plane.height(state.p_WG.x(), state.p_WG.y());
  return tilt > config.safety.max_tilt || height < config.safety.min_height_share * com_height;
}

void SpinController::Impl::stand_down(ControllerStatus why) {
  last.status = why;
  last.command = damped_stand_down(config.joint.kd_stand);
}

const SensorReading& SpinController::Impl::from_file(const SensorReading& given) noexcept {
  SensorReading& reading = reading_in_model;
  reading = given;
  for (const Leg leg : kLegs) {
    const JointConvention& convention = model.legs()[leg].convention;
    reading.joint_position[leg] = convention.from_file(given.joint_position[leg]);
    reading.joint_velocity[leg] = convention.turned(given.joint_velocity[leg]);
  }
  return reading;
}

const JointCommand& SpinController::Impl::to_file(const JointCommand& command) noexcept {
  for (const Leg leg : kLegs) {
    const JointConvention& convention = model.legs()[leg].convention;
    LegCommand& sent = command_in_file[leg];
    sent = command[leg];
    sent.q = convention.to_file(command[leg].q);
    sent.dq = convention.turned(command[leg].dq);
    sent.tau = convention.turned(command[leg].tau);
  }
  return command_in_file;
}

const JointCommand& SpinController::Impl::tick(const SensorReading& reading,
                                               const MotionCommand& wanted) noexcept {
  if (is_stood_down(last.status)) {
    // Time goes on in the trace; everything else stays as it was when the controller stood down.
    if (std::isfinite(reading.time)) last.sensors.time = std::max(last.sensors.time, reading.time);
    return last.command;
  }
  if (!sensor_guard.update(reading, wanted, last.command, last.gait.walking)) {
    stand_down(ControllerStatus::kBadInput);
    return last.command;
  }
  const auto& [sensors, asked, encoder_stuck] = sensor_guard.input();
  const double dt = tick_clock.update(sensors.time);
  if (!started) start_from(sensors);

  const auto [state, feet, creep, tilt_bias_H] =
      localization.estimate({sensors, last.state, last.contacts, last.gait, last.plane, last.ground,
                             last.wbc.f_W, standing_check.turns(), last.command},
                            model, dt);
  if (standing_check.state() == SelfCheck::kRunning) {
    standing_check.update({sensors, feet, last.command});
  }
  const SelfCheck self_check = standing_check.state();
  // No step before it has passed.
  const MotionCommand command = self_check == SelfCheck::kRunning ? MotionCommand{} : asked;
  const std::optional<double> last_path_yaw_rate =
      motion_planner.follows_path() ? std::optional(last.path.yaw_rate) : std::nullopt;
  const auto [gait, recovering] =
      gait_timing.update({command, state.v_WG_W, last.reference.v_WG_W, last_path_yaw_rate,
                          last.gait.walking, last.ground.stepped},
                         dt);
  const std::optional<PerLeg<bool>> foot_contact =
      sensors.foot_force ? foot_load.update(*sensors.foot_force, gait, dt) : sensors.foot_contact;
  const FootContacts contacts = localization.find_contacts(
      {foot_contact, encoder_stuck, state, feet, gait, last.plane, last.ground}, dt);
  const bool gyro_agrees =
      !gait.walking || gyro_watch.update(sensors.w_WB_B, feet, contacts, encoder_stuck, dt);
  const PerLeg<Vec3>& p_WF_liftoff = lift_off_points.update(contacts, state.p_WF);
  const auto [plane, ground, remembered_treads] = ground_sense.update({contacts, gait, state}, dt);
  const MotionPlan motion = motion_planner.update({command, state, sensors.aid}, dt);

  const FootholdPlan footholds =
      foot_planner.footholds({state, gait, recovering, motion.twist, plane, ground}, ground_sense);
  const ComTarget com = com_planner.update(
      com_planner_input(state, gait, contacts, p_WF_liftoff, footholds, motion.path), dt);
  const BodyReference body = reference(motion, com.plan, plane, state);
  const PerLeg<SwingTarget> swing =
      foot_planner.swing_targets({state, gait, contacts, p_WF_liftoff, footholds, ground});

  const ContactForces mpc =
      force_planner.update({state, gait, gait_timing.clock(), contacts, plane, footholds, body});
  const auto [wbc, joints, finite] =
      joint_control.update({state, contacts, body, swing, mpc, last.command}, model, dt);

  timing = {force_planner.solve_us(), joint_control.solve_us()};
  last = {.sensors = sensors,
          .encoder_stuck = encoder_stuck,
          .status = gait.walking ? ControllerStatus::kWalking : ControllerStatus::kStanding,
          .self_check = self_check,
          .state = state,
          .feet = feet,
          .contacts = contacts,
          .flag_dropped = localization.dropped_flags(),
          .plane = plane,
          .ground = ground,
          .remembered_treads = remembered_treads,
          .creep = creep,
          .tilt_bias_H = tilt_bias_H,
          .aid_offset = motion.aid_offset,
          .gait = gait,
          .path = motion.path,
          .twist = motion.twist,
          .integral_H = motion.integral_H,
          .footholds = footholds,
          .com_plan = com.plan,
          .psp_weight = com.weight,
          .reference = body,
          .swing = swing,
          .mpc = mpc,
          .wbc = wbc,
          .command = joints};

  if (self_check == SelfCheck::kRunning) {
    // Nothing of this tick is trusted yet but the joint angles.
    last.command = standing_check.command();
    return last.command;
  }
  if (!finite) stand_down(ControllerStatus::kBadCommand);
  if (force_planner.failures() > config.safety.max_solver_failures ||
      joint_control.failures() > ticks_in(config.safety.max_hold_time, 1.0 / config.control.rate)) {
    stand_down(ControllerStatus::kSolverFailed);
  }
  if (!gyro_agrees) stand_down(ControllerStatus::kGyroAgainstLegs);
  if (has_fallen(state, plane)) stand_down(ControllerStatus::kFallen);
  if (has_failed(self_check)) stand_down(ControllerStatus::kCheckFailed);
  return last.command;
}

std::vector<std::byte> SpinController::Impl::snapshot() const {
  std::vector<std::byte> out;
  MemoryWriter write(out);
  write(kSnapshotVersion, std::uint64_t{0});
  memory(*this, write);
  const std::uint64_t sum = checksum(std::span<const std::byte>(out).subspan(kHeaderSize));
  std::memcpy(out.data() + sizeof kSnapshotVersion, &sum, sizeof sum);
  return out;
}

bool SpinController::Impl::restore(std::span<const std::byte> snapshot) {
  if (snapshot.size() < kHeaderSize) return false;
  std::uint64_t version = 0, sum = 0;
  MemoryReader header(snapshot.first(kHeaderSize));
  header(version, sum);
  const std::span<const std::byte> content = snapshot.subspan(kHeaderSize);
  if (version != kSnapshotVersion || sum != checksum(content)) return false;

  std::vector<std::byte> before;
  MemoryWriter keep(before);
  memory(*this, keep);
  MemoryReader read(content);
  memory(*this, read);
  if (read.complete()) return true;
  MemoryReader back(before);
  memory(*this, back);
  return false;
}

Result<SpinController> SpinController::create(const ControllerConfig& config,
                                              const RobotDescription& robot) {
  Result<RobotModel> model = RobotModel::load(robot);
  if (!model.ok()) return model.errors();
  Errors errors = check_standing(config, model.value());
  if (!errors.empty()) return errors;
  return SpinController(std::make_unique<Impl>(config, std::move(model).value()));
}

SpinController::SpinController(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SpinController::SpinController(SpinController&&) noexcept = default;
SpinController& SpinController::operator=(SpinController&&) noexcept = default;
SpinController::~SpinController() = default;

void SpinController::reset(const BasePose& start) { impl_->reset(start); }
void SpinController::follow(std::optional<Path> path) {
  impl_->motion_planner.follow(std::move(path));
}
std::vector<std::byte> SpinController::snapshot() const { return impl_->snapshot(); }
bool SpinController::restore(std::span<const std::byte> snapshot) {
  return impl_->restore(snapshot);
}
ControllerStatus SpinController::status() const noexcept { return impl_->last.status; }
const RobotState* SpinController::estimate() const noexcept { return &impl_->last.state; }
const TickTrace& SpinController::trace() const { return impl_->last; }
const TickTiming& SpinController::timing() const { return impl_->timing; }

const JointCommand& SpinController::tick(const SensorReading& sensors,
                                         const MotionCommand& command) noexcept {
  return impl_->to_file(impl_->tick(impl_->from_file(sensors), command));
}

}  // namespace pirouette
