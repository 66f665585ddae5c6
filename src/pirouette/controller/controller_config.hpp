// All parameters of the controller; none of the simulated world.
#pragma once

#include "pirouette/com/com_config.hpp"
#include "pirouette/controller/body_config.hpp"
#include "pirouette/controller/joint_config.hpp"
#include "pirouette/controller/safety_config.hpp"
#include "pirouette/estimation/estimation_config.hpp"
#include "pirouette/foot/foot_config.hpp"
#include "pirouette/gait/gait_config.hpp"
#include "pirouette/lowlevel/mpc_config.hpp"
#include "pirouette/lowlevel/wbc_config.hpp"
#include "pirouette/path/path_config.hpp"
#include "pirouette/terrain/terrain_config.hpp"

namespace pirouette {

/// Parameters of a SpinController.
struct ControllerConfig {
  ControlConfig control;
  BodyConfig body;
  GaitConfig gait;
  FootholdConfig foothold;
  FootConfig foot;
  TerrainConfig terrain;
  ComConfig com;
  PathConfig path;
  EstimationConfig estimation;
  CreepConfig creep;
  AidConfig aid;
  MpcConfig mpc;
  WbcConfig wbc;
  JointConfig joint;
  SafetyConfig safety;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.control, "control", "Controller clock.");
    v(s.body, "body", "Posture.");
    v(s.gait, "gait", "Trot.");
    v(s.foothold, "foothold", "Foothold planner, E1-E4.");
    v(s.foot, "foot", "Foot model, E5-E13.");
    v(s.terrain, "terrain", "Terrain plane estimate, E13-E17.");
    v(s.com, "com", "CoM planner, E16-E20.");
    v(s.path, "path", "Reference and tracker, E19-E24.");
    v(s.estimation, "estimation", "Attitude filter and leg-odometry Kalman filter.");
    v(s.creep, "creep", "Spin-slip creep of the feet, fed forward into the odometry.");
    v(s.aid, "aid", "Optional position aid.");
    v(s.mpc, "mpc", "Convex model predictive control.");
    v(s.wbc, "wbc", "Whole-body control.");
    v(s.joint, "joint", "Joint-level gains and limits.");
    v(s.safety, "safety", "Limits at which the controller stands down.");
  }
};

}  // namespace pirouette
