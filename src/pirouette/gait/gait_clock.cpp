#include "pirouette/gait/gait_clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pirouette {
namespace {

// Share of a stride by which two moments count as one: rounding must neither delay an event by a
// tick nor add up over the strides.
constexpr double kSameMoment = 1e-9;

double fold(double cycle) {
  const double folded = cycle - std::floor(cycle + kSameMoment);
  return folded < kSameMoment ? 0.0 : folded;
}

bool is_stance(double leg_cycle, double duty) { return leg_cycle < duty - kSameMoment; }

int lift_offs_before(double cycle, double duty) {
  return static_cast<int>(std::floor(cycle - duty + kSameMoment));
}

LegPhase scheduled_phase(double leg_cycle, double duty, double period, int stride) {
  LegPhase phase;
  phase.stance = is_stance(leg_cycle, duty);
  phase.duration = period * (phase.stance ? duty : 1.0 - duty);
  phase.time_remaining = period * ((phase.stance ? duty : 1.0) - leg_cycle);
  phase.progress = std::clamp(1.0 - phase.time_remaining / phase.duration, 0.0, 1.0);
  phase.stride = stride;
  return phase;
}

// A foot that stays down is always in mid-stance.
LegPhase resting_phase(double stance_duration, double time_remaining, int stride) {
  return {.stance = true,
          .progress = 0.5,
          .duration = stance_duration,
          .time_remaining = time_remaining,
          .stride = stride};
}

}  // namespace

GaitClock::GaitClock(const GaitConfig& config)
    : initial_period_(config.period), initial_duty_(config.duty) {
  reset();
}

void GaitClock::reset() noexcept {
  walking_ = stopping_ = false;
  cycle_ = 0.0;
  legs_ = {};
  set_timing(initial_period_, initial_duty_);
}

void GaitClock::set_timing(double period, double duty) noexcept {
  next_period_ = period;
  next_duty_ = duty;
  if (!walking_) adopt_timing();
}

void GaitClock::adopt_timing() noexcept {
  period_ = next_period_;
  for (LegState& leg : legs_) leg.duty = next_duty_;
}

GaitPhase GaitClock::update(bool walk, double dt) noexcept {
  if (!walking_) {
    if (walk) start();
  } else {
    stopping_ = !walk;
    follow_or_rest();
    advance(dt);
    follow_or_rest();
    const bool any_scheduled =
        std::any_of(legs_.begin(), legs_.end(), [](const LegState& leg) { return leg.scheduled; });
    if (stopping_ && !any_scheduled) {
      walking_ = stopping_ = false;
      adopt_timing();
    }
  }
  return current();
}

void GaitClock::start() noexcept {
  walking_ = true;
  cycle_ = 0.0;
  for (const Leg leg : kLegs) {
    const bool lifting = std::abs(leg_cycle(leg) - legs_[leg].duty) <= kSameMoment;
    legs_[leg].scheduled = in_stance(leg) || lifting;
    legs_[leg].stride = lifting ? 1 : 0;
  }
}

// Feet change between schedule and rest only while the schedule has them on the ground.
void GaitClock::follow_or_rest() noexcept {
  for (const Leg leg : kLegs) {
    if (in_stance(leg)) legs_[leg].scheduled = !stopping_;
  }
}

void GaitClock::advance(double dt) noexcept {
  PerLeg<double> before;
  for (const Leg leg : kLegs) before[leg] = leg_cycle(leg);
  const double moved = cycle_ + dt / period_;
  cycle_ = fold(moved);
  if (moved - cycle_ > 0.5) {
    cycle_ *= period_ / next_period_;
    period_ = next_period_;
  }
  for (const Leg leg : kLegs) {
    LegState& state = legs_[leg];
    const bool was_stance = is_stance(before[leg], state.duty);
    if (leg_cycle(leg) < before[leg]) state.duty = next_duty_;
    if (state.scheduled && was_stance && !in_stance(leg)) ++state.stride;
  }
}

double GaitClock::leg_cycle(Leg leg) const noexcept {
  const bool first_pair = leg == Leg::kFR || leg == Leg::kRL;
  return fold(cycle_ + (first_pair ? 0.0 : 0.5));
}

bool GaitClock::in_stance(Leg leg) const noexcept {
  return is_stance(leg_cycle(leg), legs_[leg].duty);
}

LegPhase GaitClock::phase_at(Leg leg, double t_ahead) const noexcept {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  const LegState& state = legs_[leg];
  const double stance_duration = state.duty * period_;
  const double now = leg_cycle(leg);
  const double then = now + t_ahead / period_;
  const bool before_touchdown = then < 1.0 - kSameMoment;

  const bool rests = !walking_ || (stopping_ && (!state.scheduled || !before_touchdown));
  if (rests) return resting_phase(stance_duration, kForever, state.stride);
  if (!state.scheduled && before_touchdown) {
    return resting_phase(stance_duration, (1.0 + state.duty - then) * period_, state.stride);
  }
  const int lift_offs = lift_offs_before(then, state.duty) - lift_offs_before(now, state.duty);
  return scheduled_phase(fold(then), state.duty, period_, state.stride + lift_offs);
}

GaitPhase GaitClock::current() const noexcept {
  GaitPhase phase;
  phase.walking = walking_;
  phase.cycle = cycle_;
  phase.stance_duration = legs_[Leg::kFR].duty * period_;
  phase.swing_duration = (1.0 - legs_[Leg::kFR].duty) * period_;
  for (const Leg leg : kLegs) phase.leg[leg] = phase_at(leg, 0.0);
  return phase;
}

}  // namespace pirouette
