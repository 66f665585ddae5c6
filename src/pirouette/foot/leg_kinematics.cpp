#include "pirouette/foot/leg_kinematics.hpp"

#include "pirouette/types/robot_scale.hpp"

namespace pirouette {
namespace {

// Of a leg of scale 1.
constexpr double kReachMargin = 1e-4;          // m, kept from the straight and the folded leg
constexpr double kSingularDeterminant = 2e-4;  // m^3, below it the velocity inverse is damped
constexpr double kMaxDamping = 0.05;           // m/rad

RobotScale scale_of(const LegGeometry& leg) {
  return RobotScale::of(leg.thigh + leg.shank, RobotScale::kMass);
}

// Leg in its own plane: x forwards and `depth` below the abad axis, with the angles both come from.
struct LegPlane {
  double c1, s1, s23, c23;
  double x, depth;

  LegPlane(const LegGeometry& leg, const Vec3& q)
      : c1(std::cos(q[0])),
        s1(std::sin(q[0])),
        s23(std::sin(q[1] + q[2])),
        c23(std::cos(q[1] + q[2])),
        x(-leg.thigh * std::sin(q[1]) - leg.shank * s23),
        depth(leg.hip_drop + leg.thigh * std::cos(q[1]) + leg.shank * c23) {}

  Vec3 foot(double abad_offset) const {
    return {x, c1 * abad_offset + s1 * depth, s1 * abad_offset - c1 * depth};
  }
};

}  // namespace

Vec3 foot_position_H(const LegGeometry& leg, const Vec3& q) {
  return LegPlane(leg, q).foot(leg.abad_offset);
}

Mat3 foot_jacobian(const LegGeometry& leg, const Vec3& q) {
  const LegPlane plane(leg, q);
  const Vec3 p = plane.foot(leg.abad_offset);
  const double shank_s = leg.shank * plane.s23, shank_c = leg.shank * plane.c23;
  Mat3 J;
  J << 0.0, -(plane.depth - leg.hip_drop), -shank_c,    //
      -p.z(), plane.s1 * plane.x, -plane.s1 * shank_s,  //
      p.y(), -plane.c1 * plane.x, plane.c1 * shank_s;
  return J;
}

Mat3 shank_jacobian(const Vec3& q) {
  const double c1 = std::cos(q[0]), s1 = std::sin(q[0]);
  Mat3 J;
  J << 1.0, 0.0, 0.0, 0.0, c1, c1, 0.0, s1, s1;
  return J;
}

Mat3 shank_rotation(const Vec3& q) { return rot_x(q[0]) * rot_y(q[1] + q[2]); }

double foot_jacobian_determinant(const LegGeometry& leg, const Vec3& q) {
  return LegPlane(leg, q).depth * leg.thigh * leg.shank * std::sin(q[2]);
}

FootState foot_state(const LegGeometry& leg, const Vec3& q, const Vec3& dq) {
  return {.p_BF = leg.p_BH + foot_position_H(leg, q),
          .v_BF_B = foot_jacobian(leg, q) * dq,
          .w_BS_B = shank_jacobian(q) * dq,
          .R_BS = shank_rotation(q)};
}

IkSolution inverse_kinematics(const LegGeometry& leg, const Vec3& p_HF, double knee_sign) {
  constexpr double kOnAxis = 1e-9;  // m
  const double d = leg.abad_offset;
  IkSolution out;

  double y = p_HF.y(), z = p_HF.z(), depth = 0.0;
  const double reach2 = square(y) + square(z);
  if (reach2 < square(d)) {
    out.abad = true;
    if (reach2 < square(kOnAxis)) y = d, z = 0.0;
  } else {
    depth = std::sqrt(reach2 - square(d));
  }
  // Before the clamp below, which changes the depth but not the plane that the leg swings in.
  out.q[0] = std::atan2(y * depth + z * d, y * d - z * depth);

  double x = p_HF.x();
  depth -= leg.hip_drop;
  const double margin = kReachMargin * scale_of(leg).length;
  const double longest = leg.thigh + leg.shank - margin;
  const double shortest = std::abs(leg.thigh - leg.shank) + margin;
  const double length = std::hypot(x, depth);
  out.far = length > longest;
  out.near = length < shortest;
  if (out.far || out.near) {
    const double allowed = out.far ? longest : shortest;
    if (length < kOnAxis) {
      x = 0.0;
      depth = allowed;
    } else {
      x *= allowed / length;
      depth *= allowed / length;
    }
  }

  const double c3 = (square(x) + square(depth) - square(leg.thigh) - square(leg.shank)) /
                    (2.0 * leg.thigh * leg.shank);
  out.q[2] = knee_sign * std::acos(std::clamp(c3, -1.0, 1.0));
  const double knee_lead =
      std::atan2(leg.shank * std::sin(out.q[2]), leg.thigh + leg.shank * std::cos(out.q[2]));
  out.q[1] = wrap_angle(std::atan2(-x, depth) - knee_lead);
  return out;
}

Vec3 inverse_velocity_kinematics(const LegGeometry& leg, const Vec3& q, const Vec3& v_HF) {
  const Mat3 J = foot_jacobian(leg, q);
  const RobotScale scale = scale_of(leg);
  const double closeness =
      std::abs(foot_jacobian_determinant(leg, q)) / (kSingularDeterminant * scale.volume());
  if (closeness >= 1.0) return J.inverse() * v_HF;
  const double damping2 = square(kMaxDamping * scale.length) * (1.0 - square(closeness));
  return J.transpose() * (J * J.transpose() + damping2 * Mat3::Identity()).inverse() * v_HF;
}

}  // namespace pirouette
