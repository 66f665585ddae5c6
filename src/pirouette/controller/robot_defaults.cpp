#include "pirouette/controller/robot_defaults.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pirouette/base/fit_to_scale.hpp"
#include "pirouette/foot/leg_kinematics.hpp"

namespace pirouette {
namespace {

/// Of clocks, computers and sensors, which do not grow with the robot.
constexpr std::array<std::string_view, 14> kSameForAll = {
    "control.rate",
    "gait.stand_time",
    "estimation.attitude_time_constant",
    "estimation.gyro_bias_time_constant",
    "estimation.gyro_rest_time",
    "estimation.gyro_bias_prior",
    "estimation.contact_debounce_time",
    "joint.filter_time",
    "safety.max_bad_reading_time",
    "safety.max_hold_time",
    "safety.max_gyro_step",
    "safety.max_accelerometer_step",
    "safety.max_repeat_time",
    "body.height",  // by standing_height()
};

/// Height of the hip axes above the feet's centres over the leg's length, of the Mini Cheetah with
/// its CoM at its default height.
constexpr double kHipHeight = 0.6177;

/// m, of the CoM above the ground, to a millimetre, with the legs as bent as the Mini Cheetah's.
double standing_height(RobotModel& robot) {
  PerLeg<Vec3> q;
  double hips = 0.0;  // above the ground, and that above the trunk's origin
  double hips_B = 0.0;
  for (const Leg leg : kLegs) {
    const LegGeometry& g = robot.legs()[leg];
    const double height = kHipHeight * (g.thigh + g.shank);
    q[leg] = inverse_kinematics(g, Vec3(0.0, g.abad_offset, -g.hip_drop - height)).q;
    hips += (height + g.foot_radius) / kLegCount;
    hips_B += (g.p_BH.z() - g.hip_drop) / kLegCount;
  }
  constexpr double kMillimetres = 1e3;
  return std::round((hips - hips_B + robot.com(q).z()) * kMillimetres) / kMillimetres;
}

}  // namespace

std::optional<UnitLaw> controller_law(std::string_view key, std::string_view unit) {
  const bool is_of_aid = key.rfind("aid.", 0) == 0;
  if (is_of_aid || std::count(kSameForAll.begin(), kSameForAll.end(), key) != 0)
    return std::nullopt;
  const UnitLaw law = unit_law(unit);
  if (law_text(law).empty()) return std::nullopt;
  return law;
}

void fit_to_robot(ControllerConfig& config, RobotModel& robot) {
  const RobotScale scale = robot.scale();
  ControllerConfig::fields(config, FitToScale("", scale.length, scale.mass, controller_law));
  config.body.height = standing_height(robot);
}

ControllerConfig default_config(RobotModel& robot) {
  ControllerConfig config;
  fit_to_robot(config, robot);
  return config;
}

}  // namespace pirouette
