// A controller and its simulated robot, tick by tick.
#pragma once

#include <stdexcept>
#include <utility>

#include "pirouette/controller/spin_controller.hpp"
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

struct ClosedLoop {
  Plant plant;
  SpinController controller;

  explicit ClosedLoop(const Config& config)
      : plant(make_plant(config)), controller(make_controller(config)) {
    controller.reset({plant.truth().base.p_WB, plant.truth().base.R_WB});
  }

  /// One control period with `sensors` in place of the plant's own.
  const JointCommand& tick(const SensorReading& sensors, const MotionCommand& command) {
    const JointCommand& joints = controller.tick(sensors, command);
    plant.advance(joints);
    return joints;
  }
  const JointCommand& tick(const MotionCommand& command) { return tick(plant.sense(), command); }

  void run(double duration, const MotionCommand& command) {
    const int ticks = static_cast<int>(std::lround(duration / kTick));
    for (int i = 0; i < ticks; ++i) tick(command);
  }
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
