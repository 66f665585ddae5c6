// Statistics of samples that come one by one, in memory that does not grow with their number: what
// the metrics are made of. docs/equations.md#metrics-in-one-pass states how far each is from the
// statistics of the whole list.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pirouette/base/math.hpp"

namespace pirouette {

/// Mean and variance of weighted groups of numbers. [Chan83]
class RunningMoments {
 public:
  void add(double x) { add(1.0, x, 0.0); }
  /// `count` numbers of the given mean; `squares` is the sum of their squared distances from it.
  void add(double count, double mean, double squares);

  double count() const { return count_; }
  std::optional<double> mean() const;
  /// Unbiased; absent for fewer than two samples.
  std::optional<double> variance() const;

 private:
  double count_ = 0.0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

/// Quantiles of numbers of at least 0, and the largest. Keeps the first kExact samples, for which
/// they are exact as quantile() in statistics.hpp; from then on counts in bins of kResolution of
/// their value, between 2^-32 and 2^32.
class RunningQuantiles {
 public:
  static constexpr std::size_t kExact = 65536;
  static constexpr double kResolution = 1.0 / 2048.0;

  void add(double x);
  /// Share in [0, 1] of the samples lies below the result. Absent for no samples, and when one was
  /// not a number.
  std::optional<double> quantile(double share) const;
  std::optional<double> largest() const;

 private:
  double order_statistic(std::size_t index) const;  ///< to a bin

  std::size_t count_ = 0;
  bool has_nan_ = false;
  double largest_ = 0.0;
  std::vector<double> samples_;      ///< all of them, while bins_ is empty
  std::vector<std::uint64_t> bins_;  ///< samples in each
};

/// Mean over consecutive whole windows of `length` samples (at least 1) of max - min; of the
/// samples so far while the first window is not full. Not a number where one of them is not.
class WindowRange {
 public:
  explicit WindowRange(std::size_t length) : length_(length) {}

  void add(double x);
  std::optional<double> mean() const;

 private:
  std::size_t length_;
  std::size_t filled_ = 0;  ///< samples in the window
  std::size_t windows_ = 0;
  double low_ = 0.0, high_ = 0.0;
  double sum_ = 0.0;  ///< of the full windows' ranges; NaN from the first sample that is
};

/// Linear interpolation of samples at times that increase to first time + k / rate.
template <int N>
class Resampler {
 public:
  using Value = Eigen::Matrix<double, N, 1>;

  explicit Resampler(double rate) : rate_(rate) {}

  /// Calls use(value) for each instant since the previous sample, this one's included.
  template <class Use>
  void add(double time, const Value& value, Use&& use) {
    constexpr double kSlack = 1e-6;  // s; a sample may fall short of its instant by rounding
    if (next_ == 0) start_ = last_time_ = time;
    for (double t; (t = start_ + static_cast<double>(next_) / rate_) <= time + kSlack; ++next_) {
      const double share = next_ == 0 ? 1.0 : (t - last_time_) / (time - last_time_);
      use(share < 1.0 ? Value(last_ + share * (value - last_)) : value);
    }
    last_time_ = time;
    last_ = value;
  }

 private:
  double rate_;  ///< Hz
  std::size_t next_ = 0;
  double start_ = 0.0;
  double last_time_ = 0.0;
  Value last_ = Value::Zero();
};

/// Points in the plane by their moments.
struct PointMoments {
  double count = 0.0;
  Vec2 mean = Vec2::Zero();
  Mat2 scatter = Mat2::Zero();  ///< sum of (p - mean) (p - mean)^T

  void add(const PointMoments& other);
};

struct Circle {
  Vec2 centre = Vec2::Zero();
  double radius = 0.0;
};

/// Least-squares circle (Kasa) of points: solves 2 c.x + k = |x|^2 for the centre c, radius^2 = k +
/// |c|^2. docs/equations.md#metrics
class CircleFit {
 public:
  void add(const Vec2& p);
  const Vec2& mean() const { return points_.mean; }
  /// Absent for fewer than three points or collinear ones.
  std::optional<Circle> circle() const;

 private:
  PointMoments points_;
  Vec2 moment_ = Vec2::Zero();  ///< sum of d |d|^2, d = p - mean
};

/// Distances of points from a centre that is known only after them. Keeps kCapacity points; when
/// they are more, those in one cell of a square grid become one by their moments, and the cells
/// double until the half of kCapacity will do.
class PointCloud {
 public:
  static constexpr std::size_t kCapacity = 65536;
  static constexpr std::size_t kDirections = 512;

  struct Distances {
    double mean = 0.0;
    double largest = 0.0;
    std::optional<double> variance;  ///< unbiased; absent for fewer than two points
  };

  PointCloud();

  void add(const Vec2& p);
  /// Absent for no points, and when one of them was not finite.
  std::optional<Distances> distances(const Vec2& centre) const;
  double cell() const { return cell_; }  ///< m, side; 0 while all points are kept

 private:
  double smallest_cell() const;
  bool merge_cells();  ///< whether they are few enough

  bool has_nan_ = false;
  double cell_ = 0.0;
  Vec2 origin_ = Vec2::Zero();  ///< of the grid: the first point
  std::vector<PointMoments> points_;
  std::vector<Vec2> directions_;
  std::vector<Vec2> extremes_;  ///< the farthest point in each direction
};

/// A second-order section in direct form II transposed.
struct Biquad {
  double b0 = 1.0, b1 = 0.0, b2 = 0.0, a1 = 0.0, a2 = 0.0;
  double s1 = 0.0, s2 = 0.0;

  /// The steady state of a constant input `x`.
  void settle(double x);
  double step(double x);
};

/// Second-order Butterworth low-pass (bilinear, cut-off prewarped).
Biquad butterworth(double rate, double cutoff);

/// That low-pass run forwards and backwards: no phase, amplitude gain
/// 1 / (1 + (tan(pi f / rate) / tan(pi cutoff / rate))^4). Ends as scipy.signal.filtfilt: odd
/// extension by kPad samples, steady start. The way back starts kBlock samples at a time, so far
/// behind each block that its start has died away to a double's rounding.
class ZeroPhaseLowpass {
 public:
  static constexpr std::size_t kPad = 9;  ///< 3 times the number of coefficients
  static constexpr std::size_t kBlock = 4096;

  /// A cut-off at or above rate / 2 gives no samples.
  ZeroPhaseLowpass(double rate, double cutoff);

  /// The filtered samples that became final, mostly none; valid until the next call.
  std::span<const double> add(double x);
  /// Those that follow if the record ends here. None for kPad samples or fewer.
  std::vector<double> finish() const;

 private:
  void filter_backwards(std::vector<double>& x) const;

  bool defined_;
  Biquad filter_;
  std::size_t lookahead_ = 0;    ///< samples
  std::vector<double> last_;     ///< kPad + 1 inputs
  std::vector<double> forward_;  ///< filtered forwards, not yet backwards
  std::vector<double> final_;
};

/// Variance of a signal after ZeroPhaseLowpass.
class FilteredVariance {
 public:
  FilteredVariance(double rate, double cutoff) : filter_(rate, cutoff) {}

  void add(double x);
  /// Mean and variance if the record ends here.
  RunningMoments moments() const;

 private:
  ZeroPhaseLowpass filter_;
  RunningMoments moments_;
};

/// The same of a signal's derivative: central difference, one-sided at the two ends.
class FilteredSlopeVariance {
 public:
  FilteredSlopeVariance(double rate, double cutoff) : rate_(rate), slope_(rate, cutoff) {}

  void add(double x);
  RunningMoments moments() const;

 private:
  double rate_;  ///< Hz
  FilteredVariance slope_;
  std::size_t count_ = 0;
  double last_ = 0.0, before_last_ = 0.0;
};

}  // namespace pirouette
