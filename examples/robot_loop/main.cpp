// The main loop of a robot of your own: a World that reads its sensors and sends its joint
// commands. Here the robot is a double that stands still on four feet; on yours, sense() waits for
// the next message and send() publishes one. It links pirouette::runtime: no simulator, no TOML.
#include <cstdio>

#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/runtime/control_loop.hpp"
#include "pirouette/runtime/recording.hpp"

namespace {

using namespace pirouette;

constexpr double kRate = 500.0;          // Hz
constexpr int kTicks = 500;              // a second
constexpr double kHeight = 0.27;         // m, of the trunk
const Vec3 kStance(0.0, 0.884, -1.865);  // rad: abad, hip, knee of every leg

class MyRobot final : public World {
 public:
  double period() const override { return 1.0 / kRate; }

  std::optional<SensorReading> sense() override {
    if (tick_ == kTicks) return std::nullopt;  // the connection has ended
    SensorReading reading;
    reading.time = tick_++ * period();
    reading.joint_position = PerLeg<Vec3>::filled(kStance);
    reading.joint_velocity = PerLeg<Vec3>::filled(Vec3::Zero());
    reading.specific_force_B = Vec3(0.0, 0.0, kGravity);
    reading.foot_contact = PerLeg<bool>::filled(true);
    return reading;
  }

  void send(const JointCommand& command) override { last_ = command; }

  double knee_torque() const { return last_[Leg::kFR].tau.z(); }

 private:
  int tick_ = 0;
  JointCommand last_;
};

/// Stands; on your robot, what the operator asks for.
class Operator final : public MotionSource {
 public:
  std::optional<MotionCommand> next(std::int64_t, const PlantTruth*) override {
    return MotionCommand{};
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: robot_loop ROBOT.xml\n");
    return 2;
  }
  ControllerConfig config;
  config.control.rate = kRate;
  // This double does not move: the self-check would find that. Leave it on for a robot.
  config.safety.self_check = SelfCheckMode::kNone;
  Result<SpinController> controller = SpinController::create(config, argv[1]);
  if (!controller) {
    for (const Error& error : controller.errors()) {
      std::fprintf(stderr, "%s\n", error.to_string().c_str());
    }
    return 2;
  }
  BasePose start;
  start.p_WB.z() = kHeight;
  controller.value().reset(start);

  MyRobot robot;
  Operator command;
  FlightRecorder recorder(controller.value(), start, robot.period());
  Observer* const observers[] = {&recorder};
  run(robot, controller.value(), command, observers);

  const std::size_t ticks = recorder.recording().ticks.size();
  std::printf("%zu ticks recorded, FR knee torque %.2f N m\n", ticks, robot.knee_torque());
  return is_stood_down(controller.value().status()) || ticks != kTicks ? 1 : 0;
}
