#include "pirouette/plant/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pirouette/model/robot_reader.hpp"

namespace pirouette {
namespace {

constexpr int kFootContactDimensions = 6;  ///< normal, two sliding, torsion, two rolling
constexpr double kContactDampingRatio = 1.0;
/// MuJoCo's default impedance: the same contact whatever the robot's file has.
constexpr std::array<double, mjNIMP> kContactImpedance = {0.9, 0.95, 0.001, 0.5, 2.0};
/// Inverse weight of a foot's body times the robot's mass, of the Mini Cheetah.
constexpr double kFootCompliance = 41.93789190;

void remove_world_geoms(mjSpec& spec) {
  const mjsBody* world = mjs_findBody(&spec, "world");
  while (mjsElement* geom = mjs_firstChild(world, mjOBJ_GEOM, /*recurse=*/0))
    mjs_delete(&spec, geom);
}

bool floats(mjsBody* body) {
  mjsElement* joint = mjs_firstChild(body, mjOBJ_JOINT, /*recurse=*/0);
  return joint != nullptr && mjs_asJoint(joint)->type == mjJNT_FREE;
}

/// A ball on the trunk, of even density. Without a trunk the robot's map says what is missing.
void add_payload(const WorldConfig& config, mjSpec& spec) {
  constexpr double kRadius = 0.05;  // m
  for (mjsElement* e = mjs_firstElement(&spec, mjOBJ_BODY); e; e = mjs_nextElement(&spec, e)) {
    mjsBody* trunk = mjs_asBody(e);
    if (!floats(trunk)) continue;
    mjsBody* payload = mjs_addBody(trunk, nullptr);
    payload->mass = config.payload;
    Eigen::Map<Vec3>(payload->pos) = Eigen::Map<const Vec3>(config.payload_position.data());
    Eigen::Map<Vec3>(payload->ipos).setZero();
    Eigen::Map<Vec3>(payload->inertia).setConstant(0.4 * config.payload * square(kRadius));
    payload->explicitinertial = 1;
    payload->fuse = 0;
    return;
  }
}

/// The trunk weighs and balances otherwise than the robot file says.
void falsify_trunk(const WorldConfig& config, int trunk, mjModel& model) {
  model.body_mass[trunk] *= config.trunk_mass_scale;
  Eigen::Map<Vec3>(model.body_inertia + 3 * trunk) *= config.trunk_mass_scale;
  Eigen::Map<Vec3>(model.body_ipos + 3 * trunk) +=
      Eigen::Map<const Vec3>(config.trunk_com_offset.data());
  const DataPtr data(mj_makeData(&model));
  mj_setConst(&model, data.get());
}

/// Makes the stiffness of the feet's contacts the robot's weight's: MuJoCo takes it from the
/// inverse weight of the body that carries the foot, which says more about the file than about the
/// robot. To six decimals, so that the Mini Cheetah's stays what it is.
void stiffen_feet(const RobotMap& map, mjModel& model) {
  const double mass = model.body_subtreemass[map.trunk_body];
  double compliance = 0.0;
  for (const LegMap& leg : map.legs)
    compliance += mass * model.body_invweight0[2 * model.geom_bodyid[leg.foot_geom]] / kLegCount;
  const double factor = std::round(1e6 * kFootCompliance / compliance) / 1e6;
  for (const LegMap& leg : map.legs)
    model.body_invweight0[2 * model.geom_bodyid[leg.foot_geom]] *= factor;
}

mjOption physics_options(const WorldConfig& config) {
  mjOption option;
  mj_defaultOption(&option);
  option.timestep = config.timestep;
  option.integrator = mjINT_IMPLICITFAST;
  option.cone = mjCONE_ELLIPTIC;
  option.impratio = config.impratio;
  Eigen::Map<Vec3>(option.gravity) = Vec3(0.0, 0.0, -kGravity);
  // The motors are the plant's own; a failed simulation must show, not start again.
  option.disableflags |= mjDSBL_ACTUATION | mjDSBL_SENSOR | mjDSBL_AUTORESET;
  return option;
}

}  // namespace

Result<Scene> build_scene(const WorldConfig& config, const Terrain& terrain,
                          const RobotDescription& robot) {
  catch_mujoco_errors();
  Result<ReadRobot> read = read_robot(robot);
  if (!read) return read.errors();
  const SpecPtr& spec = read.value().spec;

  const Vec3 friction(config.friction, config.torsional_friction, config.rolling_friction);
  remove_world_geoms(*spec);
  terrain.add_to(*spec, friction);
  spec->option = physics_options(config);
  if (config.payload > 0.0) add_payload(config, *spec);

  Scene scene;
  scene.model.reset(mj_compile(spec.get(), nullptr));
  if (!scene.model) return Error{robot.file, 0, "", mjs_getError(spec.get())};
  mjModel& model = *scene.model;

  Result<RobotMap> map = map_robot(model, read.value().description);
  if (!map) return map.errors();
  scene.map = map.value();
  if (config.trunk_mass_scale != 1.0 || config.trunk_com_offset != WorldConfig{}.trunk_com_offset)
    falsify_trunk(config, scene.map.trunk_body, model);

  stiffen_feet(scene.map, model);
  const int foot_priority =
      1 + *std::max_element(model.geom_priority, model.geom_priority + model.ngeom);
  for (const LegMap& leg : scene.map.legs) {
    Eigen::Map<Vec3>(model.geom_friction + 3 * leg.foot_geom) = friction;
    model.geom_condim[leg.foot_geom] = kFootContactDimensions;
    model.geom_priority[leg.foot_geom] = foot_priority;
    model.geom_margin[leg.foot_geom] = model.geom_gap[leg.foot_geom] = 0.0;
    std::copy(kContactImpedance.begin(), kContactImpedance.end(),
              model.geom_solimp + mjNIMP * leg.foot_geom);
    Eigen::Map<Vec2>(model.geom_solref + mjNREF * leg.foot_geom) =
        Vec2(terrain.contact_time_constant(config.contact_time_constant), kContactDampingRatio);
    for (const int dof : leg.dof) {
      model.dof_frictionloss[dof] *= config.joint_friction_scale;
      model.dof_damping[dof] *= config.joint_damping_scale;
    }
  }
  return scene;
}

void set_foot_friction(const Terrain& terrain, double elsewhere, const RobotMap& map,
                       const mjData& data, mjModel& model) {
  for (const LegMap& leg : map.legs) {
    const Eigen::Map<const Vec2> xy(data.geom_xpos + 3 * leg.foot_geom);
    model.geom_friction[3 * leg.foot_geom] = terrain.friction(xy, elsewhere);
  }
}

}  // namespace pirouette
