#include "pirouette/path/position_aid.hpp"

namespace pirouette {

void PositionAidOffset::reset() noexcept {
  recorded_ = 0;
  offset_.setZero();
  heard_for_ = silent_for_ = 0.0;
  known_ = false;
}

std::optional<Vec2> PositionAidOffset::odometry_at(double time) const noexcept {
  const std::size_t known = std::min(recorded_, kHistory);
  for (std::size_t back = 1; back <= known; ++back) {
    const Past& past = history_[(recorded_ - back) % kHistory];
    if (past.time > time) continue;
    if (back == 1) return past.p_WB;
    const Past& next = history_[(recorded_ - back + 1) % kHistory];
    const double share = (time - past.time) / (next.time - past.time);
    return past.p_WB + share * (next.p_WB - past.p_WB);
  }
  return std::nullopt;
}

/// The newest pose is always kept; it replaces one that is too close behind the one before it.
void PositionAidOffset::record(double time, const Vec2& p_WB) noexcept {
  const auto past_time = [&](std::size_t back) {
    return history_[(recorded_ - back) % kHistory].time;
  };
  const bool crowded = recorded_ >= 2 && past_time(1) - past_time(2) < AidConfig::kMinSpacing;
  if (!crowded) ++recorded_;
  history_[(recorded_ - 1) % kHistory] = {time, p_WB};
}

Vec2 PositionAidOffset::update(const std::optional<PositionAid>& aid, const Vec2& p_WB, double time,
                               double dt) noexcept {
  if (!config_.enabled) return Vec2::Zero();
  record(time, p_WB);
  silent_for_ += dt;
  const std::optional<Vec2> then = aid ? odometry_at(aid->time) : std::nullopt;
  if (!then) return offset_;
  const Vec2 measured = aid->p_WB.head<2>() - *then;
  if ((measured - offset_).norm() > config_.max_offset) return offset_;

  // An aid that comes back is ramped in again.
  const bool alive = known_ && silent_for_ <= config_.timeout;
  heard_for_ = alive ? heard_for_ + silent_for_ : 0.0;
  const double influence =
      config_.ramp_time > 0.0 ? std::min(1.0, heard_for_ / config_.ramp_time) : 1.0;
  const double gap = std::min(silent_for_, config_.timeout);
  offset_ += influence * (1.0 - std::exp(-gap / config_.time_constant)) * (measured - offset_);
  known_ = true;
  silent_for_ = 0.0;
  return offset_;
}

}  // namespace pirouette
