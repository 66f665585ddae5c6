#include "pirouette/model/robot_model.hpp"

#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "pirouette/model/mujoco.hpp"
#include "pirouette/model/robot_map.hpp"

namespace pirouette {

namespace {

using RowMajorJacobian = Eigen::Matrix<double, 3, kDof, Eigen::RowMajor>;
using RowMajorMatDof = Eigen::Matrix<double, kDof, kDof, Eigen::RowMajor>;

Vec3 vec3(const mjtNum* p) { return Vec3(p[0], p[1], p[2]); }

int shank_body(const RobotMap& map, Leg leg) { return map.legs[leg].body[2]; }

/// Masses and inertias that the file asks MuJoCo to change without a word.
std::optional<Error> mended_masses(const mjSpec& spec, const std::string& file) {
  const mjsCompiler& c = spec.compiler;
  if (c.balanceinertia == 0 && c.boundmass == 0.0 && c.boundinertia == 0.0 &&
      c.settotalmass <= 0.0) {
    return std::nullopt;
  }
  return Error{file, 0, "compiler",
               "balanceinertia, boundmass, boundinertia or settotalmass changes masses silently; "
               "allowed: none of them, with the masses and inertias themselves in the file"};
}

/// Lengths of one leg from the kinematics at q = 0, trunk at the world's origin.
LegGeometry read_geometry(const mjModel& m, const mjData& d, const LegMap& leg,
                          const std::string& file, std::string_view leg_name, Errors& errors) {
  constexpr double kStraight = 1e-4;  // m, tolerance on "straight down at q = 0"
  const Vec3 abad = vec3(d.xanchor + 3 * leg.joint[0]);
  const Vec3 hip = vec3(d.xanchor + 3 * leg.joint[1]);
  const Vec3 knee = vec3(d.xanchor + 3 * leg.joint[2]);
  const Vec3 foot = vec3(d.geom_xpos + 3 * leg.foot_geom);

  LegGeometry g;
  g.p_BH = Vec3(hip.x(), abad.y(), abad.z());  // the abad axis is along x: any point of it will do
  g.abad_offset = foot.y() - abad.y();
  g.thigh = hip.z() - knee.z();
  g.shank = knee.z() - foot.z();
  g.foot_radius = m.geom_size[3 * leg.foot_geom];
  g.knee_sign = leg.knee_sign;
  g.tau_max = leg.tau_max;
  for (int j = 0; j < 3; ++j) {
    const int joint = leg.joint[static_cast<size_t>(j)];
    g.dry_friction(j) = m.dof_frictionloss[leg.dof[static_cast<size_t>(j)]];
    g.damping(j) = m.dof_damping[leg.dof[static_cast<size_t>(j)]];
    if (!m.jnt_limited[joint]) continue;
    g.q_min(j) = m.jnt_range[2 * joint];
    g.q_max(j) = m.jnt_range[2 * joint + 1];
    if (g.q_max(j) - g.q_min(j) > 4.0 * kPi) {
      errors.push_back({file, 0, mj_id2name(&m, mjOBJ_JOINT, joint),
                        "its range is more than two turns: is it in degrees, where the file says "
                        "angle=\"radian\"?"});
    }
  }
  const bool straight = std::abs(hip.z() - abad.z()) < kStraight &&
                        std::abs(knee.x() - hip.x()) < kStraight &&
                        std::abs(foot.x() - hip.x()) < kStraight && g.thigh > 0.0 && g.shank > 0.0;
  if (!straight) {
    errors.push_back(
        {file, 0, std::string(leg_name),
         "the leg must hang straight down at zero joint angles: hip, knee and foot one below the "
         "other, the hip axis level with the abad axis"});
  }
  return g;
}

/// What is wrong when the leg joints hardly move.
std::optional<Error> degrees_for_radians(const mjModel& m, const RobotMap& map,
                                         const std::string& file) {
  constexpr double kNarrow = 0.15;  // rad: no leg walks with a joint of less
  std::vector<int> narrow;
  for (const Leg leg : kLegs) {
    for (const int joint : map.legs[leg].joint) {
      const mjtNum* range = m.jnt_range + 2 * joint;
      if (m.jnt_limited[joint] && range[1] - range[0] < kNarrow) narrow.push_back(joint);
    }
  }
  if (narrow.empty()) return std::nullopt;
  const mjtNum* range = m.jnt_range + 2 * narrow.front();
  std::ostringstream text;
  text << narrow.size() << " of 12 leg joints, " << mj_id2name(&m, mjOBJ_JOINT, narrow.front())
       << " among them, have a range narrower than 0.15 rad: its " << range[0] << " to " << range[1]
       << " rad would be " << degrees(range[0]) << " to " << degrees(range[1])
       << " if the file's angles are in radians; MJCF counts in degrees unless the file says "
          "<compiler angle=\"radian\"/>";
  return Error{file, 0, "range", text.str()};
}

}  // namespace

struct RobotModel::Impl {
  ModelPtr m;
  DataPtr d;
  RobotMap map;
  double mass = 0.0;
  PerLeg<LegGeometry> legs{};
  std::array<int, kDof> dof{};  ///< MuJoCo's address of each of our velocities

  MatDof M = MatDof::Zero();
  VecDof h = VecDof::Zero();
  VecDof nu = VecDof::Zero();
  Vec3 p_WG = Vec3::Zero();
  Vec3 com_bias = Vec3::Zero();
  Jacobian J_com = Jacobian::Zero();
  PerLeg<Jacobian> J_foot{}, J_shank{};
  PerLeg<Vec3> foot_bias{}, shank_bias{};

  void set_pose(const Vec3& p_WB, const Mat3& R_WB, const PerLeg<Vec3>& q) {
    mjtNum* qpos = d->qpos + map.trunk_qpos;
    const Quat quat(R_WB);
    qpos[0] = p_WB.x(), qpos[1] = p_WB.y(), qpos[2] = p_WB.z();
    qpos[3] = quat.w(), qpos[4] = quat.x(), qpos[5] = quat.y(), qpos[6] = quat.z();
    for (const Leg leg : kLegs) {
      for (size_t j = 0; j < kJointsPerLeg; ++j)
        d->qpos[map.legs[leg].qpos[j]] = q[leg](static_cast<int>(j));
    }
    mj_kinematics(m.get(), d.get());
    mj_comPos(m.get(), d.get());
  }

  Jacobian to_our_order(const RowMajorJacobian& J) const {
    Jacobian out;
    for (int i = 0; i < kDof; ++i) out.col(i) = J.col(dof[static_cast<size_t>(i)]);
    return out;
  }
};

Result<RobotModel> RobotModel::load(const std::string& mjcf) {
  catch_mujoco_errors();
  const MujocoWarnings warnings;
  try {
    Result<RobotModel> model = read(mjcf);
    if (!model) return model;
    // What update() needs of MuJoCo's stack is asked for once here, where an error can be told.
    model.value().evaluate(RobotState{});
    if (warnings.texts().empty()) return model;
    Errors errors;
    for (const std::string& text : warnings.texts()) {
      errors.push_back({mjcf, 0, "", "MuJoCo warns: " + text});
    }
    return errors;
  } catch (const MujocoError& error) {
    return Error{mjcf, 0, "", error.what()};
  }
}

Result<RobotModel> RobotModel::read(const std::string& mjcf) {
  std::array<char, 1024> message{};
  const SpecPtr spec(
      mj_parseXML(mjcf.c_str(), nullptr, message.data(), static_cast<int>(message.size())));
  if (!spec) return Error{mjcf, 0, "", std::string("not a readable MJCF file: ") + message.data()};
  auto impl = std::make_unique<Impl>();
  impl->m.reset(mj_compile(spec.get(), nullptr));
  if (!impl->m)
    return Error{mjcf, 0, "", std::string("MuJoCo cannot compile it: ") + mjs_getError(spec.get())};
  mjModel& m = *impl->m;

  Result<RobotMap> map = map_robot(m, mjcf);
  if (!map.ok()) return map.errors();
  impl->map = map.value();
  if (m.nv != kDof) {
    return Error{
        mjcf, 0, "",
        "has " + std::to_string(m.nv) +
            " degrees of freedom; expected 18: a free trunk and four legs of three joints"};
  }
  m.opt.gravity[0] = m.opt.gravity[1] = 0.0;
  m.opt.gravity[2] = -kGravity;
  impl->d.reset(mj_makeData(&m));
  impl->mass = m.body_subtreemass[impl->map.trunk_body];

  for (int i = 0; i < 6; ++i) impl->dof[static_cast<size_t>(i)] = impl->map.trunk_dof + i;
  for (const Leg leg : kLegs) {
    for (size_t j = 0; j < kJointsPerLeg; ++j)
      impl->dof[6 + 3 * index(leg) + j] = impl->map.legs[leg].dof[j];
  }

  impl->set_pose(Vec3::Zero(), Mat3::Identity(), {});
  Errors errors;
  for (const Leg leg : kLegs) {
    impl->legs[leg] = read_geometry(m, *impl->d, impl->map.legs[leg], mjcf, name(leg), errors);
  }
  if (const auto wrong = degrees_for_radians(m, impl->map, mjcf)) errors.push_back(*wrong);
  if (const auto mended = mended_masses(*spec, mjcf)) errors.push_back(*mended);
  if (!errors.empty()) return errors;
  return RobotModel(std::move(impl));
}

RobotModel::RobotModel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RobotModel::RobotModel(RobotModel&&) noexcept = default;
RobotModel& RobotModel::operator=(RobotModel&&) noexcept = default;
RobotModel::~RobotModel() = default;

double RobotModel::mass() const { return impl_->mass; }
const PerLeg<LegGeometry>& RobotModel::legs() const { return impl_->legs; }

std::vector<std::string> RobotModel::assumptions() const {
  std::string unlimited;
  for (const Leg leg : kLegs) {
    for (std::size_t j = 0; j < kJointsPerLeg; ++j) {
      if (impl_->legs[leg].tau_max(static_cast<int>(j)) < kNoTorqueLimit) continue;
      unlimited +=
          (unlimited.empty() ? "" : ", ") +
          std::string(mj_id2name(impl_->m.get(), mjOBJ_JOINT, impl_->map.legs[leg].joint[j]));
    }
  }
  if (unlimited.empty()) return {};
  std::ostringstream text;
  text << "no torque limit of " << unlimited << ": up to " << kNoTorqueLimit
       << " N m are commanded; give the joints an actuatorfrcrange, or their motors a forcerange";
  return {text.str()};
}

Vec3 RobotModel::com(const PerLeg<Vec3>& q) {
  impl_->set_pose(Vec3::Zero(), Mat3::Identity(), q);
  return vec3(impl_->d->subtree_com + 3 * impl_->map.trunk_body);
}

Mat3 RobotModel::inertia(const PerLeg<Vec3>& q) {
  const Vec3 p_BG = com(q);
  const mjModel& m = *impl_->m;
  const mjData& d = *impl_->d;
  Mat3 total = Mat3::Zero();
  for (int body = 1; body < m.nbody; ++body) {
    if (m.body_rootid[body] != m.body_rootid[impl_->map.trunk_body]) continue;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> axes(d.ximat + 9 * body);
    const Mat3 R = axes;
    const Vec3 arm = vec3(d.xipos + 3 * body) - p_BG;
    total += R * vec3(m.body_inertia + 3 * body).asDiagonal() * R.transpose();
    total += m.body_mass[body] * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return total;
}

void RobotModel::update(const RobotState& state) noexcept { evaluate(state); }

void RobotModel::evaluate(const RobotState& state) {
  Impl& s = *impl_;
  mjModel* m = s.m.get();
  mjData* d = s.d.get();
  s.set_pose(state.p_WB, state.R_WB, state.joint_position);
  s.nu << state.v_WB_W, state.w_WB_B, state.joint_velocity[Leg::kFR],
      state.joint_velocity[Leg::kFL], state.joint_velocity[Leg::kRR],
      state.joint_velocity[Leg::kRL];
  for (int i = 0; i < kDof; ++i) d->qvel[s.dof[static_cast<size_t>(i)]] = s.nu(i);
  mj_makeM(m, d);
  mj_comVel(m, d);

  RowMajorMatDof full;
  mj_fullM(m, d, full.data());
  std::array<double, kDof> bias;
  mj_rne(m, d, 0, bias.data());
  for (int row = 0; row < kDof; ++row) {
    s.h(row) = bias[static_cast<size_t>(s.dof[static_cast<size_t>(row)])];
    for (int column = 0; column < kDof; ++column) {
      s.M(row, column) = full(s.dof[static_cast<size_t>(row)], s.dof[static_cast<size_t>(column)]);
    }
  }
  // The trunk's translational rows are Newton's law of the whole robot: m J_com dnu + m (Jdot nu +
  // g) = forces.
  s.p_WG = vec3(d->subtree_com + 3 * s.map.trunk_body);
  s.J_com = s.M.topRows<3>() / s.mass;
  s.com_bias = s.h.head<3>() / s.mass - Vec3(0.0, 0.0, kGravity);

  RowMajorJacobian J_p, J_r;
  for (const Leg leg : kLegs) {
    const int body = shank_body(s.map, leg);
    const mjtNum* centre = d->geom_xpos + 3 * s.map.legs[leg].foot_geom;
    mj_jac(m, d, J_p.data(), J_r.data(), centre, body);
    s.J_foot[leg] = s.to_our_order(J_p);
    s.J_shank[leg] = s.to_our_order(J_r);
    mj_jacDot(m, d, J_p.data(), J_r.data(), centre, body);
    s.foot_bias[leg] = s.to_our_order(J_p) * s.nu;
    s.shank_bias[leg] = s.to_our_order(J_r) * s.nu;
  }
}

Vec3 RobotModel::p_WG() const { return impl_->p_WG; }
Vec3 RobotModel::v_WG_W() const { return impl_->J_com * impl_->nu; }
const MatDof& RobotModel::mass_matrix() const { return impl_->M; }
const VecDof& RobotModel::bias() const { return impl_->h; }
const Jacobian& RobotModel::com_jacobian() const { return impl_->J_com; }
const Vec3& RobotModel::com_bias() const { return impl_->com_bias; }
const Jacobian& RobotModel::foot_jacobian(Leg leg) const { return impl_->J_foot[leg]; }
const Jacobian& RobotModel::shank_jacobian(Leg leg) const { return impl_->J_shank[leg]; }
const Vec3& RobotModel::foot_bias(Leg leg) const { return impl_->foot_bias[leg]; }
const Vec3& RobotModel::shank_bias(Leg leg) const { return impl_->shank_bias[leg]; }

}  // namespace pirouette
