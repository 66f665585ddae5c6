#include "pirouette/metrics/turn_window.hpp"

#include <algorithm>
#include <cmath>

namespace pirouette {
namespace {

constexpr double kTurn = 2.0 * kPi;

}  // namespace

void TurnWindow::add(double yaw, const Vec2& p, const Vec2& error) {
  if (!started_) first_yaw_ = yaw;
  started_ = true;
  last_yaw_ = yaw;
  const Vec4 both(p.x(), p.y(), error.x(), error.y());
  in_first_turn_ = in_first_turn_ && std::abs(yaw - first_yaw_) < kTurn;
  if (in_first_turn_) {
    first_turn_.sum += both;
    ++first_turn_.count;
  }
  if (direction_ == 0.0 && std::abs(turned()) >= kPi) direction_ = turned() < 0.0 ? -1.0 : 1.0;

  if (open_.count == 0) open_ = {yaw, p, Vec4::Zero(), 0};
  open_.sum += both;
  if (++open_.count < group_) return;
  samples_.push_back(open_);
  open_ = {};
  if (direction_ != 0.0) measure();
  forget();
  if (samples_.size() >= kCapacity) thin();
}

void TurnWindow::measure() {
  for (; next_ < samples_.size(); ++next_) {
    const double here = turned(next_);
    for (; to_ < samples_.size() && turned(to_) < here + kPi; ++to_) {
      turn_sum_ += samples_[to_].sum.head<2>();
      turn_count_ += samples_[to_].count;
    }
    if (to_ == samples_.size()) return;  // half a turn more is needed
    for (; from_ < to_ && turned(from_) < here - kPi; ++from_) {
      turn_sum_ -= samples_[from_].sum.head<2>();
      turn_count_ -= samples_[from_].count;
    }
    if (here < kPi) continue;
    const Vec2 average = turn_sum_ / static_cast<double>(turn_count_);
    const double count = static_cast<double>(samples_[next_].count);
    distance_to_average_.add(count, (samples_[next_].p - average).norm(), 0.0);
  }
}

void TurnWindow::forget() {
  constexpr double kMore = 0.3;  // rad; yaw may go back a little while the robot turns
  while (from_ > 0 && std::abs(last_yaw_ - samples_.front().yaw) >= kTurn + kMore) {
    samples_.pop_front();
    --from_, --next_, --to_;
  }
}

void TurnWindow::thin() {
  std::deque<Samples> half;
  for (std::size_t i = 0; i + 1 < samples_.size(); i += 2) {
    half.push_back(samples_[i]);
    half.back().sum += samples_[i + 1].sum;
    half.back().count += samples_[i + 1].count;
  }
  samples_ = std::move(half);
  group_ *= 2;
  next_ = (next_ + 1) / 2;
  from_ /= 2;
  to_ /= 2;
  turn_sum_.setZero();
  turn_count_ = 0;
  for (std::size_t i = from_; i < to_; ++i) {
    turn_sum_ += samples_[i].sum.head<2>();
    turn_count_ += samples_[i].count;
  }
}

std::optional<TurnWindow::Drift> TurnWindow::drift_per_turn() const {
  const double turns = std::abs(turned()) / kTurn;
  if (turns < 2.0) return std::nullopt;
  Vec4 sum = open_.sum;
  double count = static_cast<double>(open_.count);
  for (std::size_t i = samples_.size(); i-- > 0;) {
    if (std::abs(last_yaw_ - samples_[i].yaw) >= kTurn) break;
    sum += samples_[i].sum;
    count += static_cast<double>(samples_[i].count);
  }
  const Vec4 move = sum / count - first_turn_.sum / static_cast<double>(first_turn_.count);
  return Drift{move.head<2>().norm() / (turns - 1.0), move.tail<2>().norm() / (turns - 1.0)};
}

}  // namespace pirouette
