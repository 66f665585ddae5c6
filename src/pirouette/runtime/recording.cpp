#include "pirouette/runtime/recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <span>
#include <sstream>
#include <utility>

#include "pirouette/base/memory.hpp"
#include "pirouette/base/version.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr double kNominalPeriod = 0.002;  // s, of a recording too short to tell

std::string start_head() {
  return std::string("pirouette ") + version() + " (" + commit() + ") recording start 1\n";
}

std::optional<Error> write_start(const fs::path& folder, const RecordingStart& start) {
  const fs::path path = folder / kRecordingStartFile;
  std::vector<std::byte> bytes;
  MemoryWriter write(bytes);
  write(start);
  std::ofstream stream(path, std::ios::binary);
  stream << start_head();
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) return Error{path.string(), 0, "", "cannot be written: is the disk full?"};
  return std::nullopt;
}

Result<RecordingStart> read_start(const fs::path& folder) {
  const fs::path path = folder / kRecordingStartFile;
  std::ifstream stream(path, std::ios::binary);
  if (!stream && !fs::exists(path)) {
    return Error{path.string(), 0, "",
                 fs::is_directory(folder)
                     ? "missing: this run was not recorded; run it with --record"
                     : "no such folder"};
  }
  if (!stream) return Error{path.string(), 0, "", "cannot be read"};
  std::string head;
  std::getline(stream, head);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  RecordingStart start;
  MemoryReader read(std::as_bytes(std::span(text)));
  read(start);
  if (!head.starts_with("pirouette ") || !head.ends_with(" recording start 1") ||
      !read.complete()) {
    return Error{path.string(), 0, "", "is damaged: it ends too early or is another file"};
  }
  return start;
}

Result<NpyRowsFile> create_file(const fs::path& folder) {
  return NpyRowsFile::create(folder / kRecordingFile, [](std::uint64_t rows) {
    const RecordedTick row;
    return npy_rows_header(row, rows);
  });
}

/// "[FR][2]" and the like: the element of a column's value with the flat index `element`.
std::string element_name(const ColumnType& type, std::size_t element) {
  if (type.shape.empty()) return "";
  const std::size_t last = type.shape.size() == 1 ? 1 : static_cast<std::size_t>(type.shape.back());
  std::string name;
  if (type.shape.front() == static_cast<int>(kLegCount)) {
    name = "[" + std::string(kLegNames.at(element / last)) + "]";
    if (type.shape.size() == 1) return name;
  }
  return name + "[" + std::to_string(element % last) + "]";
}

double number_at(const std::vector<char>& bytes, std::size_t at, std::size_t size) {
  if (size == sizeof(double)) {
    double value = 0.0;
    std::memcpy(&value, bytes.data() + at, size);
    return value;
  }
  if (size == sizeof(int)) {
    int value = 0;
    std::memcpy(&value, bytes.data() + at, size);
    return value;
  }
  return bytes[at];
}

std::optional<ReplayDifference> compare(const RecordedTick& recorded,
                                        const RecordedTick& replayed) {
  std::vector<char> before, now;
  append_row(before, recorded);
  append_row(now, replayed);
  if (before == now) return std::nullopt;
  const auto differing = static_cast<std::size_t>(
      std::mismatch(before.begin(), before.end(), now.begin()).first - before.begin());
  ReplayDifference difference;
  difference.time = recorded.time;
  std::vector<char> passed;
  RecordedTick::columns(recorded,
                        [&](const char* name, const char*, const char*, const auto& value) {
                          const std::size_t begin = passed.size();
                          append_value(passed, value);
                          if (!difference.column.empty() || passed.size() <= differing) return;
                          const ColumnType type = column_type(value);
                          std::size_t count = 1;
                          for (const int n : type.shape) count *= static_cast<std::size_t>(n);
                          const std::size_t size = (passed.size() - begin) / count;
                          const std::size_t element = (differing - begin) / size;
                          difference.column = name + element_name(type, element);
                          difference.recorded = number_at(before, begin + element * size, size);
                          difference.replayed = number_at(now, begin + element * size, size);
                        });
  return difference;
}

class RecordedMotion final : public MotionSource {
 public:
  explicit RecordedMotion(const Recording& recording) : recording_(recording) {}
  std::optional<MotionCommand> next(std::int64_t tick, const PlantTruth*) override {
    const auto i = static_cast<std::size_t>(tick);
    if (i >= recording_.ticks.size()) return std::nullopt;
    return recording_.ticks[i].motion();
  }

 private:
  const Recording& recording_;
};

class Comparison final : public Observer {
 public:
  Comparison(const Recording& recording, const Controller& controller)
      : recording_(recording), controller_(controller) {}

  bool watch(const TickView& view) override {
    const RecordedTick& recorded = recording_.ticks[static_cast<std::size_t>(view.tick)];
    const RecordedTick replayed =
        RecordedTick::of(view.sensors, view.motion, view.command, controller_.status());
    result.difference = compare(recorded, replayed);
    if (result.difference) {
      result.difference->tick = recording_.start.first_tick + view.tick;
      return false;
    }
    ++result.ticks;
    result.status = controller_.status();
    return true;
  }

  Replay result;

 private:
  const Recording& recording_;
  const Controller& controller_;
};

}  // namespace

RecordedTick RecordedTick::of(const SensorReading& sensors, const MotionCommand& motion,
                              const JointCommand& command, ControllerStatus status) {
  RecordedTick r;
  r.time = sensors.time;
  r.joint_position = sensors.joint_position;
  r.joint_velocity = sensors.joint_velocity;
  r.specific_force_B = sensors.specific_force_B;
  r.gyro_B = sensors.w_WB_B;
  r.has_foot_contact = sensors.foot_contact.has_value();
  if (sensors.foot_contact) r.foot_contact = *sensors.foot_contact;
  r.has_foot_force = sensors.foot_force.has_value();
  if (sensors.foot_force) r.foot_force = *sensors.foot_force;
  r.has_aid = sensors.aid.has_value();
  if (sensors.aid) {
    r.aid_position = sensors.aid->p_WB;
    r.aid_yaw = sensors.aid->yaw;
    r.aid_time = sensors.aid->time;
  }
  r.has_truth = sensors.truth.has_value();
  if (sensors.truth) {
    r.true_position = sensors.truth->p_WB;
    r.true_rotation = sensors.truth->R_WB.reshaped();
    r.true_velocity = sensors.truth->v_WB_W;
    r.true_angular_velocity_B = sensors.truth->w_WB_B;
  }
  r.walk = motion.walk;
  r.velocity_H = motion.v_H;
  r.yaw_rate = motion.yaw_rate;
  r.has_point = motion.point.has_value();
  if (motion.point) r.point = *motion.point;
  r.has_heading = motion.heading.has_value();
  r.heading = motion.heading.value_or(0.0);
  r.hold_heading = motion.hold_heading;
  for (const Leg leg : kLegs) {
    r.command_position[leg] = command[leg].q;
    r.command_velocity[leg] = command[leg].dq;
    r.command_kp[leg] = command[leg].kp;
    r.command_kd[leg] = command[leg].kd;
    r.command_torque[leg] = command[leg].tau;
  }
  r.status = static_cast<int>(status);
  return r;
}

SensorReading RecordedTick::sensors() const {
  SensorReading s;
  s.time = time;
  s.joint_position = joint_position;
  s.joint_velocity = joint_velocity;
  s.specific_force_B = specific_force_B;
  s.w_WB_B = gyro_B;
  if (has_foot_contact) s.foot_contact = foot_contact;
  if (has_foot_force) s.foot_force = foot_force;
  if (has_aid) s.aid = PositionAid{aid_position, aid_yaw, aid_time};
  if (has_truth) {
    s.truth = BaseTruth{true_position, true_rotation.reshaped(3, 3), true_velocity,
                        true_angular_velocity_B};
  }
  return s;
}

MotionCommand RecordedTick::motion() const {
  MotionCommand m;
  m.walk = walk;
  m.v_H = velocity_H;
  m.yaw_rate = yaw_rate;
  if (has_point) m.point = point;
  if (has_heading) m.heading = heading;
  m.hold_heading = hold_heading;
  return m;
}

std::optional<Error> write_recording(const fs::path& folder, const Recording& recording) {
  if (auto error = write_start(folder, recording.start)) return error;
  Result<NpyRowsFile> file = create_file(folder);
  if (!file) return file.errors().front();
  for (const RecordedTick& tick : recording.ticks) file.value().append(tick);
  return file.value().finish();
}

Result<Recording> read_recording(const fs::path& folder) {
  Result<RecordingStart> start = read_start(folder);
  if (!start) return start.errors();
  Result<std::vector<RecordedTick>> ticks = read_npy_rows<RecordedTick>(folder / kRecordingFile);
  if (!ticks) return ticks.errors();
  return Recording{std::move(start).value(), std::move(ticks).value()};
}

FlightRecorder::FlightRecorder(const Controller& controller, const BasePose& start, double period)
    : controller_(controller),
      ticks_kept_(static_cast<std::size_t>(std::lround(kKept / period))),
      ticks_kept_whole_(static_cast<std::size_t>(std::lround(kKeptWhole / period))) {
  now_.start.pose = start;
  before_.ticks.reserve(ticks_kept_);
  now_.ticks.reserve(ticks_kept_);
}

bool FlightRecorder::watch(const TickView& view) {
  now_.ticks.push_back(
      RecordedTick::of(view.sensors, view.motion, view.command, controller_.status()));
  if (now_.ticks.size() < ticks_kept_) return true;
  std::vector<std::byte> snapshot = controller_.snapshot();
  const bool is_start = now_.start.first_tick == 0;
  if (snapshot.empty() && is_start && now_.ticks.size() < ticks_kept_whole_) return true;
  std::swap(before_, now_);
  now_.ticks.clear();
  now_.start = {view.tick + 1, before_.start.pose, std::move(snapshot)};
  return true;
}

Recording FlightRecorder::recording() const {
  if (before_.ticks.empty()) return now_;
  Recording joined = before_;
  joined.ticks.insert(joined.ticks.end(), now_.ticks.begin(), now_.ticks.end());
  return joined;
}

Result<RunRecorder> RunRecorder::create(const fs::path& folder, const Controller& controller,
                                        const BasePose& start) {
  if (const auto error = write_start(folder, {0, start, {}})) return *error;
  Result<NpyRowsFile> file = create_file(folder);
  if (!file) return file.errors();
  return RunRecorder(std::move(file).value(), controller);
}

bool RunRecorder::watch(const TickView& view) {
  file_.append(RecordedTick::of(view.sensors, view.motion, view.command, controller_.status()));
  return true;
}

double RecordedWorld::period() const {
  const std::vector<RecordedTick>& ticks = recording_.ticks;
  if (ticks.size() < 2) return kNominalPeriod;
  return (ticks.back().time - ticks.front().time) / static_cast<double>(ticks.size() - 1);
}

std::optional<SensorReading> RecordedWorld::sense() {
  if (next_ >= recording_.ticks.size()) return std::nullopt;
  return recording_.ticks[next_++].sensors();
}

Result<Replay> replay(const Recording& recording, Controller& controller) {
  const RecordingStart& start = recording.start;
  controller.reset(start.pose);
  if (start.first_tick > 0 && !controller.restore(start.snapshot)) {
    std::ostringstream text;
    text << "begins at tick " << start.first_tick
         << " with a memory that this controller cannot take; allowed: recordings of the same "
            "version and configuration, or of a whole run (--record)";
    return Error{kRecordingStartFile, 0, "", text.str()};
  }
  RecordedWorld world(recording);
  RecordedMotion motion(recording);
  Comparison comparison(recording, controller);
  Observer* const observer = &comparison;
  run(world, controller, motion, {&observer, 1});
  return comparison.result;
}

}  // namespace pirouette
