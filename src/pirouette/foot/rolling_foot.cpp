#include "pirouette/foot/rolling_foot.hpp"

#include "pirouette/base/planar_twist.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {

Mat3 RollingFoot::contact_jacobian(const LegGeometry& leg, const Vec3& q, const Vec3& n_B) const {
  return foot_jacobian(leg, q) + radius_ * skew(n_B) * shank_jacobian(q);
}

Vec3 RollingFoot::odometry_velocity(const FootState& foot, const Mat3& R_WB, const Vec3& w_WB_W,
                                    const Vec3& n_W) const {
  const Vec3 v_foot_W = w_WB_W.cross(R_WB * foot.p_BF) + R_WB * foot.v_BF_B;
  return rolling_velocity(w_WB_W + R_WB * foot.w_BS_B, n_W) - v_foot_W;
}

Vec3 RollingFoot::displacement(const Mat3& R_WS_0, const Mat3& R_WS_1, const Vec3& n_W) const {
  return radius_ * log_so3(R_WS_1 * R_WS_0.transpose()).cross(n_W);
}

Vec3 RollingFoot::level_displacement(const Vec3& q_0, const Vec3& q_1, double yaw) const {
  const Vec3 dq = q_1 - q_0;
  const double abad_mid = 0.5 * (q_0[0] + q_1[0]);
  return radius_ * (rot_z(yaw) * Vec3(std::cos(abad_mid) * (dq[1] + dq[2]), -dq[0], 0.0));
}

Vec3 RollingFoot::ideal_offset(const Vec3& shank, const Vec3& n) const {
  constexpr double kUpright = 1e-4;  // below it the quotient is 0/0
  const double down = -shank.dot(n);
  const Vec3 sideways = shank + down * n;
  const double s = sideways.norm();
  // A shank that points straight up has no direction to roll in; its offset is taken as zero.
  const double k =
      s >= kUpright ? std::atan2(s, down) / s : (down > 0.0 ? 1.0 + square(s) / 6.0 : 0.0);
  return radius_ * k * sideways;
}

IdealFootholdIk RollingFoot::ideal_foothold_ik(const LegGeometry& leg, const Vec3& p_HI,
                                               const Vec3& n_B) const {
  constexpr int kMaxIterations = 20;    // the worst case contracts by 0.2 a step
  constexpr double kTolerance = 1e-10;  // rad
  constexpr double kMaxTilt = 1.4;      // rad
  IdealFootholdIk out;
  const Vec3 upright_centre = p_HI + radius_ * n_B;
  out.ik = inverse_kinematics(leg, upright_centre);
  while (!out.converged && out.iterations < kMaxIterations) {
    const Vec3 shank = -shank_rotation(out.ik.q).col(2);
    const IkSolution next = inverse_kinematics(leg, upright_centre - ideal_offset(shank, n_B));
    out.converged = (next.q - out.ik.q).norm() < kTolerance;
    out.ik = next;
    ++out.iterations;
  }
  out.tilted = shank_rotation(out.ik.q).col(2).dot(n_B) < std::cos(kMaxTilt);
  return out;
}

Vec3 RollingFoot::stance_travel(const LegGeometry& leg, const StanceMotion& motion) const {
  if (radius_ == 0.0) return Vec3::Zero();
  const Vec3 p_GF_H = motion.R_HB * (motion.p_BF - motion.p_BG);

  // Shank orientation, in the heading axes of mid-stance, `t` from mid-stance with the centre moved
  // by `moved` from where it was then.
  const auto shank_at = [&](double t, const Vec3& moved) -> Mat3 {
    const Vec2 xy = planar_twist_displacement(motion.twist.v_H, motion.twist.yaw_rate, t);
    const Vec3 body_moved(xy.x(), xy.y(), -xy.dot(motion.n_H.head<2>()) / motion.n_H.z());
    const Mat3 R_HB_t = exp_so3(motion.n_H * (motion.twist.yaw_rate * t)) * motion.R_HB;
    const Vec3 p_BF = R_HB_t.transpose() * (p_GF_H + moved - body_moved) + motion.p_BG;
    return R_HB_t * shank_rotation(inverse_kinematics(leg, p_BF - leg.p_BH).q);
  };

  constexpr int kPasses = 2;  // the travel changes the leg's angles by about r / leg length
  const double half = 0.5 * motion.duration;
  Vec3 travel = Vec3::Zero();
  for (int i = 0; i < kPasses; ++i) {
    travel = displacement(shank_at(-half, -0.5 * travel), shank_at(half, 0.5 * travel), motion.n_H);
  }
  return travel;
}

}  // namespace pirouette
