// Recording of a controller's inputs and outputs, tick by tick, and its replay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/npy_rows_file.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/controller/controller.hpp"
#include "pirouette/runtime/control_loop.hpp"
#include "pirouette/runtime/world.hpp"

namespace pirouette {

inline constexpr const char* kRecordingFile = "recording.npy";         ///< rows of RecordedTick
inline constexpr const char* kRecordingStartFile = "recording.start";  ///< RecordingStart in bytes

/// A row of recording.npy: sensor reading, motion command, and the joint command and status of the
/// controller. Units and frames as in SensorReading, MotionCommand and LegCommand. An optional
/// value has a flag `has_...` and is zero where absent.
struct RecordedTick {
  double time = 0.0;
  PerLeg<Vec3> joint_position = PerLeg<Vec3>::filled(Vec3::Zero());
  PerLeg<Vec3> joint_velocity = PerLeg<Vec3>::filled(Vec3::Zero());
  Vec3 specific_force_B = Vec3::Zero();
  Vec3 gyro_B = Vec3::Zero();
  bool has_foot_contact = false;
  PerLeg<bool> foot_contact{};
  bool has_foot_force = false;
  PerLeg<double> foot_force{};
  bool has_aid = false;
  Vec3 aid_position = Vec3::Zero();
  double aid_yaw = 0.0;
  double aid_time = 0.0;
  bool has_truth = false;
  Vec3 true_position = Vec3::Zero();
  Eigen::Matrix<double, 9, 1> true_rotation = Eigen::Matrix<double, 9, 1>::Zero();
  Vec3 true_velocity = Vec3::Zero();
  Vec3 true_angular_velocity_B = Vec3::Zero();
  bool walk = false;
  Vec2 velocity_H = Vec2::Zero();
  double yaw_rate = 0.0;
  bool has_point = false;
  Vec2 point = Vec2::Zero();
  bool has_heading = false;
  double heading = 0.0;
  bool hold_heading = false;
  PerLeg<Vec3> command_position = PerLeg<Vec3>::filled(Vec3::Zero());
  PerLeg<Vec3> command_velocity = PerLeg<Vec3>::filled(Vec3::Zero());
  PerLeg<Vec3> command_kp = PerLeg<Vec3>::filled(Vec3::Zero());
  PerLeg<Vec3> command_kd = PerLeg<Vec3>::filled(Vec3::Zero());
  PerLeg<Vec3> command_torque = PerLeg<Vec3>::filled(Vec3::Zero());
  int status = 0;

  /// The row of one tick.
  static RecordedTick of(const SensorReading& sensors, const MotionCommand& motion,
                         const JointCommand& command, ControllerStatus status);
  SensorReading sensors() const;  ///< the recorded reading
  MotionCommand motion() const;   ///< the recorded motion command

  /// Calls visit(name, unit, meaning, value) for each column.
  template <class Self, class Visit>
  static void columns(Self& r, Visit&& visit) {
    visit("time", "s", "time of the sensor reading", r.time);
    visit("joint_position", "rad", "measured abad, hip, knee", r.joint_position);
    visit("joint_velocity", "rad/s", "measured", r.joint_velocity);
    visit("specific_force_B", "m/s^2", "measured by the accelerometer", r.specific_force_B);
    visit("gyro_B", "rad/s", "measured by the gyro", r.gyro_B);
    visit("has_foot_contact", "1", "the robot has contact sensing", r.has_foot_contact);
    visit("foot_contact", "1", "contact flags as measured", r.foot_contact);
    visit("has_foot_force", "1", "the robot has force sensors in its feet", r.has_foot_force);
    visit("foot_force", "1", "raw, as measured", r.foot_force);
    visit("has_aid", "1", "a pose from outside arrived", r.has_aid);
    visit("aid_position", "m", "its p_WB", r.aid_position);
    visit("aid_yaw", "rad", "its yaw", r.aid_yaw);
    visit("aid_time", "s", "when it was measured", r.aid_time);
    visit("has_truth", "1", "the reading carries the simulator's truth", r.has_truth);
    visit("true_position", "m", "p_WB", r.true_position);
    visit("true_rotation", "1", "R_WB, column by column", r.true_rotation);
    visit("true_velocity", "m/s", "v_WB_W", r.true_velocity);
    visit("true_angular_velocity_B", "rad/s", "w_WB_B", r.true_angular_velocity_B);
    visit("walk", "1", "motion command: walk, else stand", r.walk);
    visit("velocity_H", "m/s", "motion command, heading axes", r.velocity_H);
    visit("yaw_rate", "rad/s", "motion command", r.yaw_rate);
    visit("has_point", "1", "the motion command has a point", r.has_point);
    visit("point", "m", "motion command, world", r.point);
    visit("has_heading", "1", "the motion command has a heading", r.has_heading);
    visit("heading", "rad", "motion command, world", r.heading);
    visit("hold_heading", "1", "motion command: keep the heading on a path", r.hold_heading);
    visit("command_position", "rad", "joint command", r.command_position);
    visit("command_velocity", "rad/s", "joint command", r.command_velocity);
    visit("command_kp", "N m/rad", "joint command", r.command_kp);
    visit("command_kd", "N m s/rad", "joint command", r.command_kd);
    visit("command_torque", "N m", "joint command, feed-forward", r.command_torque);
    visit("status", "1", "of the controller after the tick", r.status);
  }
};

/// State from which a controller can replay the recorded ticks.
struct RecordingStart {
  std::int64_t first_tick = 0;      ///< number of the first recorded tick in its run
  BasePose pose;                    ///< start pose of the run: argument of Controller::reset()
  std::vector<std::byte> snapshot;  ///< Controller::snapshot() before first_tick; empty at tick 0
};

/// A recorded part of a run.
struct Recording {
  RecordingStart start;             ///< state before the first tick
  std::vector<RecordedTick> ticks;  ///< one for each control period
};

/// Writes recording.npy and recording.start into `folder`. Returns the error when one cannot be
/// written; absent: done.
std::optional<Error> write_recording(const std::filesystem::path& folder,
                                     const Recording& recording);

/// Reads both files of `folder`. The errors name the file that is missing, damaged or of another
/// version.
Result<Recording> read_recording(const std::filesystem::path& folder);

/// Keeps the last kKept to twice kKept seconds of a run in memory. If the controller gives no
/// snapshots it keeps the run from its start instead, for kKeptWhole seconds: without a snapshot a
/// replay can only begin there.
class FlightRecorder final : public Observer {
 public:
  static constexpr double kKept = 10.0;        ///< s
  static constexpr double kKeptWhole = 120.0;  ///< s

  /// `controller` must have just been reset to `start`, tick every `period` (s) and outlive the
  /// recorder.
  FlightRecorder(const Controller& controller, const BasePose& start, double period);

  /// Always true.
  bool watch(const TickView& view) override;

  /// The ticks kept.
  Recording recording() const;

 private:
  const Controller& controller_;
  std::size_t ticks_kept_;
  std::size_t ticks_kept_whole_;
  Recording before_;  ///< the kKept seconds before those of `now_`
  Recording now_;
};

/// Writes a whole run to recording.npy and recording.start, tick by tick.
class RunRecorder final : public Observer {
 public:
  /// `controller` must have just been reset to `start` and outlive the recorder. The error names
  /// the file that cannot be written.
  static Result<RunRecorder> create(const std::filesystem::path& folder,
                                    const Controller& controller, const BasePose& start);

  /// Always true.
  bool watch(const TickView& view) override;
  /// Completes recording.npy. Returns the error when it could not be written; absent: done.
  std::optional<Error> finish() { return file_.finish(); }

 private:
  RunRecorder(NpyRowsFile file, const Controller& controller)
      : file_(std::move(file)), controller_(controller) {}

  NpyRowsFile file_;
  const Controller& controller_;
};

/// World that returns the recorded readings and ignores what is sent.
class RecordedWorld final : public World {
 public:
  /// `recording` must outlive it.
  explicit RecordedWorld(const Recording& recording) : recording_(recording) {}

  double period() const override;
  std::optional<SensorReading> sense() override;
  void send(const JointCommand&) override {}

 private:
  const Recording& recording_;
  std::size_t next_ = 0;
};

/// First difference of a replay from its recording.
struct ReplayDifference {
  std::int64_t tick = 0;  ///< number of the tick in its run
  double time = 0.0;      ///< s, of the sensor reading
  std::string column;     ///< of recording.npy, with leg and element
  double recorded = 0.0;  ///< value in the recording
  double replayed = 0.0;  ///< value in the replay
};

/// Outcome of a replay.
struct Replay {
  std::int64_t ticks = 0;                                 ///< number of equal ticks
  std::optional<ReplayDifference> difference;             ///< absent: all ticks are equal
  ControllerStatus status = ControllerStatus::kStanding;  ///< after the last equal tick
};

/// Runs `controller`, configured as the recorded one, on the recorded readings and motion commands
/// and compares its joint commands and status bit by bit, up to the first difference. An error when
/// the recording starts with a snapshot that the controller cannot restore.
Result<Replay> replay(const Recording& recording, Controller& controller);

}  // namespace pirouette
