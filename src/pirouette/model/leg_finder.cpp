#include "pirouette/model/leg_finder.hpp"

#include <algorithm>
#include <cmath>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

constexpr double kParallel = 0.999;   ///< cosine of about 2.5 degrees
constexpr double kAcross = 0.05;      ///< cosine of about 87 degrees
constexpr double kSmallAngle = 1e-6;  ///< rad, counts as none

using RowMajorMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Direction of a joint's axis in trunk axes.
Vec3 axis_B(const mjData& d, int joint, int trunk) {
  const RowMajorMat3 R_WB = Eigen::Map<const RowMajorMat3>(d.xmat + 9 * trunk);
  return R_WB.transpose() * Eigen::Map<const Vec3>(d.xaxis + 3 * joint);
}

/// Place of a point in trunk axes.
Vec3 point_B(const mjData& d, const Vec3& p_W, int trunk) {
  const RowMajorMat3 R_WB = Eigen::Map<const RowMajorMat3>(d.xmat + 9 * trunk);
  return R_WB.transpose() * (p_W - Eigen::Map<const Vec3>(d.xpos + 3 * trunk));
}

Vec3 anchor_W(const mjData& d, int joint) { return Eigen::Map<const Vec3>(d.xanchor + 3 * joint); }

/// The joint that carries `joint`; -1: the trunk does.
int parent_joint(const mjModel& m, int joint, int trunk) {
  int body = m.jnt_bodyid[joint];
  if (joint > m.body_jntadr[body]) return joint - 1;
  for (body = m.body_parentid[body]; body > trunk; body = m.body_parentid[body]) {
    if (m.body_jntnum[body] > 0) return m.body_jntadr[body] + m.body_jntnum[body] - 1;
  }
  return -1;
}

/// All joints of one limb, from the trunk outwards.
using Limb = std::vector<int>;

std::vector<Limb> limbs_of(const mjModel& m, int trunk) {
  std::map<int, std::size_t> limb_of_joint;
  std::vector<Limb> limbs;
  for (int j = 0; j < m.njnt; ++j) {  // parents come first
    if (m.jnt_bodyid[j] == trunk || !is_below(m, m.jnt_bodyid[j], trunk)) continue;
    const int parent = parent_joint(m, j, trunk);
    const auto found = limb_of_joint.find(parent);
    limb_of_joint[j] = found == limb_of_joint.end() ? limbs.size() : found->second;
    if (found == limb_of_joint.end()) limbs.emplace_back();
    limbs[limb_of_joint[j]].push_back(j);
  }
  return limbs;
}

/// True: the first three joints of the limb are those of a leg, one on the other.
bool begins_as_leg(const mjModel& m, const mjData& d, const Limb& limb, int trunk) {
  if (limb.size() < kJointsPerLeg) return false;
  for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
    if (m.jnt_type[limb[i]] != mjJNT_HINGE) return false;
    if (i > 0 && parent_joint(m, limb[i], trunk) != limb[i - 1]) return false;
  }
  const Vec3 abad = axis_B(d, limb[0], trunk), hip = axis_B(d, limb[1], trunk),
             knee = axis_B(d, limb[2], trunk);
  return std::abs(abad.x()) > kParallel && std::abs(hip.dot(abad)) < kAcross &&
         std::abs(hip.dot(knee)) > kParallel;
}

/// "x", "-y" ... of an axis of the trunk, "oblique" for any other direction.
std::string direction(const Vec3& axis) {
  static constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const double along = axis[static_cast<Eigen::Index>(i)];
    if (std::abs(along) > kParallel) return (along < 0.0 ? "-" : "") + std::string(kNames.at(i));
  }
  return "oblique";
}

std::string describe(const mjModel& m, const mjData& d, const Limb& limb, int trunk) {
  std::string text;
  for (const int joint : limb) {
    text += text.empty() ? "" : ", ";
    text += joint_name(m, joint) + " (" +
            (m.jnt_type[joint] == mjJNT_HINGE ? direction(axis_B(d, joint, trunk))
                                              : std::string("no hinge")) +
            ")";
  }
  return text;
}

std::string list_of(const mjModel& m, const std::vector<int>& joints) {
  std::string text;
  for (const int joint : joints) text += (text.empty() ? "" : ", ") + joint_name(m, joint);
  return text;
}

/// What the robot is instead of a quadruped with three joints a leg.
std::string what_it_is(const mjModel& m, const mjData& d, const std::vector<Limb>& limbs,
                       int trunk) {
  std::vector<int> fourth, of_two;
  std::size_t legs = 0, two = 0;
  for (const Limb& limb : limbs) {
    const bool is_leg = begins_as_leg(m, d, limb, trunk);
    legs += is_leg && limb.size() == kJointsPerLeg;
    if (is_leg && limb.size() > kJointsPerLeg)
      fourth.insert(fourth.end(), limb.begin() + kJointsPerLeg, limb.end());
    if (limb.size() == 2 && std::abs(axis_B(d, limb[0], trunk).y()) > kParallel &&
        std::abs(axis_B(d, limb[1], trunk).y()) > kParallel) {
      ++two;
      of_two.insert(of_two.end(), limb.begin(), limb.end());
    }
  }
  if (!fourth.empty()) {
    return "its legs have a fourth joint (" + list_of(m, fourth) +
           "): wheels or ankles. If they are to be held, say so in a robot.toml: [locked] " +
           joint_name(m, fourth.front()) + " = 0.0 ...";
  }
  if (two == kLegCount) {
    return "its legs have two joints (" + list_of(m, of_two) +
           "): without an abad joint it cannot place its feet sideways";
  }
  std::string text = "it has " + std::to_string(legs) +
                     " legs of three joints (abad about the trunk's x, hip and knee across it); "
                     "expected 4. Limbs on the trunk:";
  if (limbs.empty()) return text + " none";
  for (std::size_t i = 0; i < limbs.size(); ++i)
    text += (i == 0 ? " " : "; ") + describe(m, d, limbs[i], trunk);
  return text;
}

int find_trunk(const mjModel& m) {
  for (int j = 0; j < m.njnt; ++j)
    if (m.jnt_type[j] == mjJNT_FREE) return m.jnt_bodyid[j];
  return -1;
}

/// Joints that the description names, or what is wrong with the names.
Errors named_legs(const mjModel& m, const RobotDescription& given, PerLeg<LegJoints>& legs) {
  Errors errors;
  const std::string& where = given.source.empty() ? given.file : given.source;
  for (const Leg leg : kLegs) {
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      const std::string& wanted = given.legs[leg].joints[i];
      const int joint = mj_name2id(&m, mjOBJ_JOINT, wanted.c_str());
      legs[leg][i] = joint;
      if (joint >= 0 && m.jnt_type[joint] == mjJNT_HINGE) continue;
      errors.push_back({where, 0, "legs." + std::string(name(leg)) + ".joints",
                        "given \"" + wanted + "\"; allowed: the hinge joints of " + given.file +
                            ": " + list_joints(m)});
    }
  }
  return errors;
}

/// Puts four legs in the order of their places.
bool sort_legs(const mjData& d, int trunk, const std::vector<Limb>& found,
               PerLeg<LegJoints>& legs) {
  std::vector<Vec3> places;
  Vec3 middle = Vec3::Zero();
  for (const Limb& limb : found) {
    places.push_back(point_B(d, anchor_W(d, limb[1]), trunk));
    middle += places.back() / static_cast<double>(found.size());
  }
  PerLeg<int> count{};
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const Leg leg : kLegs) {
      const Vec3 from_middle = places[i] - middle;
      if (from_middle.x() * fore_sign(leg) <= 0.0 || from_middle.y() * side_sign(leg) <= 0.0)
        continue;
      ++count[leg];
      std::copy(found[i].begin(), found[i].end(), legs[leg].begin());
    }
  }
  return std::all_of(count.begin(), count.end(), [](int n) { return n == 1; });
}

/// Half of the largest range about zero within `range`.
double half_width(const mjtNum* range) { return std::min(-range[0], range[1]); }

}  // namespace

std::string joint_name(const mjModel& model, int joint) {
  const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
  return name ? name : "(unnamed)";
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
    out +=
        joint_name(model, j) + " (" + kTypes.at(static_cast<std::size_t>(model.jnt_type[j])) + ")";
  }
  return out.empty() ? "none" : out;
}

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

Result<JointRoles> find_legs(const mjModel& m, const mjData& d, const RobotDescription& given) {
  JointRoles roles;
  roles.trunk = find_trunk(m);
  if (roles.trunk < 0) {
    return Error{
        given.file, 0, "",
        "no quadruped: no free joint, and no body with legs that could have one; joints of "
        "this file: " +
            list_joints(m)};
  }
  const std::vector<Limb> limbs = limbs_of(m, roles.trunk);
  if (given.legs[Leg::kFR].joints[0].empty()) {
    std::vector<Limb> found;
    for (const Limb& limb : limbs) {
      if (limb.size() == kJointsPerLeg && begins_as_leg(m, d, limb, roles.trunk))
        found.push_back(limb);
    }
    if (found.size() != kLegCount)
      return Error{given.file, 0, "", "no quadruped: " + what_it_is(m, d, limbs, roles.trunk)};
    if (!sort_legs(d, roles.trunk, found, roles.legs)) {
      return Error{given.file, 0, "",
                   "no quadruped: its four legs are not one front right, front left, rear right "
                   "and rear left (x forward, y left)"};
    }
  } else if (Errors errors = named_legs(m, given, roles.legs); !errors.empty()) {
    return errors;
  }
  Errors errors;
  for (const Leg leg : kLegs) {
    const LegJoints& joints = roles.legs[leg];
    if (begins_as_leg(m, d, Limb(joints.begin(), joints.end()), roles.trunk)) continue;
    errors.push_back({given.file, 0, std::string(name(leg)),
                      "expected a chain abad (about the trunk's x), hip and knee (parallel, across "
                      "the abad); it is " +
                          describe(m, d, Limb(joints.begin(), joints.end()), roles.trunk)});
  }
  if (!errors.empty()) return errors;
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_bodyid[j] == roles.trunk) continue;
    const bool is_of_leg = std::any_of(roles.legs.begin(), roles.legs.end(), [j](const auto& leg) {
      return std::find(leg.begin(), leg.end(), j) != leg.end();
    });
    if (!is_of_leg) roles.others.push_back(j);
  }
  return roles;
}

JointConvention find_convention(const mjModel& m, const mjData& d, int trunk,
                                const LegJoints& joints, const Vec3& p_WF) {
  const auto snapped = [](double angle) { return std::abs(angle) < kSmallAngle ? 0.0 : angle; };
  JointConvention out;
  Vec3 offset;  // of LegGeometry's angle where the file's is 0
  out.sign[0] = axis_B(d, joints[0], trunk).x() > 0.0 ? 1.0 : -1.0;
  const Vec3 hip_axis = axis_B(d, joints[1], trunk);
  const double inclination = std::atan2(hip_axis.z(), hip_axis.y());
  const bool is_reversed = std::abs(inclination) > 0.5 * kPi;
  offset[0] = snapped(is_reversed ? wrap_angle(inclination - kPi) : inclination);
  const Mat3 level = rot_x(-offset[0]);
  out.sign[1] = (level * hip_axis).y() > 0.0 ? 1.0 : -1.0;
  out.sign[2] = (level * axis_B(d, joints[2], trunk)).y() > 0.0 ? 1.0 : -1.0;

  const Vec3 hip = point_B(d, anchor_W(d, joints[1]), trunk);
  const Vec3 knee = point_B(d, anchor_W(d, joints[2]), trunk);
  const Vec3 thigh = level * (knee - hip);
  const Vec3 shank = level * (point_B(d, p_WF, trunk) - knee);
  const double thigh_angle = std::atan2(-thigh.x(), -thigh.z());
  const double shank_angle = std::atan2(-shank.x(), -shank.z());
  offset[1] = snapped(thigh_angle);
  offset[2] = snapped(wrap_angle(shank_angle - thigh_angle));

  for (Eigen::Index i = 0; i < 3; ++i) {
    double& zero = out.zero[i];
    zero = offset[i] == 0.0 ? 0.0 : -out.sign[i] * offset[i];
    const int joint = joints[static_cast<std::size_t>(i)];
    const mjtNum* range = m.jnt_range + 2 * joint;
    if (!m.jnt_limited[joint]) continue;
    const double middle = out.sign[i] * (0.5 * (range[0] + range[1]) - zero);
    zero += out.sign[i] * 2.0 * kPi * std::round(middle / (2.0 * kPi));
  }
  return out;
}

}  // namespace pirouette
