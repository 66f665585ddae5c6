#include "pirouette/study/robot_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "pirouette/base/rotation.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/toml.hpp"
#include "pirouette/foot/leg_kinematics.hpp"
#include "pirouette/model/robot_model.hpp"
#include "pirouette/model/robot_text.hpp"

namespace pirouette {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, kJointsPerLeg> kRoles = {"abad", "hip", "knee"};
constexpr double kHardWork = 0.6;  ///< share of a motor's torque above which it is worth a word
constexpr double kFarCom = 0.15;   ///< of the distance of the hips
constexpr double kUnequal = 0.01;  ///< share by which feet differ

std::string number(double value, int digits = 3) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

/// Joint positions of a leg in trunk axes: abad axis beside the hip, hip, knee, foot.
std::array<Vec3, 4> points_of(const LegGeometry& leg, const Vec3& q) {
  LegGeometry to_hip = leg, to_knee = leg;
  to_hip.thigh = to_hip.shank = 0.0;
  to_knee.shank = 0.0;
  return {leg.p_BH, leg.p_BH + foot_position_H(to_hip, q), leg.p_BH + foot_position_H(to_knee, q),
          leg.p_BH + foot_position_H(leg, q)};
}

std::vector<std::string> remarks_of(const RobotCheck& check) {
  std::vector<std::string> out;
  const auto& legs = check.legs;
  int forward = 0;
  double hips = 0.0, least_foot = 1e9, most_foot = 0.0;
  Vec2 centre = Vec2::Zero();
  for (const LegGeometry& leg : legs) {
    forward += leg.knee_sign > 0.0;
    centre += leg.p_BH.head<2>() / kLegCount;
    hips = std::max(hips, 2.0 * std::abs(leg.p_BH.x()));
    least_foot = std::min(least_foot, leg.foot_radius);
    most_foot = std::max(most_foot, leg.foot_radius);
  }
  if (forward != 0 && forward != static_cast<int>(kLegCount))
    out.push_back("some knees bend forward, some backward");
  if (most_foot > (1.0 + kUnequal) * least_foot) {
    out.push_back("the feet have radii from " + number(1e3 * least_foot) + " to " +
                  number(1e3 * most_foot) + " mm");
  }
  const Vec2 off = check.standing.p_BG.head<2>() - centre;
  if (off.norm() > kFarCom * hips) {
    out.push_back("the CoM is " + number(1e3 * off.x()) + ", " + number(1e3 * off.y()) +
                  " mm (forward, left) from the middle of the hips");
  }
  for (const Leg leg : kLegs) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double share = std::abs(check.standing.torque[leg][i]) / legs[leg].tau_max[i];
      if (share <= kHardWork || share > 1.0) continue;
      out.push_back(std::string(name(leg)) + " " + kRoles.at(static_cast<std::size_t>(i)) +
                    " uses " + std::to_string(std::lround(100.0 * share)) +
                    " % of its motor's torque to carry half the weight");
    }
  }
  return out;
}

Json json_of(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

}  // namespace

Result<RobotCheck> check_robot(const std::string& robot) {
  ConfigSources sources;
  sources.robot = robot;
  const Result<Config> config = load_config(sources);
  if (!config) return config.errors();
  const Result<RobotDescription> description = resolve_robot(config.value());
  if (!description) return description.errors();
  Result<RobotModel> model = RobotModel::load(description.value());
  if (!model) return model.errors();

  RobotCheck out;
  out.description = model.value().description();
  out.notes = model.value().notes();
  out.mass = model.value().mass();
  out.scale = model.value().scale();
  out.height = config.value().body.height;
  out.legs = model.value().legs();
  out.standing = standing_load(model.value(), out.height);
  out.problems = check_standing(config.value(), model.value());
  for (Error& problem : out.problems) problem.file = out.description.file;
  out.remarks = remarks_of(out);
  return out;
}

Result<std::string> read_robot_mjcf(const std::string& robot) {
  Config config;
  config.robot = robot;
  const Result<RobotDescription> description = resolve_robot(config);
  if (!description) return description.errors();
  return robot_mjcf(description.value());
}

std::string robot_check_text(const RobotCheck& check) {
  std::ostringstream text;
  const LegGeometry& leg = check.legs[Leg::kFR];
  text << "Robot      " << check.description.file << "\n"
       << "mass       " << number(check.mass, 4) << " kg, u = " << number(check.scale.mass, 4)
       << " of the Mini Cheetah's\n"
       << "legs       " << number(leg.thigh) << " + " << number(leg.shank)
       << " m, l = " << number(check.scale.length, 4) << ", foot radius "
       << number(1e3 * leg.foot_radius) << " mm";
  if (leg.hip_drop != 0.0)
    text << ", hip axis " << number(1e3 * leg.hip_drop) << " mm below the abad's";
  text << "\nheight     " << number(check.height)
       << " m, of the CoM above the ground (body.height)\n"
       << "CoM        " << number(1e3 * check.standing.p_BG.x()) << ", "
       << number(1e3 * check.standing.p_BG.y()) << ", " << number(1e3 * check.standing.p_BG.z())
       << " mm from the trunk's origin (standing)\n"
       << "IMU        "
       << (check.description.imu.empty() ? std::string("none named; taken at the trunk's origin")
                                         : "site " + check.description.imu)
       << "\n\n";

  std::size_t width = 5;
  for (const LegDescription& l : check.description.legs)
    for (const std::string& joint : l.joints) width = std::max(width, joint.size());
  const auto column = [&](const std::string& cell, std::size_t size) {
    text << std::left << std::setw(static_cast<int>(size)) << cell << "  ";
  };
  column("joint", width);
  column("is", 8);
  column("sign", 4);
  column("zero rad", 9);
  column("range rad", 15);
  column("torque N m", 10);
  text << "standing\n";
  for (const Leg l : kLegs) {
    const LegDescription& said = check.description.legs[l];
    const LegGeometry& g = check.legs[l];
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double torque = std::abs(check.standing.torque[l][at]);
      column(said.joints[i], width);
      column(std::string(name(l)) + " " + kRoles.at(i), 8);
      column((*said.sign)[at] > 0.0 ? "+" : "-", 4);
      column(number((*said.zero)[at]), 9);
      column(number(g.q_min[at]) + " " + number(g.q_max[at]), 15);
      column(number(g.tau_max[at], 4), 10);
      text << std::lround(100.0 * torque / g.tau_max[at]) << " %\n";
    }
  }
  text << "\nfeet       ";
  for (const Leg l : kLegs) {
    text << (l == Leg::kFR ? "" : ", ") << name(l) << " " << check.description.legs[l].foot << " ("
         << (check.legs[l].knee_sign < 0.0 ? "knee backward)" : "knee forward)");
  }
  text << "\n";
  const auto list = [&](const char* title, const std::vector<std::string>& lines) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      text << (i == 0 ? title : "           ") << lines[i] << "\n";
  };
  list("mended     ", check.notes);
  list("notice     ", check.remarks);
  if (check.problems.empty()) text << "\nIt can walk.\n";
  return text.str();
}

std::string robot_check_json(const RobotCheck& check) {
  Json out;
  out["file"] = check.description.file;
  out["mass"] = check.mass;
  out["scale"] = {{"length", check.scale.length}, {"mass", check.scale.mass}};
  out["height"] = check.height;
  out["com_B"] = json_of(check.standing.p_BG);
  out["imu"] = check.description.imu;
  for (const Leg leg : kLegs) {
    const LegDescription& said = check.description.legs[leg];
    const LegGeometry& g = check.legs[leg];
    const Vec3& q = check.standing.q[leg];
    Json& l = out["legs"][std::string(name(leg))];
    l["joints"] = said.joints;
    l["sign"] = json_of(*said.sign);
    l["zero"] = json_of(*said.zero);
    l["knee"] = g.knee_sign < 0.0 ? "backward" : "forward";
    l["foot"] = said.foot;
    l["foot_radius"] = g.foot_radius;
    l["thigh"] = g.thigh;
    l["shank"] = g.shank;
    l["q_min"] = json_of(g.q_min);
    l["q_max"] = json_of(g.q_max);
    l["torque"] = json_of(g.tau_max);
    l["standing_torque"] = json_of(check.standing.torque[leg]);
    l["standing_q"] = json_of(q);
    for (const Vec3& point : points_of(g, q)) l["points_B"].push_back(json_of(point));
    const Vec3 across = rot_x(q[0]).col(1);
    l["axes_B"] =
        Json::array({json_of((*said.sign)[0] * Vec3::UnitX()), json_of((*said.sign)[1] * across),
                     json_of((*said.sign)[2] * across)});
  }
  out["notes"] = check.notes;
  out["remarks"] = check.remarks;
  out["problems"] = Json::array();
  for (const Error& problem : check.problems) out["problems"].push_back(problem.to_string());
  return out.dump(2) + "\n";
}

}  // namespace pirouette
