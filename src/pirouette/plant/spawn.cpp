#include "pirouette/plant/spawn.hpp"

#include <Eigen/Cholesky>
#include <sstream>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

constexpr int kMaxIterations = 200;
constexpr int kFreeIterations = 100;  ///< then the footholds stay, lest they hop on and off an edge
constexpr double kTolerance = 1e-9;   ///< m
constexpr double kReachTolerance = 1e-4;  ///< m, beyond it the leg counts as too short
constexpr double kDamping = 1e-8;         ///< m^2, keeps a straight leg's step finite
constexpr double kMaxStep = 0.2;          ///< rad
constexpr double kFirstBend = 0.8;        ///< rad, of the thigh in the first guess

Eigen::Map<const Vec3> at(const mjtNum* array, int element) {
  return Eigen::Map<const Vec3>(array + 3 * element);
}

/// Trunk orientation with z along `normal` and heading `yaw`: equations E15.
Mat3 trunk_orientation(const Vec3& normal, double yaw) {
  const Vec3 m = rot_z(yaw).transpose() * normal;
  return rotation_from_rpy(
      {std::atan2(-m.y(), std::hypot(m.x(), m.z())), std::atan2(m.x(), m.z()), yaw});
}

void write_trunk(const RobotMap& map, const Vec3& p_WB, const Mat3& R_WB, mjData& data) {
  const Quat q(R_WB);
  Eigen::Map<Vec3>(data.qpos + map.trunk_qpos) = p_WB;
  Eigen::Map<Vec4>(data.qpos + map.trunk_qpos + 3) << q.w(), q.x(), q.y(), q.z();
}

/// Sets the joints of one leg to the angles `q` (rad) of LegGeometry.
void write_leg(const LegMap& leg, const Vec3& q, mjData& data) {
  const Vec3 angles = leg.convention.to_file(q);
  for (std::size_t i = 0; i < kJointsPerLeg; ++i)
    data.qpos[leg.qpos[i]] = angles[static_cast<Eigen::Index>(i)];
}

/// Moves one leg towards `p_WF_goal` by one damped Newton step within its joint limits.
void step_leg(const mjModel& model, const LegMap& leg, const Vec3& p_WF_goal, mjData& data) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> J_all(3, model.nv);
  mj_jacGeom(&model, &data, J_all.data(), nullptr, leg.foot_geom);
  Mat3 J;
  for (std::size_t i = 0; i < kJointsPerLeg; ++i)
    J.col(static_cast<Eigen::Index>(i)) = J_all.col(leg.dof[i]);

  const Vec3 error = p_WF_goal - at(data.geom_xpos, leg.foot_geom);
  const Mat3 gram = J * J.transpose() + kDamping * Mat3::Identity();
  const Vec3 step =
      (J.transpose() * gram.ldlt().solve(error)).cwiseMax(-kMaxStep).cwiseMin(kMaxStep);
  for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
    double& q = data.qpos[leg.qpos[i]];
    q += step[static_cast<Eigen::Index>(i)];
    const mjtNum* range = model.jnt_range + 2 * leg.joint[i];
    if (model.jnt_limited[leg.joint[i]]) q = std::clamp(q, range[0], range[1]);
  }
}

}  // namespace

Errors stand_robot(const mjModel& model, const RobotMap& map, const Terrain& terrain,
                   const Vec2& xy, double yaw, double com_height, mjData& data) {
  const Vec3 normal = terrain.normal();
  const Mat3 R_WB = trunk_orientation(normal, yaw);
  const Vec2 gradient = -normal.head<2>() / normal.z();

  // Hips as seen from the trunk with the legs straight down; then a first guess with bent knees.
  mju_copy(data.qpos, model.qpos0, model.nq);
  PerLeg<Vec3> p_BH_W;
  for (const LegMap& leg : map.legs) {
    write_leg(leg, Vec3::Zero(), data);
  }
  Vec3 p_WB(xy.x(), xy.y(), terrain.height(xy) + com_height);
  write_trunk(map, p_WB, R_WB, data);
  mj_kinematics(&model, &data);
  for (const Leg leg : kLegs) {
    const LegMap& at_leg = map.legs[leg];
    p_BH_W[leg] = at(data.xanchor, at_leg.joint[1]) - p_WB;
    write_leg(at_leg, at_leg.knee_sign * Vec3(0.0, -kFirstBend, 2.0 * kFirstBend), data);
  }

  PerLeg<Vec3> goal;
  double leg_error = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    write_trunk(map, p_WB, R_WB, data);
    mj_kinematics(&model, &data);
    mj_comPos(&model, &data);

    const Vec3 p_WG = at(data.subtree_com, map.trunk_body);
    Vec3 mean_ground = Vec3::Zero();
    leg_error = 0.0;
    for (const Leg leg : kLegs) {
      const int foot = map.legs[leg].foot_geom;
      if (iteration < kFreeIterations) {
        const double radius = model.geom_size[3 * foot];
        const Vec2 below_hip = terrain.beside_edges((p_WB + p_BH_W[leg]).head<2>(), radius);
        goal[leg] << below_hip, terrain.ball_height(below_hip, radius);
      }
      const Vec2 foothold = goal[leg].head<2>();
      mean_ground += Vec3(foothold.x(), foothold.y(), terrain.height(foothold)) / kLegCount;
      leg_error = std::max(leg_error, (goal[leg] - at(data.geom_xpos, foot)).norm());
    }
    const double ground_below_com = mean_ground.z() + gradient.dot(xy - mean_ground.head<2>());
    const Vec3 com_error = Vec3(xy.x(), xy.y(), ground_below_com + com_height) - p_WG;
    if (leg_error < kTolerance && com_error.norm() < kTolerance) return {};

    for (const Leg leg : kLegs) step_leg(model, map.legs[leg], goal[leg], data);
    p_WB += com_error;
  }
  if (leg_error < kReachTolerance) return {};
  std::ostringstream text;
  text << "the robot cannot stand with its CoM " << com_height
       << " m above the ground of plant.terrain: a foot misses the ground below its hip by "
       << leg_error << " m; plant.trunk_com_offset, plant.trunk_mass_scale and plant.payload "
       << "move the CoM too";
  return {Error{"", 0, "body.height", text.str()}};
}

}  // namespace pirouette
