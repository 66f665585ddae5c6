#include "pirouette/plant/scene.hpp"

#include <algorithm>
#include <array>

namespace pirouette {
namespace {

constexpr int kFootContactDimensions = 6;  ///< normal, two sliding, torsion, two rolling
constexpr double kContactDampingRatio = 1.0;

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
                          const std::string& mjcf) {
  catch_mujoco_errors();
  std::array<char, 1024> message{};
  const SpecPtr spec(
      mj_parseXML(mjcf.c_str(), nullptr, message.data(), static_cast<int>(message.size())));
  if (!spec) return Error{mjcf, 0, "", message.data()};

  const Vec3 friction(config.friction, config.torsional_friction, config.rolling_friction);
  remove_world_geoms(*spec);
  terrain.add_to(*spec, friction);
  spec->option = physics_options(config);
  if (config.payload > 0.0) add_payload(config, *spec);

  Scene scene;
  scene.model.reset(mj_compile(spec.get(), nullptr));
  if (!scene.model) return Error{mjcf, 0, "", mjs_getError(spec.get())};
  mjModel& model = *scene.model;

  Result<RobotMap> map = map_robot(model, mjcf);
  if (!map) return map.errors();
  scene.map = map.value();
  if (config.trunk_mass_scale != 1.0 || config.trunk_com_offset != WorldConfig{}.trunk_com_offset)
    falsify_trunk(config, scene.map.trunk_body, model);

  const int foot_priority =
      1 + *std::max_element(model.geom_priority, model.geom_priority + model.ngeom);
  for (const LegMap& leg : scene.map.legs) {
    Eigen::Map<Vec3>(model.geom_friction + 3 * leg.foot_geom) = friction;
    model.geom_condim[leg.foot_geom] = kFootContactDimensions;
    model.geom_priority[leg.foot_geom] = foot_priority;
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
