#include "pirouette/trial/trial.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include "pirouette/config/path_file.hpp"
#include "pirouette/config/validate.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/trial/run_folder.hpp"
#include "pirouette/plant/plant.hpp"

#ifndef PIROUETTE_VERSION
#define PIROUETTE_VERSION "unknown"
#endif
#ifndef PIROUETTE_COMMIT
#define PIROUETTE_COMMIT "unknown"
#endif

namespace pirouette {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double kFallTilt = 1.0;           // rad
constexpr double kFallHeight = 0.1;         // m
constexpr double kFallShare = 0.4;          // of body.height, for small robots
constexpr double kStandDownTime = 1.0;      // s
constexpr double kTimePerStillTurn = 10.0;  // s
constexpr double kProgressPeriod = 0.1;     // s, simulated
constexpr double kMaxDuration = 1e6;        // s, simulated

/// What the robot is told to do.
struct Motion {
  MotionCommand command;
  std::optional<Path> path;  ///< of run.path, in the file's own frame
};

double recorded_time(const RunConfig& run, const Motion& motion) {
  if (motion.path) {
    const double laps = motion.path->closed() ? run.laps : 1.0;
    return laps * motion.path->length() / motion.command.v_H.norm();
  }
  const double yaw_rate = std::abs(run.rate);
  return run.turns * (yaw_rate > 0.0 ? 2.0 * kPi / yaw_rate : kTimePerStillTurn);
}

/// When what happens, in control ticks.
struct Schedule {
  Schedule(const Config& config, const Motion& motion)
      : rate(config.control.rate),
        command(ticks(config.gait.stand_time)),
        record(command + ticks(config.run.settle_time)),
        end(record + ticks(recorded_time(config.run, motion))) {}

  std::int64_t ticks(double seconds) const { return std::llround(seconds * rate); }
  double seconds(std::int64_t tick) const { return static_cast<double>(tick) / rate; }

  double rate;           ///< Hz
  std::int64_t command;  ///< first tick of the motion
  std::int64_t record;   ///< first recorded tick
  std::int64_t end;      ///< last tick
};

/// The commanded point is run.point in the world, not where the robot happens to stand.
bool has_fixed_point(const RunConfig& run) {
  return run.fixed_point || run.start_offset != std::array{0.0, 0.0} || run.start_yaw_deg != 0.0;
}

Result<Motion> load_motion(const RunConfig& run) {
  Motion motion;
  MotionCommand& command = motion.command;
  command.walk = true;
  if (has_fixed_point(run)) {
    command.point = Vec2(run.point[0], run.point[1]);
    command.heading = 0.0;
  }
  if (run.path.empty()) {
    command.v_H = Vec2(run.velocity[0], run.velocity[1]);
    command.yaw_rate = run.rate;
    return motion;
  }
  const Result<std::filesystem::path> name = resolve_path(run);
  if (!name) return name.errors();
  const Result<PathFile> file = load_path_file(name.value());
  if (!file) return file.errors();
  const double speed = run.path_speed > 0.0 ? run.path_speed : file.value().speed;
  command.v_H = rot2(file.value().travel_direction) * Vec2(speed, 0.0);
  command.hold_heading = file.value().hold_heading;
  motion.path = Path::spline(file.value().points, file.value().closed);
  if (!motion.path) {
    return Error{name.value().string(), 0, "points",
                 "the path turns back on itself; allowed: curves that a robot can follow"};
  }
  return motion;
}

/// Where the CoM should go in the world when the command comes at `p_WG` and `yaw`; absent: a spin.
std::optional<Path> commanded_path(const Motion& motion, const Vec2& p_WG, double yaw) {
  const MotionCommand& command = motion.command;
  const double speed = command.v_H.norm();
  if (speed == 0.0) return std::nullopt;
  const double heading = yaw + std::atan2(command.v_H.y(), command.v_H.x());
  if (!motion.path) return Path::arc(p_WG, heading, command.yaw_rate / speed);
  std::optional<Path> path = motion.path;
  path->start_at(p_WG, heading);
  return path;
}

bool has_fallen(const PlantTruth& truth, double body_height) {
  const Vec3 up = truth.base.R_WB.col(2);
  const double upright = up.dot(truth.ground_normal_W);
  const double height = truth.p_WG.z() - truth.ground_height;
  // Written so that a value that is not a number counts as a fall.
  const double least_height = std::min(kFallHeight, kFallShare * body_height);
  return !(upright > std::cos(kFallTilt) && height > least_height && truth.p_WG.allFinite() &&
           truth.v_WG_W.allFinite());
}

RunContext describe_run(const Config& config, const CommandedMotion& commanded) {
  RunContext c;
  c.path = config.run.path;
  c.robot = config.robot;
  c.terrain = config.plant.terrain;
  c.controller = config.controller;
  c.profile = config.profile;
  c.estimator = enum_name(config.estimation.source);
  c.reference = enum_name(config.path.reference);
  c.tracker = enum_name(config.path.tracker);
  c.foot_model = enum_name(config.foot.model);
  c.com_planner = enum_name(config.com.planner);
  c.duty = config.gait.duty;
  c.period = config.gait.period_at(commanded.yaw_rate);
  c.torsional_friction = config.plant.torsional_friction;
  c.friction = config.plant.friction;
  c.seed = config.run.seed;
  c.mujoco = physics_version();
  c.commit = commit();
  c.version = version();
  c.sensors = config.plant.sensors.ideal ? "ideal" : "noisy";
  c.yaw_rate = commanded.yaw_rate;
  c.velocity_x = commanded.v_H.x();
  c.velocity_y = commanded.v_H.y();
  c.point_x = commanded.point.x();
  c.point_y = commanded.point.y();
  c.terrain_half_extent_m = kTerrainHalfExtent;
  c.terrain_pitch_m = kTerrainPitch;
  return c;
}

/// What a trial needs besides its config.
struct Setup {
  Motion motion;
  Plant plant;
  SpinController controller;
};

Result<Setup> build(const Config& config) {
  const Result<std::string> mjcf = resolve_robot(config);
  if (!mjcf) return mjcf.errors();
  Result<Motion> motion = load_motion(config.run);
  if (!motion) return motion.errors();
  const double recorded = recorded_time(config.run, motion.value());
  if (!(recorded <= kMaxDuration)) {
    std::ostringstream text;
    text << "makes a trial of " << recorded << " s; allowed: up to " << kMaxDuration << " s";
    return Error{"", 0, config.run.path.empty() ? "run.turns" : "run.laps", text.str()};
  }
  Result<SpinController> controller = SpinController::create(config, mjcf.value());
  const Vec2 start(config.run.start_offset[0], config.run.start_offset[1]);
  Result<Plant> plant =
      Plant::create(config, mjcf.value(), start, radians(config.run.start_yaw_deg));
  if (controller && plant) {
    return Setup{std::move(motion).value(), std::move(plant).value(),
                 std::move(controller).value()};
  }
  // Both read the robot's file: what is wrong with it is said once.
  Errors errors = controller ? Errors{} : controller.errors();
  const Errors more = plant ? Errors{} : plant.errors();
  std::copy_if(more.begin(), more.end(), std::back_inserter(errors), [&](const Error& error) {
    return controller || error.file != controller.errors().front().file;
  });
  return errors;
}

class Trial {
 public:
  Trial(const Config& config, const TrialOptions& options, Setup setup)
      : config_(config),
        options_(options),
        motion_(std::move(setup.motion)),
        schedule_(config, motion_),
        plant_(std::move(setup.plant)),
        controller_(std::move(setup.controller)) {
    const BaseTruth& start = plant_.truth().base;
    controller_.reset({start.p_WB, start.R_WB});
    controller_.follow(motion_.path);
    const MotionCommand& command = motion_.command;
    commanded_ = {command.point.value_or(Vec2::Zero()), command.v_H, command.yaw_rate,
                  command.hold_heading, std::nullopt};
    yaw_.reset(rpy_from_rotation(start.R_WB).yaw);
  }

  TrialResult run() {
    start_ = Clock::now();
    for (tick_ = 0; tick_ <= schedule_.end; ++tick_) {
      if (options_.before_tick) options_.before_tick(tick_);
      const PlantTruth& truth = plant_.truth();
      if (has_fallen(truth, config_.body.height) || gave_up()) {
        fall_time_ = schedule_.seconds(tick_);
        stand_down_delay_ = await_stand_down();
        break;
      }
      yaw_.update(rpy_from_rotation(truth.base.R_WB).yaw);
      if (tick_ == schedule_.command) begin_motion(truth);
      const JointCommand& command = tick(present_command());
      log(truth);
      if (!report(truth)) return {.metrics = {}, .interrupted = true};
      if (tick_ < schedule_.end) plant_.advance(command);
    }
    if (!fall_time_ && is_stood_down(controller_.status())) {
      fall_time_ = schedule_.seconds(schedule_.end);
      stand_down_delay_ = 0.0;
    }
    return {.metrics = summarise(), .interrupted = false};
  }

 private:
  MotionCommand present_command() const {
    return tick_ < schedule_.command ? MotionCommand{} : motion_.command;
  }

  void begin_motion(const PlantTruth& truth) {
    const MotionCommand& command = motion_.command;
    if (!command.point) commanded_.point = truth.p_WG.head<2>();
    command_yaw_ = yaw_.value();
    commanded_.path =
        commanded_path(motion_, commanded_.point, command.heading.value_or(command_yaw_));
  }

  const JointCommand& tick(const MotionCommand& motion) {
    const SensorReading reading = plant_.sense();
    const Clock::time_point before = Clock::now();
    const JointCommand& command = controller_.tick(reading, motion);
    tick_us_.push_back(seconds_since(before) * 1e6);
    const TickTiming& timing = controller_.timing();
    if (timing.mpc_us > 0.0) mpc_us_.push_back(timing.mpc_us);
    if (timing.wbc_us > 0.0) wbc_us_.push_back(timing.wbc_us);
    return command;
  }

  bool gave_up() {
    stood_down_ticks_ = is_stood_down(controller_.status()) ? stood_down_ticks_ + 1 : 0;
    return stood_down_ticks_ > schedule_.ticks(kStandDownTime);
  }

  Number await_stand_down() {
    for (std::int64_t waited = 0; waited <= schedule_.ticks(kStandDownTime); ++waited) {
      if (is_stood_down(controller_.status())) return schedule_.seconds(waited);
      plant_.advance(controller_.tick(plant_.sense(), present_command()));
      if (options_.before_tick) options_.before_tick(tick_ + waited + 1);
    }
    return std::nullopt;
  }

  void log(const PlantTruth& truth) {
    const TickTrace& trace = controller_.trace();
    if (tick_ >= schedule_.record) {
      record_.add(truth, yaw_.value(), trace.state, trace.path.arc_length);
    }
    constexpr double kRounding = 1e-9;
    const double row_time = static_cast<double>(rows_) / config_.run.trace_rate;
    if (options_.trace != nullptr && schedule_.seconds(tick_) >= row_time - kRounding) {
      options_.trace->append({trace, truth, yaw_.value()});
      ++rows_;
    }
  }

  bool report(const PlantTruth& truth) {
    const bool due = tick_ % schedule_.ticks(kProgressPeriod) == 0 || tick_ == schedule_.end;
    if (!options_.progress || !due) return true;
    TrialProgress progress;
    progress.time = schedule_.seconds(tick_);
    progress.duration = schedule_.seconds(schedule_.end);
    progress.real_time_factor = progress.time / seconds_since(start_);
    if (tick_ >= schedule_.command) {
      const double direction = motion_.command.yaw_rate < 0.0 ? -1.0 : 1.0;
      progress.turns = direction * (yaw_.value() - command_yaw_) / (2.0 * kPi);
      progress.distance_to_point = (truth.p_WG.head<2>() - commanded_.point).norm();
    }
    return options_.progress(progress);
  }

  Metrics summarise() const {
    const double wall = seconds_since(start_);
    const double simulated = schedule_.seconds(std::min(tick_, schedule_.end));
    Metrics m = evaluate(record_, commanded_, schedule_.rate);
    m.fell = fall_time_.has_value();
    m.fall_time_s = fall_time_;
    m.stand_down_delay_s = stand_down_delay_;
    m.timing = summarise_times(tick_us_, mpc_us_, wbc_us_);
    m.timing.physics_step_us_median = plant_.physics_step_us_median();
    m.timing.real_time_factor = simulated / wall;
    m.context = describe_run(config_, commanded_);
    m.context.duration_s = simulated;
    return m;
  }

  const Config& config_;
  const TrialOptions& options_;
  Motion motion_;
  Schedule schedule_;
  Plant plant_;
  SpinController controller_;
  CommandedMotion commanded_;
  YawUnwrapper yaw_;
  double command_yaw_ = 0.0;
  MotionRecord record_;
  std::vector<double> tick_us_, mpc_us_, wbc_us_;
  std::int64_t tick_ = 0;
  std::int64_t rows_ = 0;
  std::int64_t stood_down_ticks_ = 0;
  Number fall_time_, stand_down_delay_;
  Clock::time_point start_;
};

}  // namespace

const char* version() { return PIROUETTE_VERSION; }
const char* commit() { return PIROUETTE_COMMIT; }

Errors check_trial(const Config& config) {
  const Result<Setup> setup = build(config);
  return setup ? Errors{} : setup.errors();
}

Result<TrialResult> run_trial(const Config& config, const TrialOptions& options) {
  Result<Setup> setup = build(config);
  if (!setup) return setup.errors();
  return Trial(config, options, std::move(setup).value()).run();
}

}  // namespace pirouette
