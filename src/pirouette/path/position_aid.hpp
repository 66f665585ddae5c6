// Position measured from outside, as a slow offset of the set-point.
#pragma once

#include <array>
#include <optional>

#include "pirouette/base/math.hpp"
#include "pirouette/path/path_config.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Low-pass of (aid - odometry): position of the odometry's frame in the aid's. Used in the
/// odometry filter, an aid would add its noise to the velocity; as an offset of the set-point it
/// moves the robot slowly. Measurements are compared with the odometry at their own time. Drop-outs
/// are bridged; after the loss of the aid the last offset stays.
class PositionAidOffset {
 public:
  /// Offset zero.
  explicit PositionAidOffset(const AidConfig& config) : config_(config) { reset(); }

  /// Offset (m, horizontal) to be added to the odometry's position. `p_WB` (m) is the odometry at
  /// `time` (s); `dt` in s.
  Vec2 update(const std::optional<PositionAid>& aid, const Vec2& p_WB, double time,
              double dt) noexcept;
  void reset() noexcept;  ///< offset zero, no measurement yet

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, history, recorded, offset, heard_for, silent_for, known] = self;
    visit(history, recorded, offset, heard_for, silent_for, known);
  }

 private:
  struct Past {
    double time = 0.0;
    Vec2 p_WB = Vec2::Zero();
  };
  void record(double time, const Vec2& p_WB) noexcept;
  std::optional<Vec2> odometry_at(double time) const noexcept;

  static constexpr std::size_t kHistory = AidConfig::kHistory;
  AidConfig config_;
  std::array<Past, kHistory> history_;
  std::size_t recorded_ = 0;
  Vec2 offset_ = Vec2::Zero();  ///< m
  double heard_for_ = 0.0;      ///< s, for which the aid has measured
  double silent_for_ = 0.0;     ///< s since its last measurement
  bool known_ = false;
};

}  // namespace pirouette
