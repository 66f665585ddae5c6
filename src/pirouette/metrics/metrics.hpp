// Metrics of a turn: the numbers of metrics.json (docs/equations.md#metrics).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace pirouette {

/// A metric; absent when the run gives no sensible value (too short, too few samples), null in
/// metrics.json.
using Number = std::optional<double>;

/// Metrics `com.*`.
struct ComMetrics {
  Number distance_to_point_mean_mm, distance_to_point_max_mm, distance_to_point_p95_mm;
  Number radius_mean_mm, radius_max_mm, radius_variance_mm2;
  Number circle_radius_mm, circle_variance_mm2, circle_centre_x_mm, circle_centre_y_mm;
  Number peak_to_peak_x_mm, peak_to_peak_y_mm;
  Number drift_per_turn_mm, distance_to_average_mean_mm;
  Number body_bias_mm_s, body_bias_x_mm_s, body_bias_y_mm_s;
  Number bias_circle_mm;
  Number velocity_range_x_mm_s, velocity_range_y_mm_s;
};

/// Metrics `path.*`.
struct PathMetrics {
  Number cross_track_mean_mm, cross_track_max_mm, along_track_mean_mm;
};

/// Metrics `attitude.*`.
struct AttitudeMetrics {
  Number roll_mean, roll_variance, pitch_mean, pitch_variance;
  Number roll_range, pitch_range;
  Number relative_roll_mean, relative_roll_variance, relative_pitch_mean, relative_pitch_variance;
};

/// Metrics `acceleration.*`.
struct AccelerationMetrics {
  Number x_variance, y_variance, roll_variance, pitch_variance;
};

/// Metrics `contact.*`.
struct ContactMetrics {
  Number slip_mean_mm_s;
  std::int64_t dropped_flags = 0;  ///< set by the trial
};

/// Metrics `estimator.*`.
struct EstimatorMetrics {
  Number position_error_mm, yaw_error_rad, position_drift_per_turn_mm;
};

/// Metrics `timing.*`: wall-clock times, which differ from run to run.
struct TimingMetrics {
  Number tick_us_median, tick_us_p99, tick_us_max;
  Number mpc_us_median, wbc_us_median, physics_step_us_median;
  Number real_time_factor;
};

/// Metrics `context.*`: what the run was.
struct RunContext {
  std::string path, robot, terrain, controller, profile, estimator, reference, tracker, foot_model,
      com_planner;
  double duty = 0.0;
  double period = 0.0;
  double torsional_friction = 0.0;
  double friction = 0.0;
  std::int64_t seed = 0;
  double duration_s = 0.0;
  std::string mujoco, commit, version, sensors;
  double yaw_rate = 0.0;
  double velocity_x = 0.0;
  double velocity_y = 0.0;
  Number point_x, point_y;
  double terrain_half_extent_m = 0.0;
  double terrain_pitch_m = 0.0;
};

/// All entries of metrics.json.
struct Metrics {
  bool fell = false;
  bool interrupted = false;
  Number done;  ///< set by the trial
  Number angle_error_deg;
  Number fall_time_s, stand_down_delay_s;
  double turns_done = 0.0;
  Number yaw_rate_mean, yaw_rate_error;
  ComMetrics com;                    ///< `com.*`
  PathMetrics path;                  ///< `path.*`
  AttitudeMetrics attitude;          ///< `attitude.*`
  AccelerationMetrics acceleration;  ///< `acceleration.*`
  ContactMetrics contact;            ///< `contact.*`
  EstimatorMetrics estimator;        ///< `estimator.*`
  TimingMetrics timing;              ///< `timing.*`
  RunContext context;                ///< `context.*`

  /// Calls visit(value, "key", "unit", "meaning") for each entry of metrics.json in its order; a
  /// dot in the key nests. A value is a bool, double, Number, int64 or string.
  template <class Self, class Visit>
  static void fields(Self& m, Visit&& v);
};

/// The text of metrics.json: non-finite and absent values are null.
std::string to_json(const Metrics& metrics);

/// Table of every key with unit and meaning, in Markdown.
std::string metrics_markdown();

template <class Self, class Visit>
void Metrics::fields(Self& m, Visit&& v) {
  v(m.fell, "fell", "", "the robot fell, or its controller gave up for a second");
  v(m.interrupted, "interrupted", "",
    "a signal ended the run: the numbers are of the part until then");
  v(m.done, "done", "1",
    "share of the commanded turns, laps, angle or distance that was done while recording; null "
    "where "
    "none was commanded");
  v(m.angle_error_deg, "angle_error_deg", "deg",
    "true angle turned until the robot stood again less run.angle_deg; null without one");
  v(m.fall_time_s, "fall_time_s", "s", "when it fell, from the start of the simulation");
  v(m.stand_down_delay_s, "stand_down_delay_s", "s",
    "from the fall to the controller's stand-down; null without a fall, or when none came in 1 s");
  v(m.turns_done, "turns_done", "1",
    "true turns while recording; positive in the commanded direction");
  v(m.yaw_rate_mean, "yaw_rate_mean", "rad/s", "true turned angle over recorded time");
  v(m.yaw_rate_error, "yaw_rate_error", "1", "yaw_rate_mean / commanded - 1");

  auto& com = m.com;
  v(com.distance_to_point_mean_mm, "com.distance_to_point_mean_mm", "mm",
    "CoM to the commanded point, mean; null for a turn about another point");
  v(com.distance_to_point_max_mm, "com.distance_to_point_max_mm", "mm", "largest");
  v(com.distance_to_point_p95_mm, "com.distance_to_point_p95_mm", "mm", "95 % quantile");
  v(com.radius_mean_mm, "com.radius_mean_mm", "mm", "CoM to its own mean point, mean");
  v(com.radius_max_mm, "com.radius_max_mm", "mm", "largest");
  v(com.radius_variance_mm2, "com.radius_variance_mm2", "mm^2", "unbiased variance");
  v(com.circle_radius_mm, "com.circle_radius_mm", "mm",
    "CoM to the centre of its least-squares circle, mean");
  v(com.circle_variance_mm2, "com.circle_variance_mm2", "mm^2", "unbiased variance");
  v(com.circle_centre_x_mm, "com.circle_centre_x_mm", "mm",
    "that centre, from the commanded point");
  v(com.circle_centre_y_mm, "com.circle_centre_y_mm", "mm",
    "that centre, from the commanded point");
  v(com.peak_to_peak_x_mm, "com.peak_to_peak_x_mm", "mm",
    "range of the CoM's x in 10 s, mean over the record");
  v(com.peak_to_peak_y_mm, "com.peak_to_peak_y_mm", "mm", "the same along y");
  v(com.drift_per_turn_mm, "com.drift_per_turn_mm", "mm",
    "net move of the CoM's one-turn average, per turn");
  v(com.distance_to_average_mean_mm, "com.distance_to_average_mean_mm", "mm",
    "CoM to its one-turn moving average, mean where a turn about it is in the record");
  v(com.body_bias_mm_s, "com.body_bias_mm_s", "mm/s",
    "mean CoM velocity in heading axes less the command; draws a circle of radius bias / yaw rate");
  v(com.body_bias_x_mm_s, "com.body_bias_x_mm_s", "mm/s", "forwards");
  v(com.body_bias_y_mm_s, "com.body_bias_y_mm_s", "mm/s", "to the left");
  v(com.bias_circle_mm, "com.bias_circle_mm", "mm",
    "radius of the circle that this bias draws at the yaw rate achieved; null below half a turn");
  v(com.velocity_range_x_mm_s, "com.velocity_range_x_mm_s", "mm/s",
    "range of the CoM's velocity along world x in 10 s, mean over the record");
  v(com.velocity_range_y_mm_s, "com.velocity_range_y_mm_s", "mm/s", "the same along y");

  auto& path = m.path;
  v(path.cross_track_mean_mm, "path.cross_track_mean_mm", "mm",
    "CoM to the nearest point of the commanded path, mean; null for a spin");
  v(path.cross_track_max_mm, "path.cross_track_max_mm", "mm", "largest");
  v(path.along_track_mean_mm, "path.along_track_mean_mm", "mm",
    "arc length of that point less the one due at the time, mean size");

  auto& attitude = m.attitude;
  v(attitude.roll_mean, "attitude.roll_mean", "rad", "of the trunk, true");
  v(attitude.roll_variance, "attitude.roll_variance", "rad^2", "unbiased");
  v(attitude.pitch_mean, "attitude.pitch_mean", "rad", "nose up is negative");
  v(attitude.pitch_variance, "attitude.pitch_variance", "rad^2", "unbiased");
  v(attitude.roll_range, "attitude.roll_range", "rad", "range in 10 s, mean over the record");
  v(attitude.pitch_range, "attitude.pitch_range", "rad", "range in 10 s, mean over the record");
  v(attitude.relative_roll_mean, "attitude.relative_roll_mean", "rad",
    "of the trunk from the terrain's overall plane, true");
  v(attitude.relative_roll_variance, "attitude.relative_roll_variance", "rad^2", "unbiased");
  v(attitude.relative_pitch_mean, "attitude.relative_pitch_mean", "rad",
    "of the trunk from the terrain's overall plane, true");
  v(attitude.relative_pitch_variance, "attitude.relative_pitch_variance", "rad^2", "unbiased");

  auto& acceleration = m.acceleration;
  v(acceleration.x_variance, "acceleration.x_variance", "(m/s^2)^2",
    "trunk origin along world x, zero-phase 20 Hz Butterworth");
  v(acceleration.y_variance, "acceleration.y_variance", "(m/s^2)^2", "along world y");
  v(acceleration.roll_variance, "acceleration.roll_variance", "(rad/s^2)^2",
    "about the body's x axis, same filter");
  v(acceleration.pitch_variance, "acceleration.pitch_variance", "(rad/s^2)^2",
    "about the body's y axis");

  v(m.contact.slip_mean_mm_s, "contact.slip_mean_mm_s", "mm/s",
    "true speed of the feet's material points at the contact, mean over the feet that touch");

  v(m.contact.dropped_flags, "contact.dropped_flags", "1",
    "feet whose contact flag the controller stopped to believe");

  v(m.estimator.position_error_mm, "estimator.position_error_mm", "mm",
    "estimated to true trunk position, horizontal, mean");
  v(m.estimator.yaw_error_rad, "estimator.yaw_error_rad", "rad", "mean size");
  v(m.estimator.position_drift_per_turn_mm, "estimator.position_drift_per_turn_mm", "mm",
    "net move of the one-turn average of estimated less true trunk position, horizontal, per turn");

  auto& timing = m.timing;
  v(timing.tick_us_median, "timing.tick_us_median", "us", "one controller tick, wall clock");
  v(timing.tick_us_p99, "timing.tick_us_p99", "us", "99 % quantile");
  v(timing.tick_us_max, "timing.tick_us_max", "us", "largest");
  v(timing.mpc_us_median, "timing.mpc_us_median", "us", "one MPC solution");
  v(timing.wbc_us_median, "timing.wbc_us_median", "us", "one whole-body solution");
  v(timing.physics_step_us_median, "timing.physics_step_us_median", "us", "one physics step");
  v(timing.real_time_factor, "timing.real_time_factor", "1", "simulated over wall-clock time");

  auto& context = m.context;
  v(context.robot, "context.robot", "", "name, or path of the MJCF file");
  v(context.terrain, "context.terrain", "", "plant.terrain");
  v(context.controller, "context.controller", "", "bundle of switches");
  v(context.profile, "context.profile", "", "of the plant: nominal or realistic");
  v(context.estimator, "context.estimator", "", "estimation.source");
  v(context.reference, "context.reference", "", "path.reference");
  v(context.tracker, "context.tracker", "", "path.tracker");
  v(context.foot_model, "context.foot_model", "", "foot.model");
  v(context.com_planner, "context.com_planner", "", "com.planner");
  v(context.duty, "context.duty", "1", "gait.duty");
  v(context.period, "context.period", "s", "of the stride, at the commanded yaw rate");
  v(context.torsional_friction, "context.torsional_friction", "m", "plant.torsional_friction");
  v(context.friction, "context.friction", "1", "plant.friction");
  v(context.seed, "context.seed", "", "run.seed");
  v(context.duration_s, "context.duration_s", "s", "simulated time, from standing to the end");
  v(context.mujoco, "context.mujoco", "", "version of the physics");
  v(context.commit, "context.commit", "", "of this program's source");
  v(context.version, "context.version", "", "of this program");
  v(context.sensors, "context.sensors", "", "noisy or ideal");
  v(context.path, "context.path", "", "run.path; empty: none");
  v(context.yaw_rate, "context.yaw_rate", "rad/s", "commanded");
  v(context.velocity_x, "context.velocity_x", "m/s", "commanded, forwards");
  v(context.velocity_y, "context.velocity_y", "m/s", "commanded, to the left");
  v(context.point_x, "context.point_x", "m", "commanded point, world");
  v(context.point_y, "context.point_y", "m", "commanded point, world");
  v(context.terrain_half_extent_m, "context.terrain_half_extent_m", "m",
    "terrain.npy reaches this far from the origin along x and y");
  v(context.terrain_pitch_m, "context.terrain_pitch_m", "m", "between its points");
}

}  // namespace pirouette
