// A controller and its simulated robot, tick by tick.
#pragma once

#include <optional>
#include <stdexcept>
#include <utility>

#include "pirouette/controller/spin_controller.hpp"
#include "pirouette/runtime/control_loop.hpp"
#include "support/mini_cheetah.hpp"

namespace pirouette::test {

inline SpinController make_controller(const Config& config) {
  Result<SpinController> controller = SpinController::create(config, kRobot);
  if (!controller) throw std::runtime_error(controller.errors().front().to_string());
  return std::move(controller).value();
}

inline MotionCommand stand_still() { return {}; }

inline MotionCommand spin(double yaw_rate) {
  MotionCommand command;
  command.walk = true;
  command.yaw_rate = yaw_rate;
  return command;
}

/// A simulated world whose next reading a test may replace.
class SpoiltWorld final : public World {
 public:
  explicit SpoiltWorld(Plant& plant) : plant_(plant) {}

  double period() const override { return plant_.period(); }
  std::optional<SensorReading> sense() override {
    if (!instead) return plant_.sense();
    return std::exchange(instead, std::nullopt);
  }
  void send(const JointCommand& command) override { plant_.advance(command); }
  const PlantTruth* truth() const override { return &plant_.truth(); }

  std::optional<SensorReading> instead;

 private:
  Plant& plant_;
};

class ClosedLoop {
 public:
  Plant plant;
  SpinController controller;

  explicit ClosedLoop(const Config& config)
      : ClosedLoop(make_plant(config), make_controller(config)) {}
  ClosedLoop(Plant in, SpinController by)
      : plant(std::move(in)), controller(std::move(by)), world_(plant), loop_(world_, controller) {
    controller.reset({plant.truth().base.p_WB, plant.truth().base.R_WB});
  }
  ClosedLoop(const ClosedLoop&) = delete;
  ClosedLoop& operator=(const ClosedLoop&) = delete;

  /// One control period with `sensors` in place of the plant's own.
  const JointCommand& tick(const SensorReading& sensors, const MotionCommand& command) {
    world_.instead = sensors;
    return tick(command);
  }
  const JointCommand& tick(const MotionCommand& command) {
    loop_.tick(command);
    loop_.send();
    return controller.trace().command;
  }

  void run(double duration, const MotionCommand& command) {
    const int ticks = static_cast<int>(std::lround(duration / kTick));
    for (int i = 0; i < ticks; ++i) tick(command);
  }

 private:
  SpoiltWorld world_;
  ControlLoop loop_;
};

inline bool is_finite(const JointCommand& command) {
  for (const LegCommand& c : command) {
    if (!c.q.allFinite() || !c.dq.allFinite() || !c.kp.allFinite() || !c.kd.allFinite() ||
        !c.tau.allFinite()) {
      return false;
    }
  }
  return true;
}

/// Bit for bit.
inline bool equal(const JointCommand& a, const JointCommand& b) {
  for (const Leg leg : kLegs) {
    if (a[leg].q != b[leg].q || a[leg].dq != b[leg].dq || a[leg].kp != b[leg].kp ||
        a[leg].kd != b[leg].kd || a[leg].tau != b[leg].tau) {
      return false;
    }
  }
  return true;
}

}  // namespace pirouette::test
