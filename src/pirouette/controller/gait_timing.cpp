#include "pirouette/controller/gait_timing.hpp"

namespace pirouette {

GaitTimingOutput GaitTiming::update(const GaitTimingInput& in, double dt) noexcept {
  const bool careful = config_.adapt && in.last_stepped;
  const Vec2 v_error = (in.v_WG_W - in.last_reference_v_WG_W).head<2>();
  GaitTimingOutput out;
  out.recovering =
      push_recovery_.update(v_error, dt) && in.last_walking && config_.adapt && !careful;
  const double yaw_rate = in.last_path_yaw_rate.value_or(in.command.yaw_rate);
  const double stride =
      out.recovering ? config_.recovery_period_at(yaw_rate) : config_.period_at(yaw_rate);
  clock_.set_timing(stride, careful ? config_.step_duty_at(stride) : config_.duty);
  if (out.recovering) clock_.hurry();
  out.gait = clock_.update(in.command.walk, dt);
  return out;
}

void GaitTiming::reset() noexcept {
  push_recovery_.reset();
  clock_.reset();
}

}  // namespace pirouette
