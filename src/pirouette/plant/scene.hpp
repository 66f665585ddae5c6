// The robot of an MJCF file on a terrain, as a compiled MuJoCo model.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_map.hpp"
#include "pirouette/plant/terrain.hpp"
#include "pirouette/plant/world_config.hpp"

namespace pirouette {

struct MujocoDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using SpecPtr = std::unique_ptr<mjSpec, MujocoDeleter>;
using ModelPtr = std::unique_ptr<mjModel, MujocoDeleter>;
using DataPtr = std::unique_ptr<mjData, MujocoDeleter>;

struct Scene {
  ModelPtr model;
  RobotMap map;
};

/// Puts the robot of `mjcf` on `terrain`. The world is pirouette's alone: geoms that the file fixes
/// to the world (a floor of its own), its physics options and its actuators do not count. The feet
/// take the configured friction and softness with a priority above every other geom's, so that
/// MuJoCo uses exactly these values wherever a foot touches. Friction and damping of the joints are
/// the file's, times the configured factors; the trunk's mass and CoM are off by what is
/// configured, and a payload is on it.
Result<Scene> build_scene(const WorldConfig& config, const Terrain& terrain,
                          const std::string& mjcf);

/// Gives each foot the sliding friction of the terrain below it, `elsewhere` where that has none of
/// its own. The foot's priority makes it that of its contacts in the next step.
void set_foot_friction(const Terrain& terrain, double elsewhere, const RobotMap& map,
                       const mjData& data, mjModel& model);

}  // namespace pirouette
