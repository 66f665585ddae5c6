#include "pirouette/trial/trial.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "pirouette/base/stopwatch.hpp"
#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/metrics/motion_metrics.hpp"
#include "pirouette/plant/simulated_world.hpp"
#include "pirouette/runtime/recording.hpp"
#include "pirouette/runtime/turn_by_angle.hpp"

namespace pirouette {
namespace {

constexpr double kFallTilt = 1.0;           // rad
constexpr double kFallHeight = 0.37;        // of the standing height
constexpr double kStandDownTime = 1.0;      // s
constexpr double kTimePerStillTurn = 10.0;  // s
constexpr double kProgressPeriod = 0.1;     // s, simulated
constexpr double kMaxDuration = 1e6;        // s, simulated
constexpr double kLimitShare = 1.5;         // of the time that the command needs
constexpr double kLimitSlack = 10.0;        // s, on top of that: ramps take theirs
constexpr double kBrakingShare = 0.5;       // of path.max_yaw_acceleration, at the end of a turn
constexpr double kStandTime = 1.0;          // s, after a turn by an angle

bool turns_by_angle(const TrialSetup& setup) { return setup.trial.angle_deg != 0.0; }

/// s, after which the recording ends when all goes well.
double recorded_time(const TrialSetup& setup) {
  if (setup.path) {
    const double laps = setup.path->closed() ? setup.trial.laps : 1.0;
    return laps * setup.path->length() / setup.motion.v_H.norm();
  }
  const double yaw_rate = std::abs(setup.trial.rate);
  if (turns_by_angle(setup)) return radians(std::abs(setup.trial.angle_deg)) / yaw_rate;
  return setup.trial.turns * (yaw_rate > 0.0 ? 2.0 * kPi / yaw_rate : kTimePerStillTurn);
}

/// s, after which it ends whatever was done.
double time_limit(const TrialSetup& setup) {
  const double given = setup.trial.time_limit;
  return given > 0.0 ? given : kLimitShare * recorded_time(setup) + kLimitSlack;
}

/// When what happens, in control ticks.
struct Schedule {
  explicit Schedule(const TrialSetup& setup)
      : rate(setup.controller.control.rate),
        command(ticks(setup.controller.gait.stand_time)),
        record(command + (turns_by_angle(setup) ? 0 : ticks(setup.trial.settle_time))),
        limit(record + ticks(time_limit(setup))),
        due(std::min(limit, record + ticks(recorded_time(setup)))) {}

  std::int64_t ticks(double seconds) const { return std::llround(seconds * rate); }
  double seconds(std::int64_t tick) const { return static_cast<double>(tick) / rate; }

  double rate;           ///< Hz
  std::int64_t command;  ///< first tick of the motion
  std::int64_t record;   ///< first recorded tick
  std::int64_t limit;    ///< last tick whatever was done
  std::int64_t due;      ///< last tick when what was commanded is done by then
};

/// Where the CoM should go in the world when the command comes at its point and `yaw`; absent: a
/// spin.
std::optional<Path> commanded_path(const TrialSetup& setup, const CommandedMotion& commanded,
                                   double yaw) {
  const Vec2& p_WG = commanded.point;
  const double speed = commanded.v_H.norm();
  if (speed == 0.0) return std::nullopt;
  const double heading = yaw + std::atan2(commanded.v_H.y(), commanded.v_H.x());
  if (!setup.path) return Path::arc(p_WG, heading, commanded.yaw_rate / speed);
  std::optional<Path> path = setup.path;
  path->start_at(p_WG, heading);
  return path;
}

/// How much of what was commanded the robot has done since the recording began, by the truth.
class Progress {
 public:
  explicit Progress(const TrialSetup& setup) : setup_(setup) {}

  /// Where the robot is in a recorded tick.
  struct Place {
    Vec2 p_WG = Vec2::Zero();  ///< m
    double yaw = 0.0;          ///< rad, unwrapped
    double s = 0.0;            ///< m, along the path, of its point nearest to the CoM
  };
  void update(const Place& now) {
    if (!start_) start_ = now;
    now_ = now;
  }

  /// Share of the laps, turns, angle or distance; absent where nothing was commanded.
  Number share() const {
    const double speed = setup_.motion.v_H.norm();
    if (!start_) return 0.0;
    if (setup_.path) {
      const double length = setup_.path->length();
      return (now_.s - start_->s) /
             (setup_.path->closed() ? setup_.trial.laps * length : length - start_->s);
    }
    if (turns_by_angle(setup_)) return turned() / radians(setup_.trial.angle_deg);
    const double yaw_rate = setup_.motion.yaw_rate;
    if (yaw_rate != 0.0) {
      return std::copysign(1.0, yaw_rate) * turned() / (2.0 * kPi * setup_.trial.turns);
    }
    if (speed == 0.0) return std::nullopt;
    return (now_.p_WG - start_->p_WG).norm() / (speed * recorded_time(setup_));
  }

  double turned() const { return start_ ? now_.yaw - start_->yaw : 0.0; }  ///< rad

  bool done() const {
    const Number done = share();
    return !done || *done >= kDoneShare;
  }

 private:
  const TrialSetup& setup_;
  std::optional<Place> start_;  ///< absent: the recording has not begun
  Place now_;
};

/// Takes away what compares with a steady motion: a turn by an angle ramps and brakes.
void leave_out_steady_motion(Metrics& m) {
  m.yaw_rate_error = std::nullopt;
  m.path.along_track_mean_mm = std::nullopt;
  m.com.body_bias_mm_s = m.com.body_bias_x_mm_s = m.com.body_bias_y_mm_s = std::nullopt;
  m.com.bias_circle_mm = std::nullopt;
}

bool has_fallen(const PlantTruth& truth, double standing_height) {
  const Vec3 up = truth.base.R_WB.col(2);
  const double upright = up.dot(truth.ground_normal_W);
  const double height = truth.p_WG.z() - truth.ground_height;
  // Written so that a value that is not a number counts as a fall.
  const double least_height = kFallHeight * standing_height;
  return !(upright > std::cos(kFallTilt) && height > least_height && truth.p_WG.allFinite() &&
           truth.v_WG_W.allFinite());
}

/// The robot in its world, and its controller.
struct Robot {
  Plant plant;
  SpinController controller;
};

Result<Robot> build(const TrialSetup& setup) {
  const double recorded = recorded_time(setup);
  if (!(recorded <= kMaxDuration)) {
    std::ostringstream text;
    text << "makes a trial of " << recorded << " s; allowed: up to " << kMaxDuration << " s";
    return Error{"", 0, setup.path ? "run.laps" : "run.turns", text.str()};
  }
  Result<SpinController> controller = SpinController::create(setup.controller, setup.plant.robot);
  if (!controller) {
    // Both read the robot's file: what is wrong with it, and what follows from it, is said once.
    Errors errors = controller.errors();
    const Errors of_settings = Plant::check(setup.world, setup.plant);
    errors.insert(errors.end(), of_settings.begin(), of_settings.end());
    return errors;
  }
  Result<Plant> plant = Plant::create(setup.world, setup.plant);
  if (!plant) return plant.errors();
  return Robot{std::move(plant).value(), std::move(controller).value()};
}

/// Commands the motion, judges falls by the truth, and measures.
class Trial final : public MotionSource, public Observer {
 public:
  Trial(const TrialSetup& setup, const TrialOptions& options, Robot robot)
      : setup_(setup),
        options_(options),
        schedule_(setup),
        progress_(setup),
        plant_(std::move(robot.plant)),
        controller_(std::move(robot.controller)) {
    controller_.reset(start_pose());
    controller_.follow(setup_.path);
    const MotionCommand& command = setup_.motion;
    commanded_ = {command.point.value_or(Vec2::Zero()), command.v_H, command.yaw_rate,
                  command.hold_heading, std::nullopt};
    yaw_.reset(rpy_from_rotation(start_pose().R_WB).yaw);
  }

  Result<TrialResult> run() {
    SimulatedWorld world(plant_);
    std::vector<Observer*> observers = {this};
    std::optional<FlightRecorder> last_seconds;
    std::optional<RunRecorder> whole_run;
    if (options_.records_whole_run) {
      Result<RunRecorder> recorder =
          RunRecorder::create(options_.recording_folder, controller_, start_pose());
      if (!recorder) return recorder.errors();
      observers.push_back(&whole_run.emplace(std::move(recorder).value()));
    } else if (!options_.recording_folder.empty()) {
      observers.push_back(&last_seconds.emplace(controller_, start_pose(), world.period()));
    }

    watch_ = Stopwatch();
    const LoopEnd end = pirouette::run(world, controller_, *this, observers, options_.pacer);
    TrialResult result;
    result.interrupted = end == LoopEnd::kObserver;
    result.metrics = summarise();
    result.metrics.interrupted = result.interrupted;
    const TickTrace& last = controller_.trace();
    if (is_stood_down(last.status)) result.stood_down = words(last.status);
    if (has_failed(last.self_check)) result.stood_down.append(": ").append(words(last.self_check));
    result.completed = !fall_tick_ && !result.interrupted && is_done();
    std::optional<Error> error;
    if (whole_run) {
      error = whole_run->finish();
    } else if (last_seconds && fall_tick_) {
      error = write_recording(options_.recording_folder, last_seconds->recording());
    }
    if (error) return *error;
    result.recorded = whole_run || (last_seconds && fall_tick_);
    return result;
  }

  std::optional<MotionCommand> next(std::int64_t tick, const PlantTruth* truth) override {
    if (fall_tick_) return while_falling(tick);
    if (tick > schedule_.limit || (tick > schedule_.due && is_done())) {
      if (is_stood_down(controller_.status())) {
        fall_tick_ = tick_;
        stand_down_delay_ = 0.0;
      }
      return std::nullopt;
    }
    tick_ = tick;
    if (has_fallen(*truth, setup_.plant.com_height) || gave_up()) {
      fall_tick_ = tick;
      return while_falling(tick);
    }
    yaw_.update(rpy_from_rotation(truth->base.R_WB).yaw);
    if (tick == schedule_.command) begin_motion(*truth);
    if (tick >= schedule_.command && turn_) {
      const double turned = controller_.estimate()->rpy.yaw - believed_start_yaw_;
      last_command_ = turn_->update(turned, 1.0 / schedule_.rate);
      if (turn_->done()) ++ticks_since_turn_;
      return last_command_;
    }
    return command_of(tick);
  }

  bool watch(const TickView& view) override {
    if (fall_tick_) return true;
    const TickTiming& timing = controller_.timing();
    tick_times_.add(view.tick_us, timing.mpc_us, timing.wbc_us);
    log(*view.truth);
    return report(*view.truth);
  }

 private:
  /// Where the robot is before the first tick.
  BasePose start_pose() const {
    const BaseTruth& start = plant_.truth().base;
    return {start.p_WB, start.R_WB};
  }

  /// The turns, laps or distance commanded are done; after a turn by an angle the robot stands.
  bool is_done() const {
    if (turn_) return ticks_since_turn_ > schedule_.ticks(kStandTime);
    return progress_.done();
  }

  MotionCommand command_of(std::int64_t tick) const {
    if (turn_ && tick >= schedule_.command) return last_command_;
    return tick < schedule_.command ? MotionCommand{} : setup_.motion;
  }

  /// The command goes on until the controller has stood down, for kStandDownTime at most.
  std::optional<MotionCommand> while_falling(std::int64_t tick) {
    const std::int64_t waited = tick - *fall_tick_;
    if (is_stood_down(controller_.status())) {
      stand_down_delay_ = schedule_.seconds(waited);
      return std::nullopt;
    }
    if (waited > schedule_.ticks(kStandDownTime)) return std::nullopt;
    return command_of(*fall_tick_);
  }

  void begin_motion(const PlantTruth& truth) {
    const MotionCommand& command = setup_.motion;
    if (!command.point) commanded_.point = truth.p_WG.head<2>();
    command_yaw_ = yaw_.value();
    commanded_.path = commanded_path(setup_, commanded_, command.heading.value_or(command_yaw_));
    if (!turns_by_angle(setup_)) return;
    turn_.emplace(radians(setup_.trial.angle_deg), command,
                  kBrakingShare * setup_.controller.path.max_yaw_acceleration);
    believed_start_yaw_ = controller_.estimate()->rpy.yaw;
  }

  bool gave_up() {
    stood_down_ticks_ = is_stood_down(controller_.status()) ? stood_down_ticks_ + 1 : 0;
    return stood_down_ticks_ > schedule_.ticks(kStandDownTime);
  }

  void log(const PlantTruth& truth) {
    const TickTrace& trace = controller_.trace();
    if (tick_ >= schedule_.record) {
      if (!motion_) motion_.emplace(commanded_, schedule_.rate);
      motion_->add(motion_sample(truth, yaw_.value(), trace.state, trace.path.arc_length));
      progress_.update({truth.p_WG.head<2>(), yaw_.value(), motion_->nearest_arc_length()});
    }
    constexpr double kRounding = 1e-9;
    const double row_time = static_cast<double>(rows_) / setup_.trial.trace_rate;
    if (options_.trace != nullptr && schedule_.seconds(tick_) >= row_time - kRounding) {
      options_.trace->append(TraceRow{trace, truth, yaw_.value()});
      ++rows_;
    }
  }

  bool report(const PlantTruth& truth) {
    const bool due = tick_ % schedule_.ticks(kProgressPeriod) == 0 || tick_ == schedule_.due;
    if (!options_.progress || !due) return true;
    TrialProgress progress;
    progress.time = schedule_.seconds(tick_);
    progress.duration = schedule_.seconds(std::max(tick_, schedule_.due));
    progress.real_time_factor = progress.time / watch_.seconds();
    if (tick_ >= schedule_.command) {
      const double direction = setup_.motion.yaw_rate < 0.0 ? -1.0 : 1.0;
      progress.turns = direction * (yaw_.value() - command_yaw_) / (2.0 * kPi);
      progress.distance_to_point = (truth.p_WG.head<2>() - commanded_.point).norm();
    }
    return options_.progress(progress);
  }

  Metrics summarise() const {
    const double wall = watch_.seconds();
    const double simulated = schedule_.seconds(tick_);
    Metrics m = motion_ ? motion_->result() : Metrics{};
    m.done = progress_.share();
    if (turns_by_angle(setup_)) {
      m.angle_error_deg = degrees(progress_.turned()) - setup_.trial.angle_deg;
      leave_out_steady_motion(m);
    }
    m.fell = fall_tick_.has_value();
    if (fall_tick_) m.fall_time_s = schedule_.seconds(*fall_tick_);
    m.stand_down_delay_s = stand_down_delay_;
    for (const bool dropped : controller_.trace().flag_dropped) m.contact.dropped_flags += dropped;
    m.timing = tick_times_.result();
    m.timing.physics_step_us_median = plant_.physics_step_us_median();
    m.timing.real_time_factor = simulated / wall;
    m.context = setup_.context;
    m.context.point_x = commanded_.point.x();
    m.context.point_y = commanded_.point.y();
    m.context.duration_s = simulated;
    return m;
  }

  const TrialSetup& setup_;
  const TrialOptions& options_;
  Schedule schedule_;
  Progress progress_;
  Plant plant_;
  SpinController controller_;
  CommandedMotion commanded_;
  YawUnwrapper yaw_;
  double command_yaw_ = 0.0;
  std::optional<TurnByAngle> turn_;
  double believed_start_yaw_ = 0.0;  ///< rad, where that turn began, as the controller believed
  MotionCommand last_command_;       ///< of that turn
  std::int64_t ticks_since_turn_ = 0;
  std::optional<MotionMetrics> motion_;  ///< of the recorded ticks
  TickTimes tick_times_;
  std::int64_t tick_ = 0;  ///< the last one before a fall
  std::int64_t rows_ = 0;
  std::int64_t stood_down_ticks_ = 0;
  std::optional<std::int64_t> fall_tick_;
  Number stand_down_delay_;  ///< s
  Stopwatch watch_;          ///< since the first tick
};

}  // namespace

double expected_duration(const TrialSetup& setup) {
  const Schedule schedule(setup);
  return schedule.seconds(schedule.due);
}

Errors check_trial(const TrialSetup& setup) {
  try {
    const Result<Robot> robot = build(setup);
    return robot ? Errors{} : robot.errors();
  } catch (const std::runtime_error& error) {  // of MuJoCo
    return {Error{setup.plant.robot.file, 0, "", error.what()}};
  }
}

Result<TrialResult> run_trial(const TrialSetup& setup, const TrialOptions& options) {
  try {
    Result<Robot> robot = build(setup);
    if (!robot) return robot.errors();
    return Trial(setup, options, std::move(robot).value()).run();
  } catch (const std::runtime_error& error) {  // of MuJoCo, while it simulates
    return Error{setup.plant.robot.file, 0, "", error.what()};
  }
}

}  // namespace pirouette
