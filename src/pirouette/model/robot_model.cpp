#include "pirouette/model/robot_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "pirouette/model/mujoco.hpp"
#include "pirouette/model/robot_map.hpp"
#include "pirouette/model/robot_reader.hpp"

namespace pirouette {

namespace {

using RowMajorJacobian = Eigen::Matrix<double, 3, kDof, Eigen::RowMajor>;
using RowMajorMatDof = Eigen::Matrix<double, kDof, kDof, Eigen::RowMajor>;

Vec3 vec3(const mjtNum* p) { return Vec3(p[0], p[1], p[2]); }

int shank_body(const RobotMap& map, Leg leg) { return map.legs[leg].body[2]; }

/// Lengths of one leg from the kinematics at its zero, trunk at the world's origin.
LegGeometry read_geometry(const mjModel& m, const mjData& d, const LegMap& leg,
                          const std::string& file, std::string_view leg_name, Errors& errors) {
  constexpr double kStraight = 1e-3;  // of the leg, tolerance on "straight down"
  constexpr double kNoDrop = 1e-4;    // m, a hip axis level with the abad's
  const Vec3 abad = vec3(d.xanchor + 3 * leg.joint[0]);
  const Vec3 hip = vec3(d.xanchor + 3 * leg.joint[1]);
  const Vec3 knee = vec3(d.xanchor + 3 * leg.joint[2]);
  const Vec3 foot = vec3(d.geom_xpos + 3 * leg.foot_geom);

  LegGeometry g;
  g.p_BH = Vec3(hip.x(), abad.y(), abad.z());  // the abad axis is along x: any point of it will do
  g.abad_offset = foot.y() - abad.y();
  g.hip_drop = std::abs(abad.z() - hip.z()) < kNoDrop ? 0.0 : abad.z() - hip.z();
  g.thigh = hip.z() - knee.z();
  g.shank = knee.z() - foot.z();
  g.foot_radius = m.geom_size[3 * leg.foot_geom];
  g.knee_sign = leg.knee_sign;
  g.tau_max = leg.tau_max;
  g.convention = leg.convention;
  for (int j = 0; j < 3; ++j) {
    const int joint = leg.joint[static_cast<size_t>(j)];
    g.dry_friction(j) = m.dof_frictionloss[leg.dof[static_cast<size_t>(j)]];
    g.damping(j) = m.dof_damping[leg.dof[static_cast<size_t>(j)]];
    if (!m.jnt_limited[joint]) continue;
    const double low = m.jnt_range[2 * joint], high = m.jnt_range[2 * joint + 1];
    if (std::max(std::abs(low), std::abs(high)) > 4.0 * kPi) {
      errors.push_back({file, 0, mj_id2name(&m, mjOBJ_JOINT, joint),
                        "its range is beyond two turns: is it in degrees, where the file says "
                        "angle=\"radian\"?"});
    }
    if (high - low > 2.0 * kPi) continue;  // no limit at all
    const double zero = leg.convention.zero(j), sign = leg.convention.sign(j);
    g.q_min(j) = std::min(sign * (low - zero), sign * (high - zero));
    g.q_max(j) = std::max(sign * (low - zero), sign * (high - zero));
  }
  const double tolerance = kStraight * (g.thigh + g.shank);
  const bool straight = std::abs(knee.x() - hip.x()) < tolerance &&
                        std::abs(foot.x() - hip.x()) < tolerance && g.thigh > 0.0 && g.shank > 0.0;
  if (!straight) {
    errors.push_back(
        {file, 0, std::string(leg_name),
         "the leg must hang straight down at the zeros of its joints: hip, knee and foot one below "
         "the other"});
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
  RobotDescription description;
  std::vector<std::string> notes;
  RobotMap map;
  double mass = 0.0;
  PerLeg<LegGeometry> legs{};
  std::array<int, kDof> dof{};   ///< MuJoCo's address of each of our velocities
  VecDof sign = VecDof::Ones();  ///< of our velocities over MuJoCo's

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
      const Vec3 angles = map.legs[leg].convention.to_file(q[leg]);
      for (size_t j = 0; j < kJointsPerLeg; ++j)
        d->qpos[map.legs[leg].qpos[j]] = angles(static_cast<int>(j));
    }
    mj_kinematics(m.get(), d.get());
    mj_comPos(m.get(), d.get());
  }

  Jacobian to_our_order(const RowMajorJacobian& J) const {
    Jacobian out;
    for (int i = 0; i < kDof; ++i) out.col(i) = sign(i) * J.col(dof[static_cast<size_t>(i)]);
    return out;
  }
};

Result<RobotModel> RobotModel::load(const RobotDescription& robot) {
  const std::string& mjcf = robot.file;
  catch_mujoco_errors();
  const MujocoWarnings warnings;
  try {
    Result<RobotModel> model = read(robot);
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

Result<RobotModel> RobotModel::read(const RobotDescription& robot) {
  Result<ReadRobot> found = read_robot(robot);
  if (!found) return found.errors();
  const std::string& mjcf = robot.file;
  const SpecPtr& spec = found.value().spec;
  auto impl = std::make_unique<Impl>();
  impl->m.reset(mj_compile(spec.get(), nullptr));
  if (!impl->m)
    return Error{mjcf, 0, "", std::string("MuJoCo cannot compile it: ") + mjs_getError(spec.get())};
  mjModel& m = *impl->m;

  impl->description = found.value().description;
  impl->notes = found.value().notes;
  Result<RobotMap> map = map_robot(m, impl->description);
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
    impl->sign.segment<3>(6 + 3 * static_cast<int>(index(leg))) =
        impl->map.legs[leg].convention.sign;
  }

  impl->set_pose(Vec3::Zero(), Mat3::Identity(), {});
  Errors errors;
  for (const Leg leg : kLegs) {
    impl->legs[leg] = read_geometry(m, *impl->d, impl->map.legs[leg], mjcf, name(leg), errors);
  }
  if (const auto wrong = degrees_for_radians(m, impl->map, mjcf)) errors.push_back(*wrong);
  if (!errors.empty()) return errors;
  return RobotModel(std::move(impl));
}

RobotModel::RobotModel(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RobotModel::RobotModel(RobotModel&&) noexcept = default;
RobotModel& RobotModel::operator=(RobotModel&&) noexcept = default;
RobotModel::~RobotModel() = default;

double RobotModel::mass() const { return impl_->mass; }
const PerLeg<LegGeometry>& RobotModel::legs() const { return impl_->legs; }

RobotScale RobotModel::scale() const {
  double leg_length = 0.0;
  for (const LegGeometry& leg : impl_->legs) leg_length += (leg.thigh + leg.shank) / kLegCount;
  return RobotScale::of(leg_length, impl_->mass);
}

const RobotDescription& RobotModel::description() const { return impl_->description; }
const std::vector<std::string>& RobotModel::notes() const { return impl_->notes; }

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
  for (int i = 0; i < kDof; ++i) d->qvel[s.dof[static_cast<size_t>(i)]] = s.sign(i) * s.nu(i);
  mj_makeM(m, d);
  mj_comVel(m, d);

  RowMajorMatDof full;
  mj_fullM(m, d, full.data());
  std::array<double, kDof> bias;
  mj_rne(m, d, 0, bias.data());
  for (int row = 0; row < kDof; ++row) {
    s.h(row) = s.sign(row) * bias[static_cast<size_t>(s.dof[static_cast<size_t>(row)])];
    for (int column = 0; column < kDof; ++column) {
      s.M(row, column) = s.sign(row) * s.sign(column) *
                         full(s.dof[static_cast<size_t>(row)], s.dof[static_cast<size_t>(column)]);
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
