#include "pirouette/controller/body_horizon.hpp"

#include "pirouette/base/planar_twist.hpp"

namespace pirouette {

namespace {

/// Velocity along the plane whose horizontal part is `v_xy`.
Vec3 along_plane(const Vec2& v_xy, const TerrainPlane& plane) {
  return Vec3(v_xy.x(), v_xy.y(), plane.a1 * v_xy.x() + plane.a2 * v_xy.y());
}

}  // namespace

BodyReference body_reference(const HorizonInput& in) noexcept {
  BodyReference out;
  const Vec2 lead = clamp_norm<2>(in.com_plan.p_WG - in.p_WG, in.max_lead);
  const Vec2 p_xy = in.p_WG + lead;
  const Vec2 v_xy = rot2(in.yaw) * in.twist.v_H;
  out.p_WG << p_xy, in.plane.height(p_xy) + in.com_height;
  out.v_WG_W = along_plane(v_xy, in.plane);
  out.a_WG_W = in.twist.yaw_rate * along_plane(Vec2(-v_xy.y(), v_xy.x()), in.plane);
  out.rpy = terrain_aligned_rpy(in.plane, in.path.yaw);
  out.rpy.yaw = in.path.yaw;
  out.w_WB_W = terrain_aligned_rate(in.plane, in.path.yaw, in.twist.yaw_rate);
  out.twist = in.twist;
  return out;
}

BodyMotion reference_after(const BodyReference& reference, const TerrainPlane& plane,
                           double com_height, double t) noexcept {
  const TwistCommand& twist = reference.twist;
  const double turned = twist.yaw_rate * t;
  // The velocity reference lies in the robot's heading, so carry it in world axes.
  const Vec2 v_now = reference.v_WG_W.head<2>();
  const Vec2 p_xy = reference.p_WG.head<2>() + planar_twist_displacement(v_now, twist.yaw_rate, t);
  const double yaw = reference.rpy.yaw + turned;
  const RollPitchYaw rpy = terrain_aligned_rpy(plane, yaw);

  BodyMotion out;
  out.rpy = Vec3(rpy.roll, rpy.pitch, yaw);
  out.p_WG << p_xy, plane.height(p_xy) + com_height;
  out.v_WG_W = along_plane(rot2(turned) * v_now, plane);
  out.w_WB_W = terrain_aligned_rate(plane, yaw, twist.yaw_rate);
  return out;
}

}  // namespace pirouette
