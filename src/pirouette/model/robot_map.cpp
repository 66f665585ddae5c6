#include "pirouette/model/robot_map.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "pirouette/model/mujoco.hpp"

namespace pirouette {
namespace {

/// An axis counts as x or y if it is within about 2.5 degrees of it.
constexpr double kAxisCosine = 0.999;

std::string_view joint_name(const mjModel& model, int joint) {
  const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
  return name ? name : "(unnamed)";
}

bool begins_with_leg(std::string_view text, Leg leg) {
  const std::string_view prefix = name(leg);
  return text.size() >= prefix.size() &&
         std::equal(prefix.begin(), prefix.end(), text.begin(), [](char a, char b) {
           return a == std::toupper(static_cast<unsigned char>(b));
         });
}

bool is_below(const mjModel& model, int body, int ancestor) {
  while (body > ancestor) body = model.body_parentid[body];
  return body == ancestor;
}

std::string list_joints(const mjModel& model) {
  static constexpr std::array<const char*, 4> kTypes = {"free", "ball", "slide", "hinge"};
  std::string out;
  for (int j = 0; j < model.njnt; ++j) {
    out += out.empty() ? "" : ", ";
    out += std::string(joint_name(model, j)) + " (" +
           kTypes.at(static_cast<std::size_t>(model.jnt_type[j])) + ")";
  }
  return out.empty() ? "none" : out;
}

/// Largest torque that every bound in force allows, from a range that holds zero.
double half_width(const mjtNum* range) { return std::min(-range[0], range[1]); }

double torque_limit(const mjModel& model, int joint) {
  if (model.jnt_actfrclimited[joint]) return half_width(model.jnt_actfrcrange + 2 * joint);
  for (int a = 0; a < model.nactuator; ++a) {
    if (model.actuator_trntype[a] != mjTRN_JOINT || model.actuator_trnid[2 * a] != joint) continue;
    const double gear = std::abs(model.actuator_gear[6 * model.actuator_outadr[a]]);
    if (model.actuator_forcelimited[a]) return gear * half_width(model.actuator_forcerange + 2 * a);
    const int control = model.actuator_ctrladr[a];
    const bool is_motor =
        model.actuator_gaintype[a] == mjGAIN_FIXED && model.actuator_biastype[a] == mjBIAS_NONE;
    if (is_motor && model.actuator_ctrllimited[control]) {
      return gear * model.actuator_gainprm[mjNGAIN * a] *
             half_width(model.actuator_ctrlrange + 2 * control);
    }
  }
  return kNoTorqueLimit;
}

double knee_sign(const mjModel& model, int joint) {
  const mjtNum* range = model.jnt_range + 2 * joint;
  if (model.jnt_limited[joint] && range[1] <= 0.0) return -1.0;
  if (model.jnt_limited[joint] && range[0] >= 0.0) return 1.0;
  const bool key_bends_forward = model.nkey > 0 && model.key_qpos[model.jnt_qposadr[joint]] > 0.0;
  return key_bends_forward ? 1.0 : -1.0;
}

/// Foot sphere among the geoms fixed to body `shank`; -1: none. `data` holds the pose at q = 0.
int find_foot(const mjModel& model, const mjData& data, Leg leg, int shank) {
  int foot = -1;
  bool foot_is_named = false;
  for (int g = 0; g < model.ngeom; ++g) {
    const bool fixed_to_shank = model.body_weldid[model.geom_bodyid[g]] == model.body_weldid[shank];
    const bool collides = model.geom_contype[g] != 0 || model.geom_conaffinity[g] != 0;
    if (!fixed_to_shank || !collides || model.geom_type[g] != mjGEOM_SPHERE) continue;
    const char* geom_name = mj_id2name(&model, mjOBJ_GEOM, g);
    const bool is_named = geom_name && begins_with_leg(geom_name, leg);
    const bool is_lower = foot < 0 || data.geom_xpos[3 * g + 2] < data.geom_xpos[3 * foot + 2];
    if (is_named > foot_is_named || (is_named == foot_is_named && is_lower)) {
      foot = g;
      foot_is_named = is_named;
    }
  }
  return foot;
}

/// Direction of a joint's axis in trunk axes.
Vec3 axis_in_trunk(const mjData& data, int joint, int trunk) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_WB(data.xmat + 9 * trunk);
  return R_WB.transpose() * Eigen::Map<const Vec3>(data.xaxis + 3 * joint);
}

/// Fills `map` for one leg, or says what is wrong with it.
Errors map_leg(const mjModel& model, const mjData& data, const std::string& file, int trunk,
               Leg leg, LegMap& map) {
  Errors errors;
  const auto fail = [&](const std::string& message) {
    errors.push_back({file, 0, std::string(name(leg)), message});
  };

  std::vector<int> chain;  // MuJoCo numbers joints from the trunk outwards
  for (int j = 0; j < model.njnt; ++j) {
    const bool is_of_leg =
        model.jnt_type[j] == mjJNT_HINGE && begins_with_leg(joint_name(model, j), leg);
    if (is_of_leg && is_below(model, model.jnt_bodyid[j], trunk)) chain.push_back(j);
  }
  if (chain.size() != kJointsPerLeg) {
    fail("has " + std::to_string(chain.size()) + " hinge joints whose name begins with " +
         std::string(name(leg)) + "; expected 3: abad, hip, knee");
    return errors;
  }

  for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
    const int joint = chain[i];
    map.joint[i] = joint;
    map.qpos[i] = model.jnt_qposadr[joint];
    map.dof[i] = model.jnt_dofadr[joint];
    map.body[i] = model.jnt_bodyid[joint];
    map.tau_max[static_cast<Eigen::Index>(i)] = torque_limit(model, joint);
    if (map.tau_max[static_cast<Eigen::Index>(i)] <= 0.0) {
      fail("joint " + std::string(joint_name(model, joint)) +
           " has a torque range without torque; allowed: a range about 0, such as -17 17, or none");
    }
    if (i > 0 && !is_below(model, map.body[i], map.body[i - 1])) {
      fail("joint " + std::string(joint_name(model, joint)) + " is not below joint " +
           std::string(joint_name(model, chain[i - 1])) + "; expected one chain abad, hip, knee");
    }
    const bool is_abad = i == 0;
    if (axis_in_trunk(data, joint, trunk)[is_abad ? 0 : 1] < kAxisCosine) {
      fail("joint " + std::string(joint_name(model, joint)) + " must turn about " +
           (is_abad ? "+x" : "+y") + " of the trunk when all joints are at 0");
    }
  }
  map.knee_sign = knee_sign(model, chain[2]);

  map.foot_geom = find_foot(model, data, leg, map.body[2]);
  if (map.foot_geom < 0) {
    const char* shank = mj_id2name(&model, mjOBJ_BODY, map.body[2]);
    fail("body " + std::string(shank ? shank : "(unnamed)") + " has no colliding sphere as a foot");
  }
  return errors;
}

/// Constraints that tie the robot to the world or one of its leg joints to something.
Errors find_ties(const mjModel& model, const std::string& file, const RobotMap& map) {
  Errors errors;
  const auto report = [&](int i, const std::string& what) {
    const char* given = mj_id2name(&model, mjOBJ_EQUALITY, i);
    const std::string constraint = given ? given : "number " + std::to_string(i + 1);
    errors.push_back({file, 0, "equality", "constraint " + constraint + " " + what});
  };
  for (int i = 0; i < model.neq; ++i) {
    if (!model.eq_active0[i]) continue;
    const int first = model.eq_obj1id[i], second = model.eq_obj2id[i];
    const int type = model.eq_type[i];
    if (type == mjEQ_CONNECT || type == mjEQ_WELD) {
      const bool of_sites = model.eq_objtype[i] == mjOBJ_SITE;
      const int one = of_sites ? model.site_bodyid[first] : first;
      const int other = of_sites ? model.site_bodyid[second] : second;
      const auto is_fixed = [&](int body) { return model.body_weldid[body] == 0; };
      const auto is_robot = [&](int body) {
        return body == map.trunk_body || is_below(model, body, map.trunk_body);
      };
      if ((is_fixed(one) && is_robot(other)) || (is_fixed(other) && is_robot(one)))
        report(i, "ties the robot to the world; expected a robot that can move");
    } else if (type == mjEQ_JOINT) {
      for (const Leg leg : kLegs) {
        for (const int joint : map.legs[leg].joint) {
          if (joint == first || joint == second)
            report(i, "ties joint " + std::string(joint_name(model, joint)) +
                          "; expected legs whose joints move by themselves");
        }
      }
    }
  }
  return errors;
}

}  // namespace

Result<RobotMap> map_robot(const mjModel& model, const std::string& file) {
  RobotMap map;
  for (int j = 0; j < model.njnt && map.trunk_body < 0; ++j) {
    if (model.jnt_type[j] != mjJNT_FREE) continue;
    map.trunk_body = model.jnt_bodyid[j];
    map.trunk_qpos = model.jnt_qposadr[j];
    map.trunk_dof = model.jnt_dofadr[j];
  }

  Errors errors;
  if (map.trunk_body < 0) {
    errors.push_back({file, 0, "", "no free joint; expected one, on the trunk"});
  } else {
    const DataPtr data(mj_makeData(&model));
    for (int j = 0; j < model.njnt; ++j) {
      if (model.jnt_type[j] == mjJNT_HINGE) data->qpos[model.jnt_qposadr[j]] = 0.0;
    }
    mj_kinematics(&model, data.get());
    for (const Leg leg : kLegs) {
      const Errors found = map_leg(model, *data, file, map.trunk_body, leg, map.legs[leg]);
      errors.insert(errors.end(), found.begin(), found.end());
    }
  }
  if (errors.empty()) {
    errors = find_ties(model, file, map);
  } else {
    errors.front().message += "; joints of this file: " + list_joints(model);
  }
  if (errors.empty()) return map;
  return errors;
}

}  // namespace pirouette
