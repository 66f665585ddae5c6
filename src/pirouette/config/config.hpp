// Every parameter of the library, once: name, default, unit, allowed range, meaning.
//
// Each struct has a static `fields(self, visit)` that calls, one line a parameter,
//   visit(self.member, "key", "unit", Range{min, max}, "meaning")
// for a number or a fixed-size list of numbers, and
//   visit(self.member, "key", "meaning")
// for a bool, an enum, a string or a nested group.
// `self` is a const or mutable reference, so the same list serves reading and writing.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "pirouette/base/math.hpp"
#include "pirouette/config/fault_config.hpp"
#include "pirouette/config/fields.hpp"

namespace pirouette {

enum class FootModel { kCentre, kRolling };
template <>
struct EnumNames<FootModel> {
  static constexpr std::array<std::string_view, 2> kNames = {"centre", "rolling"};
};

enum class ComPlanner { kLinear, kPsp };
template <>
struct EnumNames<ComPlanner> {
  static constexpr std::array<std::string_view, 2> kNames = {"linear", "psp"};
};

enum class PspWeight { kGaussian, kGeometric, kPoisson, kPolynomial };
template <>
struct EnumNames<PspWeight> {
  static constexpr std::array<std::string_view, 4> kNames = {"gaussian", "geometric", "poisson",
                                                             "polynomial"};
};

enum class PathReferenceMode { kVelocity, kIntegrated, kAnchored };
template <>
struct EnumNames<PathReferenceMode> {
  static constexpr std::array<std::string_view, 3> kNames = {"velocity", "integrated", "anchored"};
};

enum class PathTracker { kNone, kLqr, kLqi };
template <>
struct EnumNames<PathTracker> {
  static constexpr std::array<std::string_view, 3> kNames = {"none", "lqr", "lqi"};
};

enum class TerrainEstimation { kOff, kPlane };
template <>
struct EnumNames<TerrainEstimation> {
  static constexpr std::array<std::string_view, 2> kNames = {"off", "plane"};
};

enum class ContactNormal { kAuto, kPlane, kVertical };
template <>
struct EnumNames<ContactNormal> {
  static constexpr std::array<std::string_view, 3> kNames = {"auto", "plane", "vertical"};
};

enum class CreepModelMode { kOff, kStored, kOnline };
template <>
struct EnumNames<CreepModelMode> {
  static constexpr std::array<std::string_view, 3> kNames = {"off", "stored", "online"};
};

enum class EstimatorSource { kKalman, kTruth };
template <>
struct EnumNames<EstimatorSource> {
  static constexpr std::array<std::string_view, 2> kNames = {"kalman", "truth"};
};

struct GaitConfig {
  double period = 0.5;
  double duty = 0.6;
  double stand_time = 1.0;
  double swing_height = 0.05;
  double early_contact_progress = 0.6;
  double max_turn_per_stride = 1.05;
  double min_period = 0.18;
  bool adapt = true;
  double step_duty = 0.7;
  double step_clearance = 0.05;
  double max_swing_height = 0.16;
  double recovery_speed = 0.15;
  double recovery_period = 0.26;
  double recovery_time = 0.6;

  static constexpr double kMinSwingTime = 0.05;  ///< s; a leg cannot lift, move and land in less

  /// s, of a stride whose swing takes that time.
  double shortest_stride() const { return kMinSwingTime / (1.0 - duty); }

  /// s, of the stride at a commanded yaw rate (rad/s): shorter where the trunk would turn too far
  /// in one.
  double period_at(double yaw_rate) const {
    if (std::abs(yaw_rate) * period <= max_turn_per_stride) return period;
    return std::max({std::min(min_period, period), max_turn_per_stride / std::abs(yaw_rate),
                     shortest_stride()});
  }
  /// On stepped ground, with a stride of `stride` (s).
  double step_duty_at(double stride) const {
    return std::max(duty, std::min(step_duty, 1.0 - kMinSwingTime / stride));
  }
  /// s, of the stride after a push.
  double recovery_period_at(double yaw_rate) const {
    return std::min(period_at(yaw_rate), std::max(recovery_period, shortest_stride()));
  }

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.period, "period", "s", Range{0.15, 2.0}, "Duration of one stride of the trot.");
    v(s.duty, "duty", "1", Range{0.4, 0.9}, "Share of the stride that a foot is on the ground.");
    v(s.stand_time, "stand_time", "s", Range{0.0, 60.0},
      "Standing time before the gait starts; gyro and accelerometer are calibrated in it.");
    v(s.swing_height, "swing_height", "m", Range{0.005, 0.2}, "Apex of the swing above its ends.");
    v(s.early_contact_progress, "early_contact_progress", "1", Range{0.0, 1.0},
      "From this share of the swing on, a measured contact ends the swing early.");
    v(s.max_turn_per_stride, "max_turn_per_stride", "rad", Range{0.1, 10.0},
      "The stride is shortened below gait.period where the commanded yaw rate would turn the trunk "
      "by more.");
    v(s.min_period, "min_period", "s", Range{0.1, 2.0}, "That rule shortens no further.");
    v(s.adapt, "adapt",
      "Duty and swing height follow the ground that the feet have met, the stride follows pushes.");
    v(s.step_duty, "step_duty", "1", Range{0.4, 0.9}, "Duty on stepped ground, if more than duty.");
    v(s.step_clearance, "step_clearance", "m", Range{0.0, 0.2},
      "On stepped ground the swing's apex is this far above the highest step met.");
    v(s.max_swing_height, "max_swing_height", "m", Range{0.005, 0.3},
      "The rule raises the apex no further.");
    v(s.recovery_speed, "recovery_speed", "m/s", Range{0.01, 100.0},
      "The robot counts as pushed when the CoM's velocity is off its reference by more. Not on "
      "stepped ground.");
    v(s.recovery_period, "recovery_period", "s", Range{0.1, 2.0},
      "Stride of a robot that was pushed, if shorter than gait.period; at once.");
    v(s.recovery_time, "recovery_time", "s", Range{0.0, 60.0},
      "That stride lasts until the velocity has been within recovery_speed for this long.");
  }
};

struct FootholdConfig {
  bool feedback = true;
  double velocity_gain = 0.03;
  double max_offset = 0.25;
  bool rolling_compensation = true;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.feedback, "feedback", "Correct footholds by the velocity error; false: pure geometry, E1.");
    v(s.velocity_gain, "velocity_gain", "s", Range{0.0, 0.5},
      "Foothold shift per velocity error (Raibert).");
    v(s.max_offset, "max_offset", "m", Range{0.01, 0.4},
      "Largest horizontal distance of a foothold from its nominal point below the hip.");
    v(s.rolling_compensation, "rolling_compensation",
      "With foot.model rolling: aim half the expected contact travel back, so that the mean "
      "contact is nominal.");
  }
};

struct FootConfig {
  FootModel model = FootModel::kRolling;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.model, "model",
      "centre: the sphere's centre is a point foot (MIT); rolling: the contact point rolls (FKM). "
      "Shared by estimator, planner and dynamics.");
  }
};

struct TerrainConfig {
  TerrainEstimation estimation = TerrainEstimation::kPlane;
  double stale_time_constant = 0.3;
  double stale_max_age = 1.0;
  double min_scatter = 2.5e-3;
  double ridge = 1e-3;
  double max_slope = 0.7;
  double filter_time = 0.3;
  ContactNormal contact_normal = ContactNormal::kAuto;
  double step_residual = 0.004;
  double step_residual_release = 0.002;
  bool memory = true;
  double edge_margin = 0.04;
  double min_step = 0.012;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.estimation, "estimation", "off: the world is flat; plane: least-squares plane, E14.");
    v(s.stale_time_constant, "stale_time_constant", "s", Range{0.01, 10.0},
      "Weight of a lifted foot's last contact decays with this time constant.");
    v(s.stale_max_age, "stale_max_age", "s", Range{0.0, 20.0},
      "A contact older than this is left out of the plane.");
    v(s.min_scatter, "min_scatter", "m^2", Range{1e-6, 1.0},
      "Smallest eigenvalue of the contact scatter that determines a slope.");
    v(s.ridge, "ridge", "m^2", Range{0.0, 1.0}, "Pull of each slope towards its previous value.");
    v(s.max_slope, "max_slope", "1", Range{0.0, 2.0}, "Limit of the estimated gradient.");
    v(s.filter_time, "filter_time", "s", Range{0.0, 10.0},
      "Time constant of the plane's low-pass filter; 0: none.");
    v(s.contact_normal, "contact_normal",
      "Normal on which the feet roll. plane: the estimated plane's; vertical: as on treads; "
      "auto: vertical while the footholds do not fit a plane.");
    v(s.step_residual, "step_residual", "m", Range{0.0, 1.0},
      "The ground counts as stepped when the last footholds miss their plane by more, rms.");
    v(s.step_residual_release, "step_residual_release", "m", Range{0.0, 1.0},
      "It counts as even again when they miss it by less.");
    v(s.memory, "memory",
      "On stepped ground, remember footholds: keep feet off edges, expect the height met before.");
    v(s.edge_margin, "edge_margin", "m", Range{0.0, 0.2},
      "Least distance of a foothold from a remembered edge.");
    v(s.min_step, "min_step", "m", Range{0.001, 0.5},
      "Least height difference of neighbouring footholds that counts as an edge.");
  }
};

struct ComConfig {
  ComPlanner planner = ComPlanner::kPsp;
  PspWeight weight = PspWeight::kGaussian;
  double width = 0.5;
  double swing_weight_min = 0.0;
  bool on_diagonal = false;
  double max_speed = 0.2;
  double gain = 0.3;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.planner, "planner",
      "linear: interpolation between current and commanded CoM; psp: projected support polygon, "
      "E16-E19.");
    v(s.weight, "weight", "Family of the PSP vertex weight over the phase.");
    v(s.width, "width", "1", Range{0.01, 5.0},
      "Gaussian: sigma as a share of the phase. Poisson: lambda = 4 (0.25 / width)^2. Geometric: "
      "rho = 0.05^(0.25 / width).");
    v(s.swing_weight_min, "swing_weight_min", "1", Range{0.0, 0.95},
      "Weight of a swing foot at mid-swing, w_m of E18.");
    v(s.on_diagonal, "on_diagonal", "Keep the target on the stance diagonal at all times, E20.");
    v(s.max_speed, "max_speed", "m/s", Range{0.001, 5.0}, "Speed limit of the target.");
    v(s.gain, "gain", "1", Range{0.0, 1.0},
      "Share of the PSP offset from the path reference that is followed.");
  }
};

struct PathConfig {
  PathReferenceMode reference = PathReferenceMode::kAnchored;
  PathTracker tracker = PathTracker::kLqi;
  std::array<double, 3> state_weight = {4.0, 4.0, 4.0};
  std::array<double, 3> input_weight = {1.0, 1.0, 1.0};
  double integral_gain = 2.0;
  double integral_limit = 0.08;
  double max_velocity_correction = 0.15;
  double max_yaw_rate_correction = 0.5;
  double max_correction_rate = 1.0;
  double max_position_lead = 0.03;
  double max_integrated_lead = 0.10;
  double max_yaw_lead = 0.5;
  double max_path_lead = 0.1;
  double max_acceleration = 0.5;
  double max_yaw_acceleration = 1.5;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.reference, "reference",
      "velocity: follow the twist only; integrated: the set-point integrates the command near the "
      "robot "
      "(MIT); anchored: a point or path fixed in the world.");
    v(s.tracker, "tracker", "none; lqr: E21-E23; lqi: with an integrator in the body frame.");
    v(s.state_weight, "state_weight", "1/m^2, 1/m^2, 1/rad^2", Range{0.0, 1e6},
      "LQR weight Q of the errors x, y, yaw.");
    v(s.input_weight, "input_weight", "s^2/m^2, s^2/m^2, s^2/rad^2", Range{1e-6, 1e6},
      "LQR weight R of the corrections vx, vy, yaw rate.");
    v(s.integral_gain, "integral_gain", "1/s^2", Range{0.0, 100.0},
      "Gain of the body-frame integrator of the position error.");
    v(s.integral_limit, "integral_limit", "m/s", Range{0.0, 1.0},
      "Limit of the integrator's velocity (anti-windup).");
    v(s.max_velocity_correction, "max_velocity_correction", "m/s", Range{0.0, 2.0},
      "Limit of the tracker's velocity correction.");
    v(s.max_yaw_rate_correction, "max_yaw_rate_correction", "rad/s", Range{0.0, 5.0},
      "Limit of the tracker's yaw-rate correction.");
    v(s.max_correction_rate, "max_correction_rate", "m/s^2", Range{0.01, 100.0},
      "Rate limit of the velocity correction.");
    v(s.max_position_lead, "max_position_lead", "m", Range{0.001, 1.0},
      "Anchored: the MPC's position reference stays this close to the CoM.");
    v(s.max_integrated_lead, "max_integrated_lead", "m", Range{0.001, 1.0},
      "Integrated: the set-point stays this close to the CoM.");
    v(s.max_yaw_lead, "max_yaw_lead", "rad", Range{0.01, 3.0},
      "The yaw reference stays this close to the yaw (wind-up limit).");
    v(s.max_path_lead, "max_path_lead", "m", Range{0.005, 10.0},
      "On a path from a file the reference waits for the robot when this far ahead of it.");
    v(s.max_acceleration, "max_acceleration", "m/s^2", Range{0.01, 20.0},
      "Ramp of the commanded velocity.");
    v(s.max_yaw_acceleration, "max_yaw_acceleration", "rad/s^2", Range{0.01, 50.0},
      "Ramp of the commanded yaw rate.");
  }
};

struct BodyConfig {
  double height = 0.27;
  std::array<double, 2> stance_offset = {0.0, 0.0};

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.height, "height", "m", Range{0.05, 1.0},
      "Height of the CoM above the ground, along gravity.");
    v(s.stance_offset, "stance_offset", "m, m", Range{-0.2, 0.2},
      "Nominal foothold outwards of the point below the hip: forwards and sideways.");
  }
};

struct EstimationConfig {
  EstimatorSource source = EstimatorSource::kKalman;
  double process_position = 1e-9;
  double process_velocity = 1e-5;
  double process_foot = 1e-8;
  double measurement_position = 4e-8;
  double measurement_velocity = 1e-3;
  double measurement_height = 1e-6;
  double swing_noise_factor = 100.0;
  double trust_window = 0.02;
  double velocity_jump = 0.1;
  double attitude_time_constant = 4.0;
  double gyro_bias_time_constant = 60.0;
  double gyro_rest_samples = 600.0;
  double tilt_bias_time = 20.0;
  int contact_debounce = 3;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.source, "source", "kalman: sensors only; truth: the simulator's state, for studies.");
    v(s.process_position, "process_position", "m^2/s", Range{1e-12, 100.0},
      "Process noise of the position.");
    v(s.process_velocity, "process_velocity", "(m/s)^2/s", Range{1e-12, 100.0},
      "Process noise of the velocity.");
    v(s.process_foot, "process_foot", "m^2/s", Range{1e-12, 100.0},
      "Process noise of a foot on the ground.");
    v(s.measurement_position, "measurement_position", "m^2", Range{1e-12, 100.0},
      "Variance of a foot's measured position relative to the body.");
    v(s.measurement_velocity, "measurement_velocity", "(m/s)^2", Range{1e-12, 100.0},
      "Variance of the body velocity that a foot reports.");
    v(s.measurement_height, "measurement_height", "m^2", Range{1e-12, 100.0},
      "Variance of a foot's height above the terrain estimate.");
    v(s.swing_noise_factor, "swing_noise_factor", "1", Range{1.0, 1e6},
      "Added noise of a foot whose trust is only beginning or ending, as a multiple.");
    v(s.trust_window, "trust_window", "1", Range{0.0, 0.5},
      "Share of the stance at each end over which a foot's trust ramps.");
    v(s.velocity_jump, "velocity_jump", "m/s", Range{0.01, 100.0},
      "When all fully trusted feet agree that the velocity is off by more, it was a push: the "
      "filter "
      "follows them at once.");
    v(s.attitude_time_constant, "attitude_time_constant", "s", Range{0.1, 1000.0},
      "Time constant with which gravity corrects roll and pitch.");
    v(s.gyro_bias_time_constant, "gyro_bias_time_constant", "s", Range{1.0, 1e5},
      "Time constant of the gyro-bias estimate while walking.");
    v(s.gyro_rest_samples, "gyro_rest_samples", "samples", Range{0.0, 1e6},
      "Samples at rest that the prior of no gyro bias is worth: (noise / bias)^2.");
    v(s.tilt_bias_time, "tilt_bias_time", "s", Range{0.0, 1000.0},
      "Memory of the tilt error that turns with the trunk, seen against the terrain plane; 0: "
      "off.");
    v(s.contact_debounce, "contact_debounce", "ticks", Range{1, 100},
      "A contact flag counts when it has been the same for this long.");
  }
};

struct CreepConfig {
  CreepModelMode mode = CreepModelMode::kOnline;
  double calibrated_friction = 0.75;
  double calibrated_torsion = 0.004;
  double patch_ratio = 0.0;
  double averaging_time = 6.0;
  double max_torsional_friction = 0.03;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.mode, "mode",
      "Slip of twisting feet down a slope. off: none; stored: creep.calibrated_friction and "
      "creep.calibrated_torsion hold; online: torsional friction from the stance forces.");
    v(s.calibrated_friction, "calibrated_friction", "1", Range{0.05, 2.0},
      "Sliding friction of the feet, calibrated.");
    v(s.calibrated_torsion, "calibrated_torsion", "m", Range{0.0, 0.1},
      "Torsional friction of the feet: stored value, and prior of the online estimate.");
    v(s.patch_ratio, "patch_ratio", "m", Range{0.0, 0.1},
      "Torsional over sliding friction, calibrated; with the online estimate it replaces "
      "creep.calibrated_friction. 0: not known.");
    v(s.averaging_time, "averaging_time", "s", Range{0.1, 600.0},
      "Time constant of the online estimate.");
    v(s.max_torsional_friction, "max_torsional_friction", "m", Range{0.0, 0.2},
      "Bound of the online estimate.");
  }
};

struct AidConfig {
  bool enabled = true;
  double time_constant = 4.0;
  double ramp_time = 5.0;
  double timeout = 2.0;
  double max_offset = 0.5;

  static constexpr std::size_t kHistory = 512;  ///< ticks, that a measurement may be old

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.enabled, "enabled", "Use position measurements from outside where there are any.");
    v(s.time_constant, "time_constant", "s", Range{0.1, 100.0},
      "Low-pass filter of the odometry's offset from the aid.");
    v(s.ramp_time, "ramp_time", "s", Range{0.0, 100.0},
      "After its first measurement the aid gains influence over this time.");
    v(s.timeout, "timeout", "s", Range{0.01, 100.0},
      "An aid that was silent for longer is ramped in again.");
    v(s.max_offset, "max_offset", "m", Range{0.0, 10.0},
      "A measurement further from the odometry than this beyond the offset is an outlier.");
  }
};

struct MpcConfig {
  int horizon = 16;
  int ticks_per_solve = 12;
  double step_share = 0.0625;
  std::array<double, 3> weight_rpy = {3.0, 3.0, 10.0};
  std::array<double, 3> weight_position = {2.0, 2.0, 50.0};
  std::array<double, 3> weight_angular_velocity = {0.05, 0.05, 0.3};
  std::array<double, 3> weight_velocity = {0.2, 0.2, 0.1};
  double weight_force = 1e-5;
  double friction = 0.6;
  double max_normal_force = 150.0;
  double min_normal_force = 0.0;
  int max_iterations = 100;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.horizon, "horizon", "steps", Range{2, 24}, "Prediction horizon.");
    v(s.ticks_per_solve, "ticks_per_solve", "ticks", Range{1, 100},
      "Control ticks between two solutions.");
    v(s.step_share, "step_share", "1", Range{0.01, 0.5},
      "Length of a prediction step as a share of the gait period.");
    v(s.weight_rpy, "weight_rpy", "1/rad^2", Range{0.0, 1e6}, "Weight of roll, pitch, yaw.");
    v(s.weight_position, "weight_position", "1/m^2", Range{0.0, 1e6},
      "Weight of the CoM position.");
    v(s.weight_angular_velocity, "weight_angular_velocity", "s^2/rad^2", Range{0.0, 1e6},
      "Weight of the angular velocity.");
    v(s.weight_velocity, "weight_velocity", "s^2/m^2", Range{0.0, 1e6},
      "Weight of the CoM velocity.");
    v(s.weight_force, "weight_force", "1/N^2", Range{1e-9, 1.0}, "Weight of the forces.");
    v(s.friction, "friction", "1", Range{0.05, 2.0},
      "Friction coefficient assumed by MPC and WBC.");
    v(s.max_normal_force, "max_normal_force", "N", Range{1.0, 1e5},
      "Limit of a foot's normal force.");
    v(s.min_normal_force, "min_normal_force", "N", Range{0.0, 100.0},
      "Least normal force of a foot in contact.");
    v(s.max_iterations, "max_iterations", "1", Range{1, 10000},
      "Iteration cap of the active-set solver, MPC and WBC.");
  }
};

struct WbcConfig {
  double orientation_kp = 100.0;
  double orientation_kd = 10.0;
  double position_kp_xy = 30.0;
  double position_kd_xy = 8.0;
  double position_kp_z = 100.0;
  double position_kd_z = 10.0;
  double swing_kp = 200.0;
  double swing_kd = 15.0;
  double weight_force = 1.0;
  double weight_acceleration = 0.1;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.orientation_kp, "orientation_kp", "1/s^2", Range{0.0, 1e4},
      "Trunk orientation, stiffness.");
    v(s.orientation_kd, "orientation_kd", "1/s", Range{0.0, 1e3}, "Trunk orientation, damping.");
    v(s.position_kp_xy, "position_kp_xy", "1/s^2", Range{0.0, 1e4}, "CoM x and y, stiffness.");
    v(s.position_kd_xy, "position_kd_xy", "1/s", Range{0.0, 1e3}, "CoM x and y, damping.");
    v(s.position_kp_z, "position_kp_z", "1/s^2", Range{0.0, 1e4}, "CoM z, stiffness.");
    v(s.position_kd_z, "position_kd_z", "1/s", Range{0.0, 1e3}, "CoM z, damping.");
    v(s.swing_kp, "swing_kp", "1/s^2", Range{0.0, 1e4}, "Swing foot, stiffness.");
    v(s.swing_kd, "swing_kd", "1/s", Range{0.0, 1e3}, "Swing foot, damping.");
    v(s.weight_force, "weight_force", "1/N^2", Range{1e-6, 1e6},
      "Weight of the change of the MPC's forces.");
    v(s.weight_acceleration, "weight_acceleration", "s^4/m^2", Range{1e-6, 1e6},
      "Weight of the change of the trunk's commanded acceleration.");
  }
};

struct JointConfig {
  double kp_stance = 10.0;
  double kd_stance = 1.0;
  double kp_swing = 30.0;
  double kd_swing = 1.0;
  double kd_stand = 2.0;
  double filter_time = 0.0005;
  double friction_compensation = 1.0;
  double max_torque_rate = 20000.0;
  double max_position_rate = 60.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.kp_stance, "kp_stance", "N m/rad", Range{0.0, 1e3}, "Joint stiffness of a stance leg.");
    v(s.kd_stance, "kd_stance", "N m s/rad", Range{0.0, 100.0}, "Joint damping of a stance leg.");
    v(s.kp_swing, "kp_swing", "N m/rad", Range{0.0, 1e3}, "Joint stiffness of a swing leg.");
    v(s.kd_swing, "kd_swing", "N m s/rad", Range{0.0, 100.0}, "Joint damping of a swing leg.");
    v(s.kd_stand, "kd_stand", "N m s/rad", Range{0.0, 100.0},
      "Joint damping in the stand-down, the safe state.");
    v(s.filter_time, "filter_time", "s", Range{0.0, 0.1},
      "Time constant of the low-pass filter of the feed-forward torque; 0: none.");
    v(s.friction_compensation, "friction_compensation", "1", Range{0.0, 1.0},
      "Share of the robot file's joint friction and damping that the feed-forward torque "
      "overcomes.");
    v(s.max_torque_rate, "max_torque_rate", "N m/s", Range{1.0, 1e7},
      "Rate limit of the feed-forward torque.");
    v(s.max_position_rate, "max_position_rate", "rad/s", Range{0.1, 1e4},
      "Rate limit of the commanded joint angle.");
  }
};

struct SafetyConfig {
  double max_tilt = 0.8;
  double min_height_share = 0.4;
  int max_bad_readings = 10;
  int max_solver_failures = 10;
  double max_gyro_step = 3.0;
  double max_accelerometer_step = 80.0;
  int max_repeated_samples = 50;
  double max_blind_travel = 0.05;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.max_tilt, "max_tilt", "rad", Range{0.1, 3.2},
      "The robot counts as fallen when the trunk's axis leaves the ground normal by more.");
    v(s.min_height_share, "min_height_share", "1", Range{0.0, 1.0},
      "The robot counts as fallen when the CoM is lower than this share of body.height.");
    v(s.max_bad_readings, "max_bad_readings", "ticks", Range{0, 10000},
      "Non-finite sensor values or commands are bridged by the last good ones for this many ticks, "
      "then the "
      "controller stands down.");
    v(s.max_solver_failures, "max_solver_failures", "1", Range{0, 10000},
      "The last good forces are held over this many failed solutions in a row, then the controller "
      "stands down.");
    v(s.max_gyro_step, "max_gyro_step", "rad/s", Range{0.01, 1e6},
      "An IMU sample whose gyro leaves the last good one by more is a spike: that one stands in, "
      "for up to max_bad_readings ticks.");
    v(s.max_accelerometer_step, "max_accelerometer_step", "m/s^2", Range{0.1, 1e6},
      "The same for its accelerometer.");
    v(s.max_repeated_samples, "max_repeated_samples", "ticks", Range{0, 100000},
      "An IMU that repeats its sample to the last bit while walking is dead after this many, and "
      "the controller stands down.");
    v(s.max_blind_travel, "max_blind_travel", "rad", Range{0.001, 100.0},
      "An encoder that repeats its angle to the last bit over this much commanded travel is stuck: "
      "its leg counts no more as odometry. Two such legs: the controller stands down.");
  }
};

struct ControlConfig {
  double rate = 500.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.rate, "rate", "Hz", Range{100.0, 2000.0}, "Control ticks per second.");
  }
};

struct SensorConfig {
  bool ideal = false;
  double encoder_noise = 5e-4;
  double joint_velocity_noise = 0.025;
  double accelerometer_noise = 0.05;
  double accelerometer_bias = 0.02;
  double gyro_noise = 0.005;
  double gyro_bias = 2e-4;
  bool contact_flags = true;
  double contact_threshold = 3.0;
  double contact_delay = 0.0;
  double contact_error = 0.0;
  double aid_rate = 0.0;
  double aid_noise = 0.005;
  double aid_yaw_noise = 0.01;
  double aid_delay = 0.0;
  double aid_dropout = 0.0;
  double aid_lost_after = 0.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.ideal, "ideal", "No noise, no bias and no wrong contact flag.");
    v(s.encoder_noise, "encoder_noise", "rad", Range{0.0, 1.0}, "Joint angle, white, per sample.");
    v(s.joint_velocity_noise, "joint_velocity_noise", "rad/s", Range{0.0, 10.0},
      "Joint velocity, white, per sample.");
    v(s.accelerometer_noise, "accelerometer_noise", "m/s^2", Range{0.0, 100.0},
      "Accelerometer, white, per sample and axis.");
    v(s.accelerometer_bias, "accelerometer_bias", "m/s^2", Range{0.0, 10.0},
      "Accelerometer bias: standard deviation of the draw per seed and axis.");
    v(s.gyro_noise, "gyro_noise", "rad/s", Range{0.0, 10.0}, "Gyro, white, per sample and axis.");
    v(s.gyro_bias, "gyro_bias", "rad/s", Range{0.0, 1.0},
      "Gyro bias: standard deviation of the draw per seed and axis.");
    v(s.contact_flags, "contact_flags", "The feet report contact.");
    v(s.contact_threshold, "contact_threshold", "N", Range{0.0, 1e3},
      "Normal force above which a foot reports contact.");
    v(s.contact_delay, "contact_delay", "s", Range{0.0, 0.5}, "Age of the contact flags.");
    v(s.contact_error, "contact_error", "1", Range{0.0, 1.0},
      "Probability that a contact flag is wrong, per sample and foot.");
    v(s.aid_rate, "aid_rate", "Hz", Range{0.0, 2000.0},
      "Poses of the trunk measured from outside (motion capture) or by camera; 0: none.");
    v(s.aid_noise, "aid_noise", "m", Range{0.0, 1.0}, "Its position, white, per sample and axis.");
    v(s.aid_yaw_noise, "aid_yaw_noise", "rad", Range{0.0, 1.0}, "Its yaw, white, per sample.");
    v(s.aid_delay, "aid_delay", "s", Range{0.0, 5.0}, "From its measurement to its arrival.");
    v(s.aid_dropout, "aid_dropout", "1", Range{0.0, 1.0},
      "Probability that one of its samples does not arrive.");
    v(s.aid_lost_after, "aid_lost_after", "s", Range{0.0, 1e6},
      "No sample is measured after this time; 0: they go on.");
  }
};

struct PlantConfig {
  std::string terrain = "flat";
  double timestep = 0.001;
  double friction = 0.8;
  double torsional_friction = 0.005;
  double rolling_friction = 0.0001;
  double impratio = 10.0;
  double command_latency = 0.0;
  double torque_scale = 1.0;
  double torque_scale_spread = 0.0;
  double joint_friction_scale = 1.0;
  double joint_damping_scale = 1.0;
  double contact_time_constant = 0.005;
  double trunk_mass_scale = 1.0;
  std::array<double, 3> trunk_com_offset = {0.0, 0.0, 0.0};
  double payload = 0.0;
  std::array<double, 3> payload_position = {0.0, 0.0, 0.05};
  SensorConfig sensors;
  FaultConfig faults;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.terrain, "terrain",
      "flat, slope:DEGREES, slope:DEGREES+rough:HEIGHT, stairs:RISExRUN, stairs:RISExRUN@DEGREES, "
      "rough:HEIGHT, blocks:HEIGHT, patch:FRICTIONxSIDE or soft:TIME_CONSTANT; m and s.");
    v(s.timestep, "timestep", "s", Range{1e-4, 5e-3}, "Physics step; divides the control period.");
    v(s.friction, "friction", "1", Range{0.0, 5.0}, "Sliding friction of feet and ground.");
    v(s.torsional_friction, "torsional_friction", "m", Range{0.0, 1.0},
      "Torsional friction of feet and ground.");
    v(s.rolling_friction, "rolling_friction", "m", Range{0.0, 1.0},
      "Rolling friction of feet and ground.");
    v(s.impratio, "impratio", "1", Range{0.1, 1e4},
      "Ratio of frictional to normal impedance of the contacts.");
    v(s.command_latency, "command_latency", "s", Range{0.0, 0.05},
      "Age of the joint command when it reaches the motors.");
    v(s.torque_scale, "torque_scale", "1", Range{0.1, 2.0},
      "Motor torque constant, relative to nominal.");
    v(s.torque_scale_spread, "torque_scale_spread", "1", Range{0.0, 0.5},
      "Each motor's torque constant is drawn per seed within this share of torque_scale, "
      "uniformly.");
    v(s.joint_friction_scale, "joint_friction_scale", "1", Range{0.0, 100.0},
      "Dry friction of the joints, as a multiple of the robot file's.");
    v(s.joint_damping_scale, "joint_damping_scale", "1", Range{0.0, 100.0},
      "Damping of the joints, as a multiple of the robot file's.");
    v(s.contact_time_constant, "contact_time_constant", "s", Range{0.002, 0.5},
      "Time constant of the feet's contact; the sink depth under a load grows with its square.");
    v(s.trunk_mass_scale, "trunk_mass_scale", "1", Range{0.1, 10.0},
      "Mass and inertia of the trunk, as a multiple of what the controller takes from the robot "
      "file.");
    v(s.trunk_com_offset, "trunk_com_offset", "m, m, m", Range{-0.2, 0.2},
      "The trunk's CoM from where the robot file has it, trunk axes.");
    v(s.payload, "payload", "kg", Range{0.0, 100.0},
      "Mass on the trunk that the controller knows nothing of, a ball of 5 cm radius.");
    v(s.payload_position, "payload_position", "m, m, m", Range{-1.0, 1.0},
      "Its centre, trunk frame.");
    v(s.sensors, "sensors", "Sensor noise; per control sample.");
    v(s.faults, "faults", "What goes wrong, and when.");
  }
};

struct RunConfig {
  double rate = 0.7;
  std::array<double, 2> velocity = {0.0, 0.0};
  std::string path;
  double path_speed = 0.0;
  double laps = 2.0;
  double turns = 8.0;
  double settle_time = 5.0;
  std::int64_t seed = 1;
  bool fixed_point = false;
  std::array<double, 2> point = {0.0, 0.0};
  std::array<double, 2> start_offset = {0.0, 0.0};
  double start_yaw_deg = 0.0;
  double trace_rate = 100.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.rate, "rate", "rad/s", Range{-10.0, 10.0}, "Commanded yaw rate; positive turns left.");
    v(s.velocity, "velocity", "m/s, m/s", Range{-2.0, 2.0},
      "Commanded velocity, forwards and to the left; zero spins on the spot.");
    v(s.path, "path",
      "Path to follow instead of run.velocity and run.rate: a name under experiments/paths/ or a "
      "file ending in .toml; "
      "empty: none.");
    v(s.path_speed, "path_speed", "m/s", Range{0.0, 2.0},
      "Speed along run.path; 0: as its file says.");
    v(s.laps, "laps", "1", Range{0.01, 1e5}, "Laps of a closed run.path to record after settling.");
    v(s.turns, "turns", "1", Range{0.01, 1e5},
      "Turns to record after settling; 10 s each without a yaw rate.");
    v(s.settle_time, "settle_time", "s", Range{0.0, 600.0},
      "Time from the command to the first recorded sample.");
    v(s.seed, "seed", "1", Range{0, 9e15}, "Seed of noise, biases and terrain.");
    v(s.fixed_point, "fixed_point",
      "The commanded point is run.point and the heading 0, also when a start offset or yaw is "
      "given; "
      "false: where the CoM stands when the gait starts.");
    v(s.point, "point", "m, m", Range{-10.0, 10.0}, "The commanded point in the world.");
    v(s.start_offset, "start_offset", "m, m", Range{-10.0, 10.0},
      "Where the robot starts in the world; other than 0, 0 it is to go to run.point.");
    v(s.start_yaw_deg, "start_yaw_deg", "deg", Range{-180.0, 180.0},
      "Yaw at which the robot starts; other than 0 it is to turn to heading 0 first.");
    v(s.trace_rate, "trace_rate", "Hz", Range{1.0, 2000.0}, "Rows of trace.npy per second.");
  }
};

struct Config {
  std::string robot = "mini_cheetah";
  std::string controller = "pirouette";
  std::string profile = "nominal";
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
  PlantConfig plant;
  RunConfig run;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.robot, "robot", "Name of a folder under robots/, or path of an MJCF file.");
    v(s.controller, "controller", "Bundle of switches: mit, fkm, asc or pirouette.");
    v(s.profile, "profile", "Hardware and world: nominal or realistic.");
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
    v(s.safety, "safety", "When the controller gives up.");
    v(s.plant, "plant", "The simulated world, robot hardware and sensors.");
    v(s.run, "run", "One trial.");
  }
};

}  // namespace pirouette
