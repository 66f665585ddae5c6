// The last turn of a robot: what is measured against averages over a turn.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "pirouette/base/math.hpp"
#include "pirouette/metrics/running_statistics.hpp"

namespace pirouette {

/// The samples of a little more than the last turn, kCapacity at most: when there are more, two
/// neighbours become one, which keeps the sum of both and the place of the first. `yaw` is
/// unwrapped.
class TurnWindow {
 public:
  static constexpr std::size_t kCapacity = 65536;

  /// `error` is any second place whose drift is wanted.
  void add(double yaw, const Vec2& p, const Vec2& error);

  double turned() const { return last_yaw_ - first_yaw_; }  ///< rad, signed

  struct Drift {
    double p = 0.0, error = 0.0;  ///< m per turn
  };
  /// From the mean point of the first turn to that of the last one, divided by the turns between
  /// the middles of both. Absent for less than two turns.
  std::optional<Drift> drift_per_turn() const;

  /// Distance of each p to the mean of those from half a turn before it to half a turn after, where
  /// both are in the record. The direction of the turn is that of the first half turn.
  const RunningMoments& distance_to_average() const { return distance_to_average_; }

 private:
  struct Samples {
    double yaw = 0.0;         ///< of the first
    Vec2 p = Vec2::Zero();    ///< of the first
    Vec4 sum = Vec4::Zero();  ///< of p and error
    std::size_t count = 0;
  };

  double turned(std::size_t i) const { return direction_ * (samples_[i].yaw - first_yaw_); }
  void keep(const Samples& samples);
  void measure();
  void forget();
  void thin();

  bool started_ = false;
  double first_yaw_ = 0.0, last_yaw_ = 0.0;
  Samples first_turn_;  ///< its sum and count
  bool in_first_turn_ = true;

  std::deque<Samples> samples_;
  Samples open_;           ///< fewer than group_
  std::size_t group_ = 1;  ///< samples in each of samples_

  double direction_ = 0.0;         ///< 1 or -1; 0 before half a turn
  std::size_t next_ = 0;           ///< whose distance is next
  std::size_t from_ = 0, to_ = 0;  ///< the turn about it is [from_, to_)
  Vec2 turn_sum_ = Vec2::Zero();   ///< of p over that turn
  std::size_t turn_count_ = 0;
  RunningMoments distance_to_average_;
};

}  // namespace pirouette
