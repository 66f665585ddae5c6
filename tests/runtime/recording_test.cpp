#include "pirouette/runtime/recording.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "support/closed_loop.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

Config noisy_config() {
  Config config;
  config.plant.sensors.aid_rate = 10.0;
  return config;
}

/// What the flight recorder kept of a spin, the first second of it standing.
Recording recorded_spin(const Config& config, std::int64_t ticks = 1000) {
  test::ClosedLoop loop(config);
  const BaseTruth& start = loop.plant.truth().base;
  FlightRecorder recorder(loop.controller, {start.p_WB, start.R_WB}, test::kTick);
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const MotionCommand motion = tick < 500 ? test::stand_still() : test::spin(0.7);
    const SensorReading sensors = loop.plant.sense();
    const JointCommand& command = loop.tick(sensors, motion);
    recorder.watch({tick, sensors, motion, command, nullptr, 0.0});
  }
  return recorder.recording();
}

TEST(Recording, GivesBackWhatWentIn) {
  SensorReading sensors;
  sensors.time = 1.5;
  sensors.joint_position[Leg::kRL] = Vec3(1.0, 2.0, 3.0);
  sensors.joint_velocity[Leg::kRL] = Vec3(4.0, 5.0, 6.0);
  sensors.foot_contact = PerLeg<bool>::filled(true);
  sensors.aid = PositionAid{Vec3(7.0, 8.0, 9.0), 0.5, 1.4};
  sensors.truth = BaseTruth{Vec3(1.0, 0.0, 0.3), rot_z(0.4), Vec3::UnitX(), Vec3::UnitZ()};
  MotionCommand motion = test::spin(0.7);
  motion.v_H = Vec2(0.1, 0.2);
  motion.point = Vec2(3.0, 4.0);
  motion.heading = 0.25;
  motion.hold_heading = true;
  const RecordedTick tick =
      RecordedTick::of(sensors, motion, JointCommand{}, ControllerStatus::kWalking);
  const SensorReading read = tick.sensors();
  EXPECT_EQ(read.time, sensors.time);
  EXPECT_EQ(read.joint_position[Leg::kRL], sensors.joint_position[Leg::kRL]);
  EXPECT_EQ(read.joint_velocity[Leg::kRL], sensors.joint_velocity[Leg::kRL]);
  EXPECT_TRUE((*read.foot_contact)[Leg::kFL]);
  EXPECT_EQ(read.aid->p_WB, sensors.aid->p_WB);
  EXPECT_EQ(read.aid->yaw, sensors.aid->yaw);
  EXPECT_EQ(read.aid->time, sensors.aid->time);
  EXPECT_EQ(read.truth->R_WB, sensors.truth->R_WB);
  EXPECT_EQ(read.truth->w_WB_B, sensors.truth->w_WB_B);
  const MotionCommand told = tick.motion();
  EXPECT_TRUE(told.walk);
  EXPECT_EQ(told.v_H, motion.v_H);
  EXPECT_EQ(told.yaw_rate, motion.yaw_rate);
  EXPECT_EQ(*told.point, *motion.point);
  EXPECT_EQ(*told.heading, *motion.heading);
  EXPECT_TRUE(told.hold_heading);
  EXPECT_FALSE(RecordedTick{}.sensors().aid.has_value());
  EXPECT_FALSE(RecordedTick{}.motion().point.has_value());
}

TEST(Recording, ReplaysToTheSameCommandsBitForBit) {
  const Config config = noisy_config();
  const Recording recording = recorded_spin(config);
  SpinController controller = test::make_controller(config);
  const Replay result = replay(recording, controller).value();
  EXPECT_FALSE(result.difference.has_value());
  EXPECT_EQ(result.ticks, 1000);
  EXPECT_EQ(result.status, ControllerStatus::kWalking);
}

TEST(Recording, OfALongRunReplaysFromTheSnapshotAtItsStart) {
  const Config config = noisy_config();
  const Recording recording = recorded_spin(config, 12000);
  EXPECT_EQ(recording.start.first_tick, 5000);
  EXPECT_FALSE(recording.start.snapshot.empty());
  SpinController controller = test::make_controller(config);
  const Replay result = replay(recording, controller).value();
  EXPECT_FALSE(result.difference.has_value());
  EXPECT_EQ(result.ticks, 7000);
}

TEST(Recording, NamesTheFirstTickAndColumnThatDiffer) {
  const Config config = noisy_config();
  Recording recording = recorded_spin(config);
  double& torque = recording.ticks[700].command_torque[Leg::kFL].y();
  torque = std::nextafter(torque, 1e9);
  SpinController controller = test::make_controller(config);
  const Replay result = replay(recording, controller).value();
  ASSERT_TRUE(result.difference.has_value());
  EXPECT_EQ(result.ticks, 700);
  EXPECT_EQ(result.difference->tick, 700);
  EXPECT_EQ(result.difference->column, "command_torque[FL][1]");
  EXPECT_EQ(result.difference->recorded, torque);
  EXPECT_LT(result.difference->replayed, torque);
}

TEST(Recording, OfAnotherConfigurationDiffers) {
  const Recording recording = recorded_spin(noisy_config());
  Config other = noisy_config();
  other.joint.kp_stance += 1.0;
  SpinController controller = test::make_controller(other);
  EXPECT_TRUE(replay(recording, controller).value().difference.has_value());
}

class RecordingFiles : public test::TempFolderTest {};

TEST_F(RecordingFiles, HoldTheRecordingBitForBit) {
  Recording recording = recorded_spin(noisy_config());
  recording.start.snapshot = {std::byte{1}, std::byte{0}, std::byte{255}};
  ASSERT_FALSE(write_recording(folder_, recording));
  const Recording read = read_recording(folder_).value();
  EXPECT_EQ(read.start.first_tick, recording.start.first_tick);
  EXPECT_EQ(read.start.pose.p_WB, recording.start.pose.p_WB);
  EXPECT_EQ(read.start.pose.R_WB, recording.start.pose.R_WB);
  EXPECT_EQ(read.start.snapshot, recording.start.snapshot);
  ASSERT_EQ(read.ticks.size(), recording.ticks.size());
  EXPECT_EQ(read.ticks[700].command_torque[Leg::kFL],
            recording.ticks[700].command_torque[Leg::kFL]);
  SpinController controller = test::make_controller(noisy_config());
  EXPECT_FALSE(replay(read, controller).value().difference.has_value());
}

TEST_F(RecordingFiles, ThatAreCutShortOrMissingAreErrors) {
  EXPECT_FALSE(read_recording(folder_).ok());
  ASSERT_FALSE(write_recording(folder_, recorded_spin(noisy_config())));
  for (const char* name : {kRecordingFile, kRecordingStartFile}) {
    const std::filesystem::path path = folder_ / name;
    const auto size = std::filesystem::file_size(path);
    std::filesystem::copy_file(path, folder_ / "whole");
    std::filesystem::resize_file(path, size - 3);
    EXPECT_EQ(read_recording(folder_).errors().front().file, path.string());
    std::filesystem::rename(folder_ / "whole", path);
  }
  EXPECT_TRUE(read_recording(folder_).ok());
}

/// Counts its ticks, and can be put back to any count where `can_tell`.
class Counter final : public Controller {
 public:
  explicit Counter(bool can_tell) : can_tell_(can_tell) {}
  void reset(const BasePose&) override { count_ = 0; }
  const JointCommand& tick(const SensorReading&, const MotionCommand&) noexcept override {
    command_[Leg::kFR].tau.x() = ++count_;
    return command_;
  }
  ControllerStatus status() const noexcept override { return ControllerStatus::kStanding; }
  std::vector<std::byte> snapshot() const override {
    if (!can_tell_) return {};
    return {std::byte(count_ / 256), std::byte(count_ % 256)};
  }
  bool restore(std::span<const std::byte> snapshot) override {
    if (!can_tell_ || snapshot.size() != 2) return false;
    count_ = static_cast<int>(snapshot[0]) * 256 + static_cast<int>(snapshot[1]);
    return true;
  }

 private:
  bool can_tell_;
  int count_ = 0;
  JointCommand command_;
};

Recording last_seconds_of(Counter& controller, double period, std::int64_t ticks) {
  FlightRecorder recorder(controller, {}, period);
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    SensorReading sensors;
    sensors.time = period * static_cast<double>(tick);
    const JointCommand& command = controller.tick(sensors, {});
    recorder.watch({tick, sensors, MotionCommand{}, command, nullptr, 0.0});
  }
  return recorder.recording();
}

TEST(FlightRecorder, KeepsTheLastSecondsWithASnapshotOfTheirStart) {
  Counter controller(true);
  const Recording recording = last_seconds_of(controller, 0.01, 5300);
  const double kept = static_cast<double>(recording.ticks.size()) * 0.01;
  EXPECT_GE(kept, FlightRecorder::kKept);
  EXPECT_LE(kept, 2.0 * FlightRecorder::kKept);
  EXPECT_EQ(recording.start.first_tick + static_cast<std::int64_t>(recording.ticks.size()), 5300);
  Counter again(true);
  const Replay result = replay(recording, again).value();
  EXPECT_FALSE(result.difference.has_value());
  EXPECT_EQ(result.ticks, static_cast<std::int64_t>(recording.ticks.size()));
}

TEST(FlightRecorder, KeepsARunFromItsStartWhileTheControllerGivesNoSnapshot) {
  Counter controller(false);
  const Recording whole = last_seconds_of(controller, 0.01, 5300);
  EXPECT_EQ(whole.start.first_tick, 0);
  EXPECT_EQ(whole.ticks.size(), 5300U);

  Counter longer(false);
  const Recording late = last_seconds_of(longer, 0.01, 13500);
  EXPECT_GT(late.start.first_tick, 0);
  EXPECT_FALSE(replay(late, longer).ok());
}

}  // namespace
}  // namespace pirouette
