// Attitude and gyro bias from gyro and accelerometer.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/estimation/estimation_config.hpp"

namespace pirouette {

/// Input of AttitudeFilter::update().
struct AttitudeInput {
  Vec3 w_WB_B = Vec3::Zero();            ///< rad/s, gyro
  Vec3 specific_force_B = Vec3::Zero();  ///< m/s^2, accelerometer
  Vec3 v_WB_W = Vec3::Zero();            ///< m/s, last velocity estimate of the trunk origin
  bool at_rest = false;                  ///< the robot stands on four feet
  bool turns_on_purpose = false;         ///< at rest, but the trunk turns over its feet: self-check
  PerLeg<Vec3> p_BF{};                   ///< m, sphere centres in trunk axes; used at rest
};

/// Rotation vector (rad) of a trunk on four resting feet whose positions in trunk axes change from
/// `before` to `now` (m): least squares, small angles.
Vec3 turn_over_feet(const PerLeg<Vec3>& before, const PerLeg<Vec3>& now);

/// Output of AttitudeFilter::update().
struct Attitude {
  Mat3 R_WB = Mat3::Identity();  ///< trunk axes in world axes
  Vec3 w_WB_B = Vec3::Zero();    ///< rad/s, gyro without its estimated bias
};

/// Complementary filter on SO(3): the gyro is integrated, gravity slowly corrects roll and pitch,
/// and a lasting correction is taken as gyro bias. Yaw is the integral of the gyro alone: no other
/// sensor on board observes it.
///
/// The accelerometer measures gravity plus the trunk's own acceleration. In a steady turn the
/// latter is omega x v for every point of the body, which is subtracted; the gait's part averages
/// out over the filter's time constant. An accelerometer bias becomes a tilt error of bias / g.
///
/// A robot at rest sags and settles by more than a gyro's bias. Its feet tell how it turned in
/// truth: the bias is the slope, over the time at rest, of what the gyro's integral adds to that.
/// It is shrunk to the prior of no bias, until it is many deviations from it: then the prior is
/// wrong, and the measurement counts alone. Once a rest has told the bias, the prior is that one
/// and is not overruled again.
///
/// A robot that is turned together with the ground under its feet is not at rest. The rest begins
/// anew, with the bias from before it, when what the gyro adds is no straight line over time, when
/// gyro and specific force turn together, or when the slope is more than any gyro's bias. A steady
/// turn about the vertical that is slower than that is what a bias looks like.
class AttitudeFilter {
 public:
  /// `period` (s) is that of update().
  AttitudeFilter(const EstimationConfig& config, double period)
      : config_(config), period_(period) {}

  /// Attitude after one tick of `dt` (s).
  Attitude update(const AttitudeInput& in, double dt) noexcept;
  /// Starts at `R_WB` without gyro bias.
  void reset(const Mat3& R_WB);
  const Vec3& gyro_bias() const { return gyro_bias_; }  ///< rad/s, body axes

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, period, q_WB, gyro_bias, bias_known, turned, rest] = self;
    visit(q_WB, gyro_bias, bias_known, turned, rest);
  }

 private:
  EstimationConfig config_;
  double period_;  ///< s, of update()
  Quat q_WB_ = Quat::Identity();
  Vec3 gyro_bias_ = Vec3::Zero();
  bool bias_known_ = false;  ///< from an earlier rest
  bool turned_ = false;      ///< and not seen at rest since

  /// Least-squares line of a vector over time.
  struct Line {
    double samples = 0.0, sum_t = 0.0, sum_tt = 0.0;
    Vec3 sum_x = Vec3::Zero(), sum_tx = Vec3::Zero(), sum_xx = Vec3::Zero();

    void add(double time, const Vec3& x) noexcept;
    double spread() const noexcept;    ///< s^2, samples^2 times the variance of the times
    Vec3 slope() const noexcept;       ///< for a spread above 0
    double variance() const noexcept;  ///< about the line, sum of the axes
  };
  struct Rest {
    PerLeg<Vec3> p_BF{};               ///< m, at its beginning
    Vec3 bias_before = Vec3::Zero();   ///< rad/s
    double time = 0.0;                 ///< s
    Vec3 turn_by_gyro = Vec3::Zero();  ///< rad
    Vec3 turn_by_bias = Vec3::Zero();  ///< rad, that was taken off it
    Line added;                        ///< rad, what the gyro adds to the turn over the feet
    Line specific_force_B;             ///< m/s^2
    Vec3 last_w_WB_B = Vec3::Zero();   ///< rad/s, gyro
    double sum_change2 = 0.0;          ///< (rad/s)^2, from reading to reading
    bool overrules_prior = false;
  };
  Rest rest_;

  void record_rest(const AttitudeInput& in, double dt) noexcept;
  void calibrate(const AttitudeInput& in, double dt) noexcept;
  bool is_turned() const noexcept;
  bool contradicts_prior(const Vec3& measured) const noexcept;
};

}  // namespace pirouette
