#include "pirouette/lowlevel/swing_leg.hpp"

namespace pirouette {

namespace {

/// Minimum-jerk blend from 0 to 1 and its derivatives with respect to s.
struct Blend {
  double value, rate, curvature;
};

Blend minimum_jerk(double s) {
  return {s * s * s * (10.0 + s * (-15.0 + 6.0 * s)), 30.0 * s * s * (1.0 + s * (-2.0 + s)),
          60.0 * s * (1.0 + s * (-3.0 + 2.0 * s))};
}

}  // namespace

SwingTarget swing_target(const SwingInput& in) noexcept {
  const double s = std::clamp(in.progress, 0.0, 1.0);
  const double rate = 1.0 / std::max(in.duration, 1e-3);
  const Vec3 travel = in.p_WF_target - in.p_WF_liftoff;

  SwingTarget out;
  const Blend along = minimum_jerk(s);
  out.p_WF = in.p_WF_liftoff + along.value * travel;
  out.v_WF_W = along.rate * rate * travel;
  out.a_WF_W = along.curvature * square(rate) * travel;

  const double apex = std::max(in.p_WF_liftoff.z(), in.p_WF_target.z()) + in.clearance;
  const bool rising = s < 0.5;
  const double from = rising ? in.p_WF_liftoff.z() : apex;
  const double to = rising ? apex : in.p_WF_target.z();
  const Blend half = minimum_jerk(rising ? 2.0 * s : 2.0 * s - 1.0);
  out.p_WF.z() = from + half.value * (to - from);
  out.v_WF_W.z() = half.rate * 2.0 * rate * (to - from);
  out.a_WF_W.z() = half.curvature * square(2.0 * rate) * (to - from);
  return out;
}

}  // namespace pirouette
