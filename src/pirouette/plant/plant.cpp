#include "pirouette/plant/plant.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "pirouette/base/random.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/base/stopwatch.hpp"
#include "pirouette/plant/faults.hpp"
#include "pirouette/plant/scene.hpp"
#include "pirouette/plant/sensors.hpp"
#include "pirouette/plant/spawn.hpp"
#include "pirouette/plant/terrain.hpp"

namespace pirouette {
namespace {

constexpr double kDivergedState = 1e6;  ///< m, rad, m/s or rad/s: no robot gets there
constexpr double kWholeStepTolerance =
    1e-6;  ///< of a ratio of two durations that must be an integer
constexpr std::size_t kTimedSteps = 8192;
constexpr double kStartMargin = 1.0;  ///< m, of ground around the start

Eigen::Map<const Vec3> at(const mjtNum* array, int element) {
  return Eigen::Map<const Vec3>(array + 3 * element);
}

/// The last `kTimedSteps` durations of a physics step.
class StepTimes {
 public:
  StepTimes() { microseconds_.reserve(kTimedSteps); }

  void add(double microseconds) {
    if (microseconds_.size() < kTimedSteps) {
      microseconds_.push_back(microseconds);
    } else {
      microseconds_[next_] = microseconds;
      next_ = (next_ + 1) % kTimedSteps;
    }
  }

  double median() const {
    if (microseconds_.empty()) return 0.0;
    std::vector<double> sorted = microseconds_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

 private:
  std::vector<double> microseconds_;
  std::size_t next_ = 0;
};

/// Hands out the command of a fixed number of physics steps ago; before the first one arrives the
/// motors are limp.
class CommandDelay {
 public:
  explicit CommandDelay(std::size_t steps) : queue_(steps + 1) {}

  const JointCommand& pass(const JointCommand& command) {
    queue_[oldest_] = command;
    oldest_ = (oldest_ + 1) % queue_.size();
    return queue_[oldest_];
  }

 private:
  std::vector<JointCommand> queue_;
  std::size_t oldest_ = 0;
};

bool is_sound(const mjModel& model, const mjData& data) {
  const auto within = [](const mjtNum* values, int count) {
    // Written so that NaN is out.
    return std::all_of(values, values + count,
                       [](double x) { return std::abs(x) < kDivergedState; });
  };
  const bool warned = std::any_of(data.warning, data.warning + mjNWARNING,
                                  [](const auto& w) { return w.number > 0; });
  return !warned && within(data.qpos, model.nq) && within(data.qvel, model.nv);
}

/// What the truth says after the simulation broke down: no number at all.
PlantTruth lost_truth(double time) {
  const Vec3 lost = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  PlantTruth truth;
  truth.time = time;
  truth.base = {lost, lost.replicate<1, 3>(), lost, lost};
  truth.a_WB_W = truth.p_WG = truth.v_WG_W = truth.ground_normal_W = lost;
  truth.ground_height = lost.x();
  truth.joint_position = truth.joint_velocity = truth.joint_torque = PerLeg<Vec3>::filled(lost);
  truth.p_WF = truth.f_W = truth.v_slip_W = PerLeg<Vec3>::filled(lost);
  return truth;
}

/// Each motor's torque constant over the nominal one, of this seed.
PerLeg<Vec3> draw_torque_scales(const WorldConfig& config, std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::kTorqueConstants);
  PerLeg<Vec3> scales;
  for (const Leg leg : kLegs) {
    for (double& scale : scales[leg]) {
      const double deviation = config.torque_scale_spread * (2.0 * random.uniform() - 1.0);
      scale = config.torque_scale * (1.0 + deviation);
    }
  }
  return scales;
}

/// `duration` in whole periods, or nothing if it is not a whole number of them.
std::optional<std::size_t> whole_periods(double duration, double period) {
  const double ratio = duration / period;
  const double rounded = std::round(ratio);
  if (std::abs(ratio - rounded) > kWholeStepTolerance * std::max(1.0, rounded)) return std::nullopt;
  return static_cast<std::size_t>(rounded);
}

}  // namespace

std::string physics_version() { return mj_versionString(); }

struct Plant::Impl {
  Impl(const WorldConfig& config, const PlantSetup& setup, const Terrain& ground, Scene scene,
       std::size_t delay, std::size_t steps)
      : terrain(ground),
        model(std::move(scene.model)),
        map(scene.map),
        data(mj_makeData(model.get())),
        sensors(config.sensors, setup.seed, setup.period),
        faults(config.faults, setup.seed, setup.period),
        command_delay(delay),
        steps_per_tick(steps),
        friction(config.friction),
        torque_scale(draw_torque_scales(config, setup.seed)),
        shows_truth(setup.shows_truth) {}

  /// Motor torques of `command` at the present joint state, into `truth` and the simulation.
  void drive_motors(const JointCommand& command);
  void step(const JointCommand& command);
  void push(const Vec3& delta_v_W);
  /// The first half of a physics step: positions, velocities and contacts of the present state.
  void begin_step();
  /// Refreshes `truth`: forces and accelerations of this very moment, under the command in force.
  void observe();
  void observe_foot(Leg leg);
  double period() const { return static_cast<double>(steps_per_tick) * model->opt.timestep; }

  Terrain terrain;
  ModelPtr model;
  RobotMap map;
  DataPtr data;
  Sensors sensors;
  Faults faults;
  CommandDelay command_delay;
  std::size_t steps_per_tick;
  double friction;            ///< sliding, where the terrain has none of its own
  PerLeg<Vec3> torque_scale;  ///< true over nominal torque constant: abad, hip, knee
  bool shows_truth;           ///< the controller was configured to use it

  MotorHealth motors;
  JointCommand sent;  ///< the last one that was not lost
  JointCommand command_in_force;
  PlantTruth truth;
  PerLeg<double> normal_force{};  ///< N, on each foot
  StepTimes step_times;
  std::int64_t ticks = 0;
  bool diverged = false;
};

void Plant::Impl::drive_motors(const JointCommand& command) {
  for (const Leg leg : kLegs) {
    const LegMap& at_leg = map.legs[leg];
    const LegCommand& wanted = command[leg];
    Vec3 q, dq;
    for (int i = 0; i < 3; ++i) {
      q[i] = data->qpos[at_leg.qpos[static_cast<std::size_t>(i)]];
      dq[i] = data->qvel[at_leg.dof[static_cast<std::size_t>(i)]];
    }
    const Vec3 scale = torque_scale[leg].cwiseProduct(motors.torque[leg]);
    const Vec3 demand = scale.cwiseProduct(wanted.torque(q, dq));
    diverged = diverged || !demand.allFinite();
    if (diverged) return;
    const Vec3 limit = motors.torque_limit * at_leg.tau_max;
    const Vec3 torque = demand.cwiseMax(-limit).cwiseMin(limit);
    truth.joint_torque[leg] = torque;
    for (int i = 0; i < 3; ++i)
      data->qfrc_applied[at_leg.dof[static_cast<std::size_t>(i)]] = torque[i];
  }
}

void Plant::Impl::begin_step() {
  set_foot_friction(terrain, friction, map, *data, *model);
  mj_step1(model.get(), data.get());
}

void Plant::Impl::step(const JointCommand& command) {
  const Stopwatch watch;
  command_in_force = command_delay.pass(command);
  drive_motors(command_in_force);
  if (diverged) return;
  // The second half of a step ends at the new state; the first half prepares it for the motors'
  // next look.
  mj_step2(model.get(), data.get());
  diverged = !is_sound(*model, *data);
  if (diverged) return;
  begin_step();
  step_times.add(watch.microseconds());
}

void Plant::Impl::push(const Vec3& delta_v_W) {
  Eigen::Map<Vec3>(data->qvel + map.trunk_dof) += delta_v_W;
  diverged = !is_sound(*model, *data);
  if (!diverged) begin_step();
}

void Plant::Impl::observe_foot(Leg leg) {
  const int foot = map.legs[leg].foot_geom;
  const Vec3 p_WF = at(data->geom_xpos, foot);
  Vec3 force = Vec3::Zero();
  Vec3 weighted_point = Vec3::Zero();
  double pressing = 0.0;
  for (int i = 0; i < data->ncon; ++i) {
    const mjContact& contact = data->contact[i];
    if (contact.geom[0] != foot && contact.geom[1] != foot) continue;
    Vec6 wrench_C;  // on geom[1], in contact axes of which x is the normal towards geom[1]
    mj_contactForce(model.get(), data.get(), i, wrench_C.data());
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_CW(contact.frame);
    const double sign = contact.geom[1] == foot ? 1.0 : -1.0;
    force += sign * (R_CW.transpose() * wrench_C.head<3>());
    pressing += wrench_C[0];
    weighted_point += wrench_C[0] * Eigen::Map<const Vec3>(contact.pos);
  }
  normal_force[leg] = pressing;
  truth.p_WF[leg] = p_WF;
  truth.f_W[leg] = force;
  truth.contact[leg] = pressing > 0.0;
  truth.v_slip_W[leg].setZero();
  if (!truth.contact[leg]) return;

  Vec6 twist;  // of the foot at its centre, world axes: angular, then linear
  mj_objectVelocity(model.get(), data.get(), mjOBJ_GEOM, foot, twist.data(), /*flg_local=*/0);
  const Vec3 p_WC = weighted_point / pressing;
  truth.v_slip_W[leg] = twist.tail<3>() + twist.head<3>().cross(p_WC - p_WF);
}

void Plant::Impl::observe() {
  if (!diverged) drive_motors(command_in_force);
  if (diverged) {
    truth = lost_truth(truth.time);
    normal_force = {};
    return;
  }
  mj_fwdAcceleration(model.get(), data.get());
  mj_fwdConstraint(model.get(), data.get());
  mj_subtreeVel(model.get(), data.get());

  const mjtNum* velocity = data->qvel + map.trunk_dof;
  truth.base.p_WB = at(data->xpos, map.trunk_body);
  truth.base.R_WB = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      data->xmat + 9 * map.trunk_body);
  truth.base.v_WB_W = Eigen::Map<const Vec3>(velocity);
  truth.base.w_WB_B = Eigen::Map<const Vec3>(velocity + 3);
  truth.a_WB_W = Eigen::Map<const Vec3>(data->qacc + map.trunk_dof);
  truth.p_WG = at(data->subtree_com, map.trunk_body);
  truth.v_WG_W = at(data->subtree_linvel, map.trunk_body);
  truth.ground_height = terrain.height(truth.p_WG.head<2>());
  truth.ground_normal_W = terrain.normal();
  for (const Leg leg : kLegs) {
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      truth.joint_position[leg][static_cast<Eigen::Index>(i)] = data->qpos[map.legs[leg].qpos[i]];
      truth.joint_velocity[leg][static_cast<Eigen::Index>(i)] = data->qvel[map.legs[leg].dof[i]];
    }
    observe_foot(leg);
  }
}

Errors Plant::check(const WorldConfig& config, const PlantSetup& setup) {
  Errors errors;
  const Result<TerrainSpec> spec = parse_terrain(config.terrain);
  if (!spec) errors = spec.errors();
  const std::optional<std::size_t> steps = whole_periods(setup.period, config.timestep);
  if (!steps || *steps == 0) {
    errors.push_back({"", 0, "plant.timestep", "must divide the control period, 1 / control.rate"});
  }
  const std::optional<std::size_t> delay = whole_periods(config.command_latency, config.timestep);
  if (!delay) {
    errors.push_back({"", 0, "plant.command_latency",
                      "must be a whole number of physics steps, plant.timestep"});
  }
  if (!spec) return errors;
  const double extent = half_extent(spec.value());
  if (setup.start.cwiseAbs().maxCoeff() > extent - kStartMargin) {
    errors.push_back({"", 0, "run.start_offset",
                      "the start is nearer than 1 m to the edge of this terrain, which ends " +
                          std::to_string(extent) + " m from the origin"});
  }
  return errors;
}

Result<Plant> Plant::create(const WorldConfig& config, const PlantSetup& setup) {
  Errors errors = check(config, setup);
  if (!errors.empty()) return errors;
  const std::size_t steps = whole_periods(setup.period, config.timestep).value();
  const std::size_t delay = whole_periods(config.command_latency, config.timestep).value();
  const Terrain terrain(parse_terrain(config.terrain).value(), setup.seed);
  Result<Scene> scene = build_scene(config, terrain, setup.robot);
  if (!scene) return scene.errors();

  auto impl =
      std::make_unique<Impl>(config, setup, terrain, std::move(scene).value(), delay, steps);
  errors = stand_robot(*impl->model, impl->map, terrain, setup.start, setup.start_yaw,
                       setup.com_height, *impl->data);
  if (!errors.empty()) return errors;
  impl->begin_step();
  impl->observe();
  return Plant(std::move(impl));
}

Plant::Plant(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Plant::Plant(Plant&&) noexcept = default;
Plant& Plant::operator=(Plant&&) noexcept = default;
Plant::~Plant() = default;

SensorReading Plant::sense() {
  SensorReading reading = impl_->sensors.sample(impl_->truth, impl_->normal_force);
  impl_->faults.spoil(reading);
  if (impl_->shows_truth) reading.truth = impl_->truth.base;
  return reading;
}

const PlantTruth& Plant::truth() const { return impl_->truth; }

void Plant::advance(const JointCommand& command) {
  Impl& s = *impl_;
  const double now = s.truth.time;
  s.motors = s.faults.motors(now);
  if (!s.faults.loses_command(now)) s.sent = command;
  const std::optional<Vec3> delta_v_W =
      s.faults.push(now, rpy_from_rotation(s.truth.base.R_WB).yaw);
  if (delta_v_W && !s.diverged) s.push(*delta_v_W);
  for (std::size_t i = 0; i < s.steps_per_tick && !s.diverged; ++i) s.step(s.sent);
  s.observe();
  s.truth.time = static_cast<double>(++s.ticks) * s.period();
}

void Plant::push(const Vec3& delta_v_W) {
  if (impl_->diverged) return;
  impl_->push(delta_v_W);
  impl_->observe();
}

void Plant::set_friction(double friction) { impl_->friction = friction; }

double Plant::period() const { return impl_->period(); }

double Plant::physics_step_us_median() const { return impl_->step_times.median(); }

}  // namespace pirouette
