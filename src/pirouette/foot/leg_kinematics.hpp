// Forward and inverse kinematics of one leg: joint angles and the centre of the foot sphere.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/types/foot_state.hpp"
#include "pirouette/types/leg_geometry.hpp"

namespace pirouette {

/// Sphere centre (m) at joint angles `q` (rad) in hip axes (origin at the abad axis, parallel to
/// the trunk). [Zhu21] Eq. (5), corrected (E2): docs/equations.md#eq-5
Vec3 foot_position_H(const LegGeometry& leg, const Vec3& q);

/// J_v (m/rad) of E3: velocity of the sphere centre relative to the trunk is J_v dq, trunk axes.
Mat3 foot_jacobian(const LegGeometry& leg, const Vec3& q);

/// J_w of E3: angular velocity of the shank relative to the trunk is J_w dq, trunk axes.
Mat3 shank_jacobian(const Vec3& q);

/// R_BS, orientation of the shank; its -z axis points from the knee to the foot.
Mat3 shank_rotation(const Vec3& q);

/// det J_v (m^3), E4. Zero where the leg is straight, folded, or the foot is level with the abad
/// axis.
double foot_jacobian_determinant(const LegGeometry& leg, const Vec3& q);

/// Foot relative to the trunk, at joint angles `q` (rad) and velocities `dq` (rad/s).
FootState foot_state(const LegGeometry& leg, const Vec3& q, const Vec3& dq);

/// Joint angles that reach a point, or for an unreachable point the nearest ones in its direction.
struct IkSolution {
  Vec3 q = Vec3::Zero();  ///< rad, always finite for a finite point
  bool abad = false;      ///< the point is nearer to the abad axis than the plane of the leg
  bool far = false;       ///< the point is beyond the straight leg
  bool near = false;      ///< the point is within the folded leg

  bool reachable() const { return !abad && !far && !near; }  ///< the point is reached
};

/// Inverse of foot_position_H for `p_HF` (m) with the foot below the abad axis. Joint limits are
/// not applied. [Zhu21] Eq. (6), corrected (E5): docs/equations.md#eq-6
IkSolution inverse_kinematics(const LegGeometry& leg, const Vec3& p_HF, double knee_sign);
/// The same with the knee sign of `leg`.
inline IkSolution inverse_kinematics(const LegGeometry& leg, const Vec3& p_HF) {
  return inverse_kinematics(leg, p_HF, leg.knee_sign);
}

/// Joint velocity (rad/s) that moves the sphere centre at `v_HF` (m/s, trunk axes); damped least
/// squares near singular postures, exact away from them.
Vec3 inverse_velocity_kinematics(const LegGeometry& leg, const Vec3& q, const Vec3& v_HF);

}  // namespace pirouette
