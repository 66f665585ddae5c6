#include "pirouette/model/robot_reader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <utility>

#include "pirouette/base/rotation.hpp"
#include "pirouette/model/foot_finder.hpp"
#include "pirouette/model/leg_finder.hpp"
#include "pirouette/model/robot_text.hpp"
#include "pirouette/model/spec_repair.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;
using RowMajorMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kStandingThigh = 0.8;     ///< rad, of a leg that stands
constexpr double kOneSided = 0.1;          ///< a knee's range on one side, of that on the other
constexpr int kMeetsGround = 1;            ///< bit of contype that the ground's geoms have
constexpr double kAsFar = 0.005;           ///< of a foot's distance from the knee
constexpr double kMostUnequalRadii = 1.5;  ///< largest over smallest foot

std::string extension(const std::string& file) {
  std::string text = fs::path(file).extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// A number with four digits.
std::string shown(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

template <class Visit>
void for_each(mjSpec& spec, mjtObj type, Visit&& visit) {
  std::vector<mjsElement*> all;
  for (mjsElement* e = mjs_firstElement(&spec, type); e; e = mjs_nextElement(&spec, e))
    all.push_back(e);
  for (mjsElement* e : all) visit(e);
}

/// One reading of a file.
class Reader {
 public:
  explicit Reader(const RobotDescription& given) : given_(given), full_(given) {}

  Result<ReadRobot> read();

 private:
  Errors open();
  Errors compile();
  /// Takes the pose of the first keyframe for what `given` has no pose of.
  void read_pose();
  Errors lock(const std::string& joint, double value);
  Errors lock_given();
  Errors lock_others();
  void set_zero_pose();
  Errors find_feet();
  void find_conventions();
  double find_knee_sign(Leg leg);
  void place_foot(Leg leg, const Foot& foot);
  Errors read_limits();
  void part_touching_bodies();
  void find_imu();
  void note_what_is_assumed();

  mjModel& m() { return *model_; }
  mjData& d() { return *data_; }
  int shank(Leg leg) { return m().jnt_bodyid[roles_.legs[leg][2]]; }
  std::string where() const { return given_.source.empty() ? given_.file : given_.source; }

  const RobotDescription& given_;
  RobotDescription full_;
  SpecPtr spec_;
  ModelPtr model_;
  DataPtr data_;
  JointRoles roles_;
  PerLeg<Foot> feet_{};
  std::map<std::string, double> pose_;
  std::vector<std::string> notes_;
  std::vector<Leg> knees_assumed_;
};

Errors Reader::open() {
  std::array<char, 1024> message{};
  spec_.reset(
      mj_parseXML(given_.file.c_str(), nullptr, message.data(), static_cast<int>(message.size())));
  if (!spec_)
    return {
        {given_.file, 0, "", std::string("not a readable MJCF or URDF file: ") + message.data()}};
  mjSpec& spec = *spec_;
  spec.compiler.alignfree = 0;                     // the trunk keeps its axes
  for (const LegDescription& leg : given_.legs) {  // a body that is named must be found again
    if (mjsBody* body = leg.foot.empty() ? nullptr : mjs_findBody(&spec, leg.foot.c_str()))
      body->fuse = 0;
  }
  if (extension(given_.file) == ".urdf") {
    for_each(spec, mjOBJ_GEOM, [&](mjsElement* e) {  // URDF counts <inertial> only
      if (!mjs_getParent(e)->explicitinertial) mjs_asGeom(e)->mass = 0.0;
    });
  }
  name_all(spec);
  if (Errors errors = mend_meshes(spec, given_.file, notes_); !errors.empty()) return errors;
  mend_inertias(spec, notes_);
  add_free_joint(spec, notes_);
  const mjsCompiler& c = spec.compiler;
  if (c.balanceinertia != 0 || c.boundmass != 0.0 || c.boundinertia != 0.0 || c.settotalmass > 0.0)
    notes_.push_back(
        "its <compiler> changes masses or inertias (balanceinertia, boundmass, boundinertia or "
        "settotalmass): the changed ones are used");
  return {};
}

Errors Reader::compile() {
  model_.reset(mj_compile(spec_.get(), nullptr));
  if (!model_) {
    return {{given_.file, 0, "",
             std::string("MuJoCo cannot compile it: ") + mjs_getError(spec_.get())}};
  }
  data_.reset(mj_makeData(model_.get()));
  set_zero_pose();
  return {};
}

void Reader::set_zero_pose() {
  for (int j = 0; j < m().njnt; ++j) {
    if (m().jnt_type[j] == mjJNT_HINGE) d().qpos[m().jnt_qposadr[j]] = 0.0;
  }
  mj_kinematics(&m(), &d());
}

void Reader::read_pose() {
  pose_ = given_.pose;
  if (m().nkey == 0) return;
  for (int j = 0; j < m().njnt; ++j) {
    if (m().jnt_type[j] != mjJNT_HINGE && m().jnt_type[j] != mjJNT_SLIDE) continue;
    pose_.emplace(joint_name(m(), j), m().key_qpos[m().jnt_qposadr[j]]);
  }
}

Errors Reader::lock(const std::string& name, double value) {
  mjsElement* element = mjs_findElement(spec_.get(), mjOBJ_JOINT, name.c_str());
  if (!element || mjs_asJoint(element)->type == mjJNT_FREE) {
    return {{where(), 0, "locked." + name,
             "there is no such joint; joints of " + given_.file + ": " + list_joints(m())}};
  }
  for_each(*spec_, mjOBJ_KEY, [&](mjsElement* e) { mjs_delete(spec_.get(), e); });
  for_each(*spec_, mjOBJ_SENSOR, [&](mjsElement* e) { mjs_delete(spec_.get(), e); });
  for_each(*spec_, mjOBJ_ACTUATOR, [&](mjsElement* e) {
    const mjsActuator& actuator = *mjs_asActuator(e);
    if (name == mjs_getString(actuator.target)) mjs_delete(spec_.get(), e);
  });
  for_each(*spec_, mjOBJ_EQUALITY, [&](mjsElement* e) {
    const mjsEquality& equality = *mjs_asEquality(e);
    if (name == mjs_getString(equality.name1) || name == mjs_getString(equality.name2))
      mjs_delete(spec_.get(), e);
  });
  lock_joint(*spec_, *mjs_asJoint(element), value);
  full_.locked[name] = value;
  return {};
}

Errors Reader::lock_given() {
  Errors errors;
  for (const auto& [name, value] : given_.locked) {
    const Errors found = lock(name, value);
    errors.insert(errors.end(), found.begin(), found.end());
  }
  if (!errors.empty() || given_.locked.empty()) return errors;
  return compile();
}

Errors Reader::lock_others() {
  if (roles_.others.empty()) return {};
  std::string text;
  std::vector<std::pair<std::string, double>> values;
  for (const int joint : roles_.others) {
    const std::string name = joint_name(m(), joint);
    if (!is_below(m(), m().jnt_bodyid[joint], roles_.trunk)) {
      return {{given_.file, 0, name, "a joint outside the robot; expected one robot in the file"}};
    }
    const auto posed = pose_.find(name);
    double value = posed == pose_.end() ? 0.0 : posed->second;
    const mjtNum* range = m().jnt_range + 2 * joint;
    if (m().jnt_limited[joint]) value = std::clamp(value, range[0], range[1]);
    values.emplace_back(name, value);
    text += (text.empty() ? "" : ", ") + name + " at " + shown(value);
  }
  for (const auto& [name, value] : values) {
    if (Errors errors = lock(name, value); !errors.empty()) return errors;
  }
  notes_.push_back("joints that belong to no leg are locked, their mass kept: " + text);
  return compile();
}

Errors Reader::find_feet() {
  Errors errors;
  for (const Leg leg : kLegs) {
    const LegDescription& said = given_.legs[leg];
    const Vec3 p_WK = Eigen::Map<const Vec3>(d().xanchor + 3 * roles_.legs[leg][2]);
    const std::optional<Foot> foot =
        find_foot(m(), d(), shank(leg), p_WK, said.foot, said.foot_radius);
    if (foot) {
      feet_[leg] = *foot;
      continue;
    }
    const std::string body = mj_id2name(&m(), mjOBJ_BODY, shank(leg));
    errors.push_back(
        {said.foot.empty() ? given_.file : where(), 0, std::string(name(leg)),
         said.foot.empty()
             ? "no foot: nothing fixed to body " + body +
                   " collides. Say in a robot.toml where it is and how large: [legs." +
                   std::string(name(leg)) + "] foot = \"body or site\", foot_radius = 0.02"
             : "foot \"" + said.foot + "\" is no colliding geom, no body with one and, with a " +
                   "foot_radius, no body or site fixed to body " + body});
  }
  if (!errors.empty()) return errors;
  const auto [least, most] = std::minmax_element(
      feet_.begin(), feet_.end(), [](const Foot& a, const Foot& b) { return a.radius < b.radius; });
  if (most->radius > kMostUnequalRadii * least->radius) {
    errors.push_back({given_.file, 0, "feet",
                      "their radii are from " + shown(least->radius) + " to " +
                          shown(most->radius) +
                          " m: one of them is not what the robot stands on. Name the feet in a "
                          "robot.toml: [legs.FR] foot = \"...\""});
  }
  return errors;
}

double Reader::find_knee_sign(Leg leg) {
  const int joint = roles_.legs[leg][2];
  const double sign = (*full_.legs[leg].sign)[2], zero = (*full_.legs[leg].zero)[2];
  const mjtNum* range = m().jnt_range + 2 * joint;
  if (m().jnt_limited[joint]) {
    const double one = sign * (range[0] - zero), other = sign * (range[1] - zero);
    const double least = std::min(one, other), most = std::max(one, other);
    if (most <= kOneSided * -least) return -1.0;
    if (-least <= kOneSided * most) return 1.0;
  }
  const auto posed = pose_.find(joint_name(m(), joint));
  if (posed != pose_.end() && posed->second != zero)
    return sign * (posed->second - zero) > 0.0 ? 1.0 : -1.0;
  knees_assumed_.push_back(leg);
  return -1.0;
}

void Reader::find_conventions() {
  for (const Leg leg : kLegs) {
    LegDescription& full = full_.legs[leg];
    const JointConvention found =
        find_convention(m(), d(), roles_.trunk, roles_.legs[leg], feet_[leg].centre);
    for (std::size_t i = 0; i < kJointsPerLeg; ++i)
      full.joints[i] = joint_name(m(), roles_.legs[leg][i]);
    if (!full.sign) full.sign = found.sign;
    if (!full.zero) full.zero = found.zero;
    if (!full.knee_sign) full.knee_sign = find_knee_sign(leg);
  }
}

void Reader::place_foot(Leg leg, const Foot& foot) {
  const std::string of_leg(name(leg));
  const double reach =
      (foot.centre - Eigen::Map<const Vec3>(d().xanchor + 3 * roles_.legs[leg][2])).norm();
  std::string geom_name;
  if (foot.is_sphere) {
    geom_name = mj_id2name(&m(), mjOBJ_GEOM, foot.geom);
    mjsGeom& geom = *mjs_asGeom(mjs_findElement(spec_.get(), mjOBJ_GEOM, geom_name.c_str()));
    if (foot.radius != m().geom_size[3 * foot.geom]) geom.size[0] = foot.radius;
    geom.conaffinity |= kMeetsGround & ~geom.contype;
  } else {
    const int body = shank(leg);
    mjsBody* shank_body = mjs_findBody(spec_.get(), mj_id2name(&m(), mjOBJ_BODY, body));
    const RowMajorMat3 R_WS = Eigen::Map<const RowMajorMat3>(d().xmat + 9 * body);
    mjsGeom& sphere = *mjs_addGeom(shank_body, nullptr);
    geom_name = foot_sphere_name(leg);
    mjs_setName(sphere.element, geom_name.c_str());
    sphere.type = mjGEOM_SPHERE;
    sphere.size[0] = foot.radius;
    sphere.mass = 0.0;
    sphere.group = 3;
    sphere.contype = 0;  // meets the ground, never another part of the robot
    sphere.conaffinity = kMeetsGround;
    Eigen::Map<Vec3>(sphere.pos) =
        R_WS.transpose() * (foot.centre - Eigen::Map<const Vec3>(d().xpos + 3 * body));
    std::string text = of_leg + " foot: a sphere of " + shown(1e3 * foot.radius) + " mm";
    if (foot.geom >= 0) {
      const std::string shape = mj_id2name(&m(), mjOBJ_GEOM, foot.geom);
      mjsGeom& geom = *mjs_asGeom(mjs_findElement(spec_.get(), mjOBJ_GEOM, shape.c_str()));
      geom.contype = geom.conaffinity = 0;
      text += " stands in for the end of geom " + shape;
    }
    notes_.push_back(text);
  }
  if (foot.geom >= 0) full_.legs[leg].foot = mj_id2name(&m(), mjOBJ_GEOM, foot.geom);
  full_.legs[leg].foot_radius = foot.radius;

  // Whatever else reaches as far would stand on the ground beside the sphere.
  const Vec3 p_WK = Eigen::Map<const Vec3>(d().xanchor + 3 * roles_.legs[leg][2]);
  for (int g = 0; g < m().ngeom; ++g) {
    if (g == foot.geom || m().geom_type[g] != mjGEOM_SPHERE) continue;
    if (m().body_weldid[m().geom_bodyid[g]] != m().body_weldid[shank(leg)]) continue;
    if (m().geom_contype[g] == 0 && m().geom_conaffinity[g] == 0) continue;
    const double other =
        (Eigen::Map<const Vec3>(d().geom_xpos + 3 * g) - p_WK).norm() + m().geom_size[3 * g];
    if (other < (1.0 - kAsFar) * (reach + foot.radius)) continue;
    const std::string twin = mj_id2name(&m(), mjOBJ_GEOM, g);
    mjsGeom& geom = *mjs_asGeom(mjs_findElement(spec_.get(), mjOBJ_GEOM, twin.c_str()));
    geom.contype = geom.conaffinity = 0;
    notes_.push_back(of_leg + " foot: geom " + twin + " stands where " + geom_name +
                     " does and no longer collides");
  }
}

Errors Reader::read_limits() {
  Errors errors;
  for (const Leg leg : kLegs) {
    LegDescription& full = full_.legs[leg];
    Vec3 torque, armature;
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      const int joint = roles_.legs[leg][i];
      torque[static_cast<Eigen::Index>(i)] = torque_limit(m(), joint);
      armature[static_cast<Eigen::Index>(i)] = m().dof_armature[m().jnt_dofadr[joint]];
      if (full.armature) {
        mjsElement* e = mjs_findElement(spec_.get(), mjOBJ_JOINT, full.joints[i].c_str());
        mjs_asJoint(e)->armature = (*full.armature)[static_cast<Eigen::Index>(i)];
      }
    }
    if (!full.torque) full.torque = torque;
    if (!full.armature) full.armature = armature;
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      if ((*full.torque)[static_cast<Eigen::Index>(i)] > 0.0) continue;
      errors.push_back({given_.file, 0, std::string(name(leg)),
                        "joint " + full.joints[i] +
                            " has a torque range without torque; allowed: a range about 0, such as "
                            "-17 17, or none"});
    }
  }
  return errors;
}

void Reader::part_touching_bodies() {
  for (const Leg leg : kLegs) {
    const LegDescription& full = full_.legs[leg];
    const Vec3 q(0.0, -*full.knee_sign * kStandingThigh, 2.0 * *full.knee_sign * kStandingThigh);
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      d().qpos[m().jnt_qposadr[roles_.legs[leg][i]]] = (*full.zero)[at] + (*full.sign)[at] * q[at];
    }
  }
  mj_kinematics(&m(), &d());
  mj_comPos(&m(), &d());
  mj_collision(&m(), &d());
  std::set<std::pair<int, int>> pairs;
  for (int i = 0; i < d().ncon; ++i) {
    const int one = m().geom_bodyid[d().contact[i].geom[0]];
    const int other = m().geom_bodyid[d().contact[i].geom[1]];
    const bool of_robot = is_below(m(), one, roles_.trunk) && is_below(m(), other, roles_.trunk);
    if (of_robot && d().contact[i].dist <= 0.0)
      pairs.emplace(std::min(one, other), std::max(one, other));
  }
  set_zero_pose();
  std::string text;
  for (const auto& [one, other] : pairs) {
    const char* first = mj_id2name(&m(), mjOBJ_BODY, one);
    const char* second = mj_id2name(&m(), mjOBJ_BODY, other);
    mjsExclude* exclude = mjs_addExclude(spec_.get());
    mjs_setString(exclude->bodyname1, first);
    mjs_setString(exclude->bodyname2, second);
    text += (text.empty() ? "" : "; ") + std::string(first) + " and " + second;
  }
  if (!text.empty())
    notes_.push_back("bodies that overlap while the robot stands no longer collide: " + text);
}

void Reader::find_imu() {
  if (!full_.imu.empty()) return;
  for (int s = 0; s < m().nsite; ++s) {
    const char* site = mj_id2name(&m(), mjOBJ_SITE, s);
    if (!site || m().body_weldid[m().site_bodyid[s]] != m().body_weldid[roles_.trunk]) continue;
    std::string lower = site;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (lower.find("imu") == std::string::npos) continue;
    full_.imu = site;
    return;
  }
}

void Reader::note_what_is_assumed() {
  if (!knees_assumed_.empty()) {
    std::string legs;
    for (const Leg leg : knees_assumed_)
      legs += (legs.empty() ? "" : ", ") + std::string(name(leg));
    notes_.push_back("neither range nor pose says to which side the knees of " + legs +
                     " bend: backward. A robot.toml can say it: [legs.FR] knee = \"forward\"");
  }
  std::string unlimited;
  bool has_rotors = false;
  for (const Leg leg : kLegs) {
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      has_rotors = has_rotors || (*full_.legs[leg].armature)[at] > 0.0;
      if ((*full_.legs[leg].torque)[at] >= kNoTorqueLimit)
        unlimited += (unlimited.empty() ? "" : ", ") + full_.legs[leg].joints[i];
    }
  }
  if (!unlimited.empty()) {
    notes_.push_back("no torque limit of " + unlimited + ": up to " + shown(kNoTorqueLimit) +
                     " N m are commanded; give the joints an actuatorfrcrange, their motors a "
                     "forcerange, or a robot.toml the torque");
  }
  if (!has_rotors)
    notes_.push_back("no armature: the joints are simulated without the inertia of their rotors");
}

Result<ReadRobot> Reader::read() {
  if (Errors errors = open(); !errors.empty()) return errors;
  if (Errors errors = compile(); !errors.empty()) return errors;
  read_pose();
  if (Errors errors = lock_given(); !errors.empty()) return errors;
  Result<JointRoles> roles = find_legs(m(), d(), given_);
  if (!roles) return roles.errors();
  roles_ = roles.value();
  if (!roles_.others.empty()) {
    if (Errors errors = lock_others(); !errors.empty()) return errors;
    roles = find_legs(m(), d(), given_);
    if (!roles) return roles.errors();
    roles_ = roles.value();
  }
  if (Errors errors = find_feet(); !errors.empty()) return errors;
  find_conventions();
  for (const Leg leg : kLegs) place_foot(leg, feet_[leg]);
  if (Errors errors = read_limits(); !errors.empty()) return errors;
  part_touching_bodies();
  find_imu();
  note_what_is_assumed();
  return ReadRobot{std::move(spec_), full_, std::move(notes_)};
}

}  // namespace

Result<ReadRobot> read_robot(const RobotDescription& given) {
  catch_mujoco_errors();
  return Reader(given).read();
}

Result<std::string> robot_mjcf(const RobotDescription& given) {
  Result<ReadRobot> robot = read_robot(given);
  if (!robot) return robot.errors();
  mjSpec& spec = *robot.value().spec;
  const fs::path folder = fs::absolute(given.file).parent_path();
  for (mjString* place : {spec.compiler.meshdir, spec.compiler.texturedir})
    mjs_setString(place, (folder / mjs_getString(place)).lexically_normal().c_str());
  for_each(spec, mjOBJ_GEOM, [](mjsElement* e) {  // saving forgets that a geom weighs nothing
    if (mjs_asGeom(e)->mass == 0.0) mjs_asGeom(e)->density = 0.0;
  });
  std::string joints;
  for (const LegDescription& leg : robot.value().description.legs) {
    for (const std::string& joint : leg.joints) joints += (joints.empty() ? "" : ";") + joint;
  }
  mjsText* text = mjs_addText(&spec);
  mjs_setName(text->element, "pirouette_joints");
  mjs_setString(text->data, joints.c_str());

  const ModelPtr model(mj_compile(&spec, nullptr));
  if (!model) return Error{given.file, 0, "", mjs_getError(&spec)};
  std::array<char, 1024> message{};
  std::string xml(1 << 20, '\0');
  int needed = mj_saveXMLString(&spec, xml.data(), static_cast<int>(xml.size()), message.data(),
                                static_cast<int>(message.size()));
  if (needed > 0) {
    xml.assign(static_cast<std::size_t>(needed) + 1, '\0');
    needed = mj_saveXMLString(&spec, xml.data(), static_cast<int>(xml.size()), message.data(),
                              static_cast<int>(message.size()));
  }
  if (needed != 0) return Error{given.file, 0, "", std::string("as MJCF: ") + message.data()};
  xml.resize(xml.find('\0'));
  return xml;
}

}  // namespace pirouette
