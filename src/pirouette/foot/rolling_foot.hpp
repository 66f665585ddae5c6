// The foot as a sphere that rolls on the ground: the one foot policy of estimator, planner and
// dynamics.
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
  IkSolution ik;
  int iterations = 0;
  bool converged = false;
  bool tilted = false;  ///< the shank leans so far that it would touch the ground before the sphere

  bool valid() const { return converged && !tilted && ik.reachable(); }
};

/// A stance foreseen: the trunk follows a planar twist of its CoM and turns about the ground
/// normal.
struct StanceMotion {
  Vec3 p_BF = Vec3::Zero();      ///< m, sphere centre at mid-stance, trunk axes
  Vec3 p_BG = Vec3::Zero();      ///< m, CoM in trunk axes
  Mat3 R_HB = Mat3::Identity();  ///< trunk in heading axes at mid-stance: its tilt
  Vec3 n_H = Vec3::UnitZ();      ///< ground normal, heading axes
  TwistCommand twist{};
  double duration = 0.0;  ///< s
};

/// A sphere of radius r that rolls without slip. FootModel::kCentre is the sphere of radius 0: its
/// contact point is the sphere's centre and every rolling term vanishes.
/// `n_W` is the unit normal of the ground; w_WS the angular velocity of the shank S in the world.
class RollingFoot {
 public:
  RollingFoot(FootModel model, double radius)
      : radius_(model == FootModel::kRolling ? radius : 0.0) {}

  /// m, of the sphere that rolls: 0 for the centre model.
  double radius() const { return radius_; }

  /// m, sphere centre above the contact along the normal; feeds the foothold planner.
  double centre_offset() const { return radius_; }
  Vec3 contact_point(const Vec3& p_WF, const Vec3& n_W) const { return p_WF - radius_ * n_W; }
  Vec3 centre_from_contact(const Vec3& p_WC, const Vec3& n_W) const { return p_WC + radius_ * n_W; }

  /// m/s, velocity of the sphere centre, and of the contact point, when rolling without slip (E6).
  Vec3 rolling_velocity(const Vec3& w_WS_W, const Vec3& n_W) const {
    return radius_ * w_WS_W.cross(n_W);
  }

  /// m/rad, leg columns of the contact Jacobian in trunk axes, J_v + r [n_B]x J_w (E13): velocity
  /// of the material point at the contact relative to the trunk.
  Mat3 contact_jacobian(const LegGeometry& leg, const Vec3& q, const Vec3& n_B) const;

  /// m/s, world axes: velocity of the trunk's origin that this foot reports when it rolls (E12).
  Vec3 odometry_velocity(const FootState& foot, const Mat3& R_WB, const Vec3& w_WB_W,
                         const Vec3& n_W) const;

  /// m, travel of the contact while the shank turns from R_WS_0 to R_WS_1 about one axis (E8).
  Vec3 displacement(const Mat3& R_WS_0, const Mat3& R_WS_1, const Vec3& n_W) const;

  /// m, travel of the contact of a level trunk between two postures of the leg, world axes; `yaw`
  /// at the middle of the motion (E9).
  Vec3 level_displacement(const Vec3& q_0, const Vec3& q_1, double yaw) const;

  /// m, from the contact to the ideal foothold: the point that the sphere's tip touches when the
  /// shank rolls upright. `shank` is the unit vector from knee to foot.
  /// [Zhu21] Eq. (10), corrected (E10): docs/equations.md#eq-10
  Vec3 ideal_offset(const Vec3& shank, const Vec3& n) const;

  /// Joint angles whose ideal foothold is `p_HI` (m, hip axes); `n_B` is the ground normal in trunk
  /// axes. Fixed point of [Zhu21] Eq. (12), corrected: docs/equations.md#eq-12
  IdealFootholdIk ideal_foothold_ik(const LegGeometry& leg, const Vec3& p_HI,
                                    const Vec3& n_B) const;

  /// m, travel of the contact over a stance (E8), heading axes at mid-stance. Half of it, taken off
  /// the foothold, puts the mean contact on its nominal point.
  Vec3 stance_travel(const LegGeometry& leg, const StanceMotion& motion) const;

 private:
  double radius_;
};

}  // namespace pirouette
