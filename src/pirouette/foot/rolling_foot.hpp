// Foot model: a sphere that rolls on the ground. Estimator, planner and dynamics share it.
#pragma once

#include "pirouette/base/math.hpp"
#include "pirouette/foot/foot_config.hpp"
#include "pirouette/foot/leg_kinematics.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/foot_state.hpp"
#include "pirouette/types/leg_geometry.hpp"

namespace pirouette {

/// Solution of the implicit inverse kinematics of an ideal foothold.
struct IdealFootholdIk {
  IkSolution ik;           ///< joint angles of the last iteration
  int iterations = 0;      ///< done
  bool converged = false;  ///< the iteration has converged
  bool tilted = false;  ///< the shank leans so far that it would touch the ground before the sphere

  /// The foothold is reached.
  bool valid() const { return converged && !tilted && ik.reachable(); }
};

/// Predicted motion in a stance: the trunk follows a planar twist of its CoM and turns about the
/// ground normal.
struct StanceMotion {
  Vec3 p_BF = Vec3::Zero();      ///< m, sphere centre at mid-stance, trunk axes
  Vec3 p_BG = Vec3::Zero();      ///< m, CoM in trunk axes
  Mat3 R_HB = Mat3::Identity();  ///< trunk in heading axes at mid-stance: its tilt
  Vec3 n_H = Vec3::UnitZ();      ///< ground normal, heading axes
  TwistCommand twist{};          ///< of the CoM, heading axes
  double duration = 0.0;         ///< s, of the stance
};

/// Sphere of radius r that rolls without slip. FootModel::kCentre is a sphere of radius 0: its
/// contact point is the sphere's centre and every rolling term vanishes.
/// `n_W` is the unit normal of the ground; w_WS the angular velocity of the shank S in the world.
class RollingFoot {
 public:
  RollingFoot() = default;  ///< a point foot
  /// `radius` (m) of the foot sphere.
  RollingFoot(FootModel model, double radius)
      : radius_(model == FootModel::kRolling ? radius : 0.0) {}

  /// Radius (m) of the rolling sphere: 0 for the centre model.
  double radius() const { return radius_; }

  /// Height (m) of the sphere centre above the contact, along the normal.
  double centre_offset() const { return radius_; }
  /// Contact point (m, world) of the sphere centre `p_WF` (m).
  Vec3 contact_point(const Vec3& p_WF, const Vec3& n_W) const { return p_WF - radius_ * n_W; }
  /// Sphere centre (m, world) above the contact point `p_WC` (m).
  Vec3 centre_from_contact(const Vec3& p_WC, const Vec3& n_W) const { return p_WC + radius_ * n_W; }

  /// Velocity (m/s) of the sphere centre and of the contact point, rolling without slip (E6).
  Vec3 rolling_velocity(const Vec3& w_WS_W, const Vec3& n_W) const {
    return radius_ * w_WS_W.cross(n_W);
  }

  /// m/rad, leg columns of the contact Jacobian in trunk axes, J_v + r [n_B]x J_w (E13): velocity
  /// of the material point at the contact relative to the trunk.
  Mat3 contact_jacobian(const LegGeometry& leg, const Vec3& q, const Vec3& n_B) const;

  /// Velocity (m/s, world axes) of the trunk's origin, measured by this foot as it rolls (E12).
  Vec3 odometry_velocity(const FootState& foot, const Mat3& R_WB, const Vec3& w_WB_W,
                         const Vec3& n_W) const;

  /// Travel (m) of the contact while the shank turns from R_WS_0 to R_WS_1 about one axis (E8).
  Vec3 displacement(const Mat3& R_WS_0, const Mat3& R_WS_1, const Vec3& n_W) const;

  /// Travel (m, world axes) of the contact under a level trunk between joint angles `q_0` and `q_1`
  /// (rad); `yaw` (rad) at the middle of the motion (E9).
  Vec3 level_displacement(const Vec3& q_0, const Vec3& q_1, double yaw) const;

  /// Vector (m) from the contact to the ideal foothold: the contact when the shank has rolled
  /// upright. `shank` is the unit vector from knee to foot.
  /// [Zhu21] Eq. (10), corrected (E10): docs/equations.md#eq-10
  Vec3 ideal_offset(const Vec3& shank, const Vec3& n) const;

  /// Joint angles whose ideal foothold is `p_HI` (m, hip axes); `n_B` is the ground normal in trunk
  /// axes. Fixed point of [Zhu21] Eq. (12), corrected: docs/equations.md#eq-12
  IdealFootholdIk ideal_foothold_ik(const LegGeometry& leg, const Vec3& p_HI,
                                    const Vec3& n_B) const;

  /// Travel (m) of the contact over a stance (E8), heading axes at mid-stance. A foothold moved
  /// back by half of it has its mean contact at the nominal point.
  Vec3 stance_travel(const LegGeometry& leg, const StanceMotion& motion) const;

 private:
  double radius_ = 0.0;
};

/// The feet of `legs`.
inline PerLeg<RollingFoot> rolling_feet(FootModel model, const PerLeg<LegGeometry>& legs) {
  PerLeg<RollingFoot> feet;
  for (const Leg leg : kLegs) feet[leg] = RollingFoot(model, legs[leg].foot_radius);
  return feet;
}

}  // namespace pirouette
