// The metrics of a motion, computed while it goes on.
#pragma once

#include <array>
#include <optional>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/metrics/metrics.hpp"
#include "pirouette/metrics/running_statistics.hpp"
#include "pirouette/metrics/turn_window.hpp"
#include "pirouette/path/path.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

inline constexpr double kComRate = 100.0;            ///< Hz, to which the CoM is resampled
inline constexpr double kAccelerationCutoff = 20.0;  ///< Hz, of the accelerations' low-pass
inline constexpr double kRecordLength = 10.0;        ///< s, of one peak-to-peak record

/// What was asked of the robot, in the true world.
struct CommandedMotion {
  Vec2 point = Vec2::Zero();      ///< m
  Vec2 v_H = Vec2::Zero();        ///< m/s, heading axes
  double yaw_rate = 0.0;          ///< rad/s
  bool hold_heading = false;      ///< v_H does not turn with the path
  std::optional<Path> path = {};  ///< in the world, from where the command came; absent: a spin
};

/// One control tick of a motion. What is absent is not known: the metrics that need it are null.
struct MotionSample {
  double time = 0.0;                   ///< s
  Vec2 p_WG = Vec2::Zero();            ///< m, true CoM
  Vec2 v_WG_W = Vec2::Zero();          ///< m/s, true CoM
  double yaw = 0.0;                    ///< rad, true, unwrapped
  Number roll;                         ///< rad, true
  Number pitch;                        ///< rad, true
  Number relative_roll;                ///< rad, true, from the terrain's overall plane
  Number relative_pitch;               ///< rad, true, from the terrain's overall plane
  std::optional<Vec2> a_WB_W;          ///< m/s^2, true, trunk origin
  Number roll_rate;                    ///< rad/s, true, about the body's x axis
  Number pitch_rate;                   ///< rad/s, true, about the body's y axis
  std::optional<Vec2> position_error;  ///< m, estimated less true trunk position
  Number yaw_error;                    ///< rad, |estimated - true|
  double arc_length = 0.0;             ///< m, of the time-indexed reference along its path
  PerLeg<Number> slip = {};  ///< m/s, of the contact's material point; absent: a foot in the air
};

/// The sample of a simulated tick; `yaw` is the true yaw, unwrapped.
MotionSample motion_sample(const PlantTruth& truth, double yaw, const RobotState& estimate,
                           double reference_arc_length);

/// The motion's part of metrics.json, in memory that does not grow with the motion's length (below
/// 20 MB). Lengths are horizontal. docs/equations.md#metrics
class MotionMetrics {
 public:
  /// `rate` (Hz) is that of the samples.
  MotionMetrics(const CommandedMotion& commanded, double rate);

  /// Times increase.
  void add(const MotionSample& sample);
  /// Of the samples so far. Everything is absent without samples.
  Metrics result() const;
  /// m, along the commanded path, of its point nearest to the last sample; 0 without a path.
  double nearest_arc_length() const { return nearest_; }

 private:
  void add_com(const Vec2& p, const Vec2& v);
  void add_path(const Vec2& p, double reference_arc_length);
  ComMetrics com() const;
  PathMetrics path() const;
  AttitudeMetrics attitude() const;
  EstimatorMetrics estimator() const;
  double duration() const { return last_time_ - first_time_; }

  struct Largest {
    RunningMoments moments;
    double largest = 0.0;
    void add(double x);
  };

  CommandedMotion commanded_;
  std::size_t count_ = 0;
  double first_time_ = 0.0, last_time_ = 0.0;

  Resampler<4> com_resampler_{kComRate};
  RunningMoments distance_;
  RunningQuantiles distance_quantiles_;
  CircleFit circle_;
  PointCloud cloud_;
  std::array<WindowRange, 4> com_range_;  ///< x, y, their velocities
  TurnWindow turns_;
  Vec2 v_H_sum_ = Vec2::Zero();  ///< m/s

  double nearest_ = 0.0;  ///< m, arc length of the last nearest point of the path
  Largest cross_track_;
  RunningMoments along_track_;

  RunningMoments roll_, pitch_, relative_roll_, relative_pitch_;
  WindowRange roll_range_, pitch_range_;
  FilteredVariance x_acceleration_, y_acceleration_;
  FilteredSlopeVariance roll_acceleration_, pitch_acceleration_;
  RunningMoments slip_;
  RunningMoments position_error_, yaw_error_;
};

/// Wall-clock times of the ticks, in bounded memory.
class TickTimes {
 public:
  /// us; a time of 0 means that nothing was solved in this tick.
  void add(double tick_us, double mpc_us, double wbc_us);
  /// physics and real time are not set.
  TimingMetrics result() const;

 private:
  RunningQuantiles tick_, mpc_, wbc_;
};

}  // namespace pirouette
