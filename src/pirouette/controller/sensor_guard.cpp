#include "pirouette/controller/sensor_guard.hpp"

#include <algorithm>
#include <cmath>

#include "pirouette/controller/tick_clock.hpp"

namespace pirouette {

namespace {

bool is_finite(const SensorReading& s) {
  bool ok = std::isfinite(s.time) && s.specific_force_B.allFinite() && s.w_WB_B.allFinite();
  for (const Leg leg : kLegs)
    ok = ok && s.joint_position[leg].allFinite() && s.joint_velocity[leg].allFinite();
  if (s.truth) {
    ok = ok && s.truth->p_WB.allFinite() && s.truth->R_WB.allFinite() &&
         s.truth->v_WB_W.allFinite() && s.truth->w_WB_B.allFinite();
  }
  return ok;
}

bool is_finite(const PositionAid& aid) {
  return aid.p_WB.allFinite() && std::isfinite(aid.yaw) && std::isfinite(aid.time);
}

bool is_finite(const PerLeg<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

bool is_finite(const MotionCommand& c) {
  return c.v_H.allFinite() && std::isfinite(c.yaw_rate) && (!c.point || c.point->allFinite()) &&
         (!c.heading || std::isfinite(*c.heading));
}

}  // namespace

bool SensorGuard::update(const SensorReading& sensors, const MotionCommand& command,
                         const JointCommand& sent, bool walking) noexcept {
  if (!is_finite(sensors) || !is_finite(command)) {
    ++bad_inputs_;
    input_.sensors.time += period_;
    input_.sensors.aid.reset();  // heard once
    return started_ && bad_inputs_ <= ticks_in(config_.max_bad_reading_time, period_);
  }
  bad_inputs_ = 0;
  if (started_) {
    watch_imu(sensors, walking);
    watch_encoders(sensors, sent);
  }
  const Vec3 last_w_WB_B = input_.sensors.w_WB_B;
  const Vec3 last_specific_force_B = input_.sensors.specific_force_B;
  input_.sensors = sensors;
  if (sensors.aid && !is_finite(*sensors.aid)) input_.sensors.aid.reset();
  if (sensors.foot_force && !is_finite(*sensors.foot_force)) input_.sensors.foot_force.reset();
  input_.command = command;
  if (outliers_ > 0) {
    input_.sensors.w_WB_B = last_w_WB_B;
    input_.sensors.specific_force_B = last_specific_force_B;
  }
  last_raw_ = sensors;
  started_ = true;
  const auto blind_legs =
      std::count(input_.encoder_stuck.begin(), input_.encoder_stuck.end(), true);
  return std::max(gyro_repeats_, accelerometer_repeats_) <=
             ticks_in(config_.max_repeat_time, period_) &&
         blind_legs <= 1;
}

bool SensorGuard::is_outlier(const SensorReading& sensors) const noexcept {
  const SensorReading& last = input_.sensors;
  return (sensors.w_WB_B - last.w_WB_B).norm() > config_.max_gyro_step ||
         (sensors.specific_force_B - last.specific_force_B).norm() > config_.max_accelerometer_step;
}

void SensorGuard::watch_imu(const SensorReading& sensors, bool walking) noexcept {
  // What stays there for long is no spike: the robot was hit.
  const bool spike =
      is_outlier(sensors) && outliers_ < ticks_in(config_.max_bad_reading_time, period_);
  outliers_ = spike ? outliers_ + 1 : 0;
  const auto count = [&](int& repeats, const Vec3& now, const Vec3& before) {
    repeats = walking && now == before ? repeats + 1 : 0;
  };
  count(gyro_repeats_, sensors.w_WB_B, last_raw_.w_WB_B);
  count(accelerometer_repeats_, sensors.specific_force_B, last_raw_.specific_force_B);
}

void SensorGuard::watch_encoders(const SensorReading& sensors, const JointCommand& sent) noexcept {
  for (const Leg leg : kLegs) {
    const auto repeated =
        sensors.joint_position[leg].array() == last_raw_.joint_position[leg].array();
    const Vec3 travel = blind_travel_[leg] + period_ * sent[leg].dq.cwiseAbs();
    blind_travel_[leg] = repeated.select(travel, Vec3::Zero());
    input_.encoder_stuck[leg] = blind_travel_[leg].maxCoeff() > config_.max_blind_travel;
  }
}

void SensorGuard::reset() noexcept { *this = SensorGuard(config_, period_); }

}  // namespace pirouette
