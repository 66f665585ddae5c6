#include "pirouette/path/position_aid.hpp"

namespace pirouette {

void PositionAidOffset::reset() noexcept {
  recorded_ = 0;
  target_.setZero();
  offset_.setZero();
  heard_for_ = silent_for_ = 0.0;
  known_ = false;
}

std::optional<Vec2> PositionAidOffset::odometry_at(double time) const noexcept {
  const std::size_t known = std::min(recorded_, kHistory);
  for (std::size_t back = 1; back <= known; ++back) {
    const Past& past = history_[(recorded_ - back) % kHistory];
    if (past.time <= time) return past.p_WB;
  }
  return std::nullopt;
}

Vec2 PositionAidOffset::update(const std::optional<PositionAid>& aid, const Vec2& p_WB, double time,
                               double dt) noexcept {
  if (!config_.enabled) return Vec2::Zero();
  history_[recorded_++ % kHistory] = {time, p_WB};
  silent_for_ += dt;
  if (aid) {
    const std::optional<Vec2> then = odometry_at(aid->time);
    const Vec2 measured = then ? Vec2(aid->p_WB.head<2>() - *then) : target_;
    if (then && (measured - offset_).norm() <= config_.max_offset) {
      target_ = measured;
      silent_for_ = 0.0;
      known_ = true;
    }
  }
  if (!known_ || silent_for_ > config_.timeout) {
    heard_for_ = 0.0;  // an aid that comes back is ramped in again
    return offset_;
  }
  heard_for_ += dt;
  const double influence =
      config_.ramp_time > 0.0 ? std::min(1.0, heard_for_ / config_.ramp_time) : 1.0;
  offset_ += influence * (1.0 - std::exp(-dt / config_.time_constant)) * (target_ - offset_);
  return offset_;
}

}  // namespace pirouette
