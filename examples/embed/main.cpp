// The controller in a program of your own: readings in, joint commands out. Here a robot that
// stands still.
#include <cstdio>

#include "pirouette/config/toml.hpp"
#include "pirouette/config/validate.hpp"
#include "pirouette/controller/spin_controller.hpp"

int main() {
  using namespace pirouette;
  const Config config = load_config({.controller = "pirouette"}).value();
  SpinController controller = SpinController::create(config, resolve_robot(config).value()).value();

  BasePose start;
  start.p_WB.z() = 0.27;
  controller.reset(start);

  SensorReading sensors;
  sensors.joint_position = PerLeg<Vec3>::filled(Vec3(0.0, 0.884, -1.865));
  sensors.specific_force_B = Vec3(0.0, 0.0, kGravity);
  sensors.foot_contact = PerLeg<bool>::filled(true);

  const MotionCommand stand;
  for (int tick = 0; tick < 100; ++tick) {
    sensors.time = tick / config.control.rate;
    controller.tick(sensors, stand);
  }
  std::printf("FR knee torque %.2f N m\n", controller.trace().command[Leg::kFR].tau.z());
  return is_stood_down(controller.status()) ? 1 : 0;
}
