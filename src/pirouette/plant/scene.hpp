// The robot of an MJCF file on a terrain, as a compiled MuJoCo model.
#pragma once

#include "pirouette/base/result.hpp"
#include "pirouette/model/mujoco.hpp"
#include "pirouette/model/robot_map.hpp"
#include "pirouette/plant/terrain.hpp"
#include "pirouette/plant/world_config.hpp"

namespace pirouette {

/// A compiled model and its indices.
struct Scene {
  ModelPtr model;
  RobotMap map;
};

/// Puts `robot` on `terrain`. Geoms that the file fixes to the world (such as a floor),
/// its physics options and its actuators are ignored. The feet have the configured friction and
/// softness with a priority above every other geom's, so that MuJoCo uses exactly these values
/// wherever a foot touches. Friction and damping of the joints are the file's, times the configured
/// factors; mass and CoM of the trunk are changed as configured, and a payload is added to it.
Result<Scene> build_scene(const WorldConfig& config, const Terrain& terrain,
                          const RobotDescription& robot);

/// Gives each foot the sliding friction of the terrain below it, `elsewhere` where the terrain has
/// none of its own. By the foot's priority its contacts have this friction in the next step.
void set_foot_friction(const Terrain& terrain, double elsewhere, const RobotMap& map,
                       const mjData& data, mjModel& model);

}  // namespace pirouette
