#include "pirouette/model/robot_map.hpp"

#include <string>

#include "pirouette/model/leg_finder.hpp"

namespace pirouette {
namespace {

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
            report(i, "ties joint " + joint_name(model, joint) +
                          "; expected legs whose joints move by themselves");
        }
      }
    }
  }
  return errors;
}

}  // namespace

Result<RobotMap> map_robot(const mjModel& model, const RobotDescription& description) {
  RobotMap map;
  for (const Leg leg : kLegs) {
    const LegDescription& of_leg = description.legs[leg];
    LegMap& at = map.legs[leg];
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      at.joint[i] = mj_name2id(&model, mjOBJ_JOINT, of_leg.joints[i].c_str());
      at.qpos[i] = model.jnt_qposadr[at.joint[i]];
      at.dof[i] = model.jnt_dofadr[at.joint[i]];
      at.body[i] = model.jnt_bodyid[at.joint[i]];
    }
    at.foot_geom = mj_name2id(&model, mjOBJ_GEOM, foot_sphere_name(leg).c_str());
    if (at.foot_geom < 0) at.foot_geom = mj_name2id(&model, mjOBJ_GEOM, of_leg.foot.c_str());
    at.knee_sign = of_leg.knee_sign.value();
    at.tau_max = of_leg.torque.value();
    at.convention = {of_leg.sign.value(), of_leg.zero.value()};
  }
  for (int body = map.legs[Leg::kFR].body[0]; body > 0; body = model.body_parentid[body]) {
    const int joint = model.body_jntadr[body];
    if (joint < 0 || model.jnt_type[joint] != mjJNT_FREE) continue;
    map.trunk_body = body;
    map.trunk_qpos = model.jnt_qposadr[joint];
    map.trunk_dof = model.jnt_dofadr[joint];
  }
  Errors errors = find_ties(model, description.file, map);
  if (!errors.empty()) return errors;
  return map;
}

}  // namespace pirouette
