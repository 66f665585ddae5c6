// All values computed in one control tick; the log holds them, so that a test can replay a stage.
#pragma once

#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/com_plan.hpp"
#include "pirouette/types/contact_forces.hpp"
#include "pirouette/types/creep_estimate.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/foot_state.hpp"
#include "pirouette/types/foothold_plan.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/ground_estimate.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/self_check.hpp"
#include "pirouette/types/sensor_reading.hpp"
#include "pirouette/types/swing_target.hpp"
#include "pirouette/types/terrain_plane.hpp"

namespace pirouette {

/// Values kept of a finished tick. A step of a tick does not read it: it takes `last_...` values of
/// the tick before and values of earlier steps of the same tick.
struct TickTrace {
  SensorReading sensors;                                  ///< after SensorGuard
  PerLeg<bool> encoder_stuck{};                           ///< the leg's joint angles are not used
  ControllerStatus status = ControllerStatus::kStanding;  ///< after the tick
  SelfCheck self_check = SelfCheck::kRunning;             ///< state of the self-check
  RobotState state;                                       ///< estimated state of the robot
  PerLeg<FootState> feet{};                               ///< kinematics of each leg
  FootContacts contacts;                                  ///< contact of each foot
  PerLeg<bool> flag_dropped{};                            ///< the foot's contact flag is not used
  TerrainPlane plane;                                     ///< estimated ground plane
  GroundEstimate ground;                                  ///< kind of ground
  int remembered_treads = 0;        ///< number of treads in the foothold memory
  CreepEstimate creep;              ///< creep of the stance feet
  Vec2 tilt_bias_H = Vec2::Zero();  ///< apparent slope that turns with the trunk, heading axes
  Vec2 aid_offset = Vec2::Zero();   ///< m, from the odometry's position to the aid's
  GaitPhase gait;                   ///< phase of each leg
  PathPoint path;                   ///< path reference
  TwistCommand twist;               ///< the tracker's velocity command
  Vec2 integral_H = Vec2::Zero();   ///< m/s, the tracker's body-frame integrator
  FootholdPlan footholds;           ///< planned footholds
  ComPlan com_plan;                 ///< the CoM planner's target
  PerLeg<double> psp_weight{};      ///< vertex weights of the CoM planner
  BodyReference reference;          ///< reference of MPC and whole-body control
  PerLeg<SwingTarget> swing{};      ///< swing targets
  ContactForces mpc;                ///< forces of the MPC
  ContactForces wbc;                ///< forces of the whole-body control
  JointCommand command;             ///< joint command sent

  /// Calls visit(name, unit, meaning, value) for each logged column; value is a double, int, bool,
  /// Vec2, Vec3 or a PerLeg of one of them. The trace file, its documentation and the tests use
  /// this list.
  template <class Visit>
  static void columns(const TickTrace& t, Visit&& visit);

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [sensors, encoder_stuck, status, self_check, state, feet, contacts, flag_dropped, plane,
           ground, remembered_treads, creep, tilt_bias_H, aid_offset, gait, path, twist, integral_H,
           footholds, com_plan, psp_weight, reference, swing, mpc, wbc, command] = self;
    visit(sensors, encoder_stuck, status, self_check, state, feet, contacts, flag_dropped, plane,
          ground, remembered_treads, creep, tilt_bias_H, aid_offset, gait, path, twist, integral_H,
          footholds, com_plan, psp_weight, reference, swing, mpc, wbc, command);
  }
};

namespace detail {
template <class T, class Get>
auto per_leg(const PerLeg<T>& from, Get&& get) {
  PerLeg<std::decay_t<decltype(get(from[Leg::kFR]))>> out;
  for (const Leg leg : kLegs) out[leg] = get(from[leg]);
  return out;
}
}  // namespace detail

template <class Visit>
void TickTrace::columns(const TickTrace& t, Visit&& visit) {
  using detail::per_leg;
  const auto rpy = [](const RollPitchYaw& a) { return Vec3(a.roll, a.pitch, a.yaw); };
  visit("time", "s", "time of the sensor reading", t.sensors.time);
  visit(
      "status", "1",
      "0 standing, 1 walking, 2 fallen, 3 bad input, 4 solver failed, 5 bad command, 6 self-check "
      "failed, 7 gyro against legs; from 2 on every column but time keeps its last value",
      static_cast<int>(t.status));
  visit("self_check", "1",
        "0 running, 1 passed, 2 skipped, else what it found: types/self_check.hpp",
        static_cast<int>(t.self_check));
  visit("joint_position", "rad", "measured abad, hip, knee", t.sensors.joint_position);
  visit("joint_velocity", "rad/s", "measured", t.sensors.joint_velocity);
  visit("specific_force_B", "m/s^2", "measured by the accelerometer", t.sensors.specific_force_B);
  visit("gyro_B", "rad/s", "measured by the gyro", t.sensors.w_WB_B);
  visit("encoder_stuck", "1", "the leg's encoders are not believed", t.encoder_stuck);
  visit("base_position", "m", "estimate of p_WB", t.state.p_WB);
  visit("base_velocity", "m/s", "estimate of v_WB_W", t.state.v_WB_W);
  visit("base_rpy", "rad", "estimate of roll, pitch, unwrapped yaw", rpy(t.state.rpy));
  visit("com_position", "m", "estimate of p_WG", t.state.p_WG);
  visit("com_velocity", "m/s", "estimate of v_WG_W", t.state.v_WG_W);
  visit("foot_position", "m", "estimate of p_WF, sphere centres", t.state.p_WF);
  visit("contact", "1", "foot may push", per_leg(t.contacts, [](auto& c) { return c.in_contact; }));
  visit("contact_measured", "1", "foot touches",
        per_leg(t.contacts, [](auto& c) { return c.measured; }));
  visit("flag_dropped", "1", "the foot's contact flag is not believed", t.flag_dropped);
  visit("contact_point", "m", "p_WC of the foot model",
        per_leg(t.contacts, [](auto& c) { return c.p_WC; }));
  visit("contact_normal", "1", "n_W of the foot model",
        per_leg(t.contacts, [](auto& c) { return c.n_W; }));
  visit("rolling_velocity", "m/s", "of the sphere centre, rolling without slip",
        per_leg(t.contacts, [](auto& c) { return c.v_WF_rolling_W; }));
  visit("plane", "m, 1, 1", "terrain plane a0, a1, a2", Vec3(t.plane.a0, t.plane.a1, t.plane.a2));
  visit("plane_residual", "m", "rms of the contacts about the plane", t.plane.residual_rms);
  visit("ground_stepped", "1", "the last footholds do not fit a plane", t.ground.stepped);
  visit("ground_residual", "m", "rms of the last footholds about their plane", t.ground.residual);
  visit("remembered_treads", "1", "of the stairs in the foothold memory", t.remembered_treads);
  visit("torsional_friction", "m", "yaw moment of the feet per normal force, observed",
        t.creep.torsional_friction);
  visit("slip_per_twist", "m/rad", "creep of the stance feet down the slope",
        t.creep.slip_per_twist_W);
  visit("tilt_bias_H", "1", "apparent slope that turns with the trunk", t.tilt_bias_H);
  visit("aid_offset", "m", "from the odometry's position to the aid's", t.aid_offset);
  visit("stance", "1", "scheduled stance", per_leg(t.gait.leg, [](auto& p) { return p.stance; }));
  visit("phase_progress", "1", "share of stance or swing",
        per_leg(t.gait.leg, [](auto& p) { return p.progress; }));
  visit("path_position", "m", "path reference of the CoM", t.path.p_WG);
  visit("path_yaw", "rad", "path reference, unwrapped", t.path.yaw);
  visit("path_yaw_rate", "rad/s", "path reference", t.path.yaw_rate);
  visit("path_arc_length", "m", "path reference, from the path's start", t.path.arc_length);
  visit("twist_velocity_H", "m/s", "tracker's command, heading axes", t.twist.v_H);
  visit("twist_yaw_rate", "rad/s", "tracker's command", t.twist.yaw_rate);
  visit("tracker_integral_H", "m/s", "body-frame integrator", t.integral_H);
  visit("foothold", "m", "next contact points",
        per_leg(t.footholds, [](auto& f) { return f.p_WC; }));
  visit("com_plan", "m", "horizontal CoM target of the planner", t.com_plan.p_WG);
  visit("psp_weight", "1", "vertex weights", t.psp_weight);
  visit("reference_position", "m", "CoM reference of MPC and WBC", t.reference.p_WG);
  visit("reference_velocity", "m/s", "CoM reference of MPC and WBC", t.reference.v_WG_W);
  visit("reference_rpy", "rad", "trunk reference", rpy(t.reference.rpy));
  visit("swing_position", "m", "swing target p_WF",
        per_leg(t.swing, [](auto& s) { return s.p_WF; }));
  visit("force_mpc", "N", "planned ground reactions", t.mpc.f_W);
  visit("force_wbc", "N", "refined ground reactions", t.wbc.f_W);
  visit("mpc_status", "1", "0 unconstrained, 1 constrained, 2 failed: the last good one held",
        static_cast<int>(t.mpc.status));
  visit("mpc_iterations", "1", "of the active-set solver", t.mpc.iterations);
  visit("wbc_status", "1", "0 unconstrained, 1 constrained, 2 failed: the last good one held",
        static_cast<int>(t.wbc.status));
  visit("command_position", "rad", "", per_leg(t.command, [](auto& c) { return c.q; }));
  visit("command_velocity", "rad/s", "", per_leg(t.command, [](auto& c) { return c.dq; }));
  visit("command_torque", "N m", "feed-forward", per_leg(t.command, [](auto& c) { return c.tau; }));
}

}  // namespace pirouette
