// --robot FILE.xml: what loads has legs of finite size and a positive mass.
#include <cmath>

#include "input_file.hpp"
#include "pirouette/base/legs.hpp"
#include "pirouette/model/robot_model.hpp"

using pirouette::kLegs;
using pirouette::Leg;
using pirouette::Result;
using pirouette::RobotModel;
using pirouette::fuzz::InputFile;
using pirouette::fuzz::require;
using pirouette::fuzz::require_reasons;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const InputFile file(".xml");
  const Result<RobotModel> robot = RobotModel::load(file.write(data, size).string());
  if (!robot) {
    require_reasons(robot);
    return 0;
  }
  require(std::isfinite(robot.value().mass()) && robot.value().mass() > 0.0, "a robot has a mass");
  for (const Leg leg : kLegs) {
    const auto& geometry = robot.value().legs()[leg];
    require(std::isfinite(geometry.thigh) && geometry.thigh > 0.0, "a leg has a thigh");
    require(std::isfinite(geometry.shank) && geometry.shank > 0.0, "a leg has a shank");
    require(geometry.tau_max.allFinite(), "motors have limits");
  }
  return 0;
}
