#include "pirouette/estimation/leg_odometry_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "pirouette/base/rotation.hpp"
#include "pirouette/foot/rolling_foot.hpp"
#include "support/dense_odometry_filter.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::paper_leg;

constexpr double kTick = 0.002;
constexpr double kHeight = 0.29;  ///< m, hips above the ground

PerLeg<Vec3> feet_below_hips(double radius) {
  PerLeg<Vec3> p_WF;
  for (const Leg leg : kLegs) {
    p_WF[leg] = {0.19 * fore_sign(leg), 0.111 * side_sign(leg), radius - kHeight};
  }
  return p_WF;
}

/// One leg of a trot of period 0.5 s and duty 0.5, as its filter sees it.
struct TrotPhase {
  static constexpr double kPeriod = 0.5, kDuty = 0.5;

  double cycle;  ///< in [0, 1)

  TrotPhase(Leg leg, double time) {
    const bool first_pair = leg == Leg::kFR || leg == Leg::kRL;
    const double strides = time / kPeriod + (first_pair ? 0.0 : 0.5) + 1e-9;
    cycle = strides - std::floor(strides);
  }
  bool stance() const { return cycle < kDuty; }
  double trust(double window) const {
    const double progress = cycle / kDuty;
    return stance() ? std::clamp(std::min(progress, 1.0 - progress) / window, 0.0, 1.0) : 0.0;
  }
};

class RandomInputs {
 public:
  OdometryInput next() {
    OdometryInput in;
    in.a_WB_W = vec3(3.0);
    for (FootOdometry& foot : in.foot) {
      foot.p_BF_W = vec3(0.3);
      foot.v_BF_W = vec3(0.5);
      foot.v_WF_stance_W = vec3(0.02);
      foot.trust = std::clamp(uniform(1.5), 0.0, 1.0);  // a half of the feet in the air
      foot.centre_height = uniform(0.05);
      foot.use_height = uniform(1.0) > 0.0;
    }
    return in;
  }

 private:
  double uniform(double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(generator_);
  }
  Vec3 vec3(double limit) {
    const double x = uniform(limit), y = uniform(limit), z = uniform(limit);
    return {x, y, z};
  }
  std::mt19937 generator_{23};
};

TEST(LegOdometryFilter, IsTheFullKalmanFilterOf18StatesAnd28Measurements) {
  for (const double scale : {1.0, 1e3}) {  // noise of this project, and about that of [Bledt18]
    EstimationConfig config;
    config.velocity_jump = 100.0;  // m/s; beyond any input here, so that the filter is linear
    config.process_velocity *= scale;
    config.process_foot *= scale;
    config.measurement_position *= scale;
    config.measurement_velocity *= scale;
    config.measurement_height *= scale;
    LegOdometryFilter filter(config);
    test::DenseOdometryFilter dense(config);
    const Vec3 p_WB(0.4, -0.3, 0.28);
    filter.reset(p_WB, feet_below_hips(0.0225));
    dense.reset(p_WB, feet_below_hips(0.0225));
    RandomInputs inputs;
    for (int i = 0; i < 2000; ++i) {
      const OdometryInput in = inputs.next();
      const OdometryEstimate expected = dense.update(in, kTick), given = filter.update(in, kTick);
      ASSERT_LT(distance(given.p_WB, expected.p_WB), 1e-9) << i;
      ASSERT_LT(distance(given.v_WB_W, expected.v_WB_W), 1e-9) << i;
      for (const Leg leg : kLegs) {
        ASSERT_LT(distance(given.p_WF[leg], expected.p_WF[leg]), 1e-9) << i;
      }
    }
  }
}

/// The filter's velocity after 20 ms of standing and 4 ms in which feet say that the trunk moves
/// with `v_by_foot` (m/s, along x).
double velocity_after(const PerLeg<double>& v_by_foot, const PerLeg<double>& trust) {
  LegOdometryFilter filter{EstimationConfig{}};
  filter.reset(Vec3(0.0, 0.0, kHeight), feet_below_hips(0.0225));
  double v = 0.0;
  for (int tick = 0; tick < 12; ++tick) {
    OdometryInput in;
    for (const Leg leg : kLegs) {
      in.foot[leg].p_BF_W = feet_below_hips(0.0225)[leg];
      in.foot[leg].v_BF_W.x() = tick < 10 ? 0.0 : -v_by_foot[leg];
      in.foot[leg].trust = trust[leg];
    }
    v = filter.update(in, kTick).v_WB_W.x();
  }
  return v;
}

TEST(VelocityJump, IsFollowedAtOnceWhenAllFirmFeetAgree) {
  const auto all = PerLeg<double>::filled(1.0);
  const PerLeg<double> two = {{1.0, 0.0, 0.5, 1.0}};
  // A tenth less: the feet's positions, which stand still here, speak against it.
  const double jump = 0.3;
  EXPECT_NEAR(velocity_after(PerLeg<double>::filled(jump), all), jump, 0.1 * jump);
  EXPECT_NEAR(velocity_after({{jump, 9.0, jump, jump}}, two), jump, 0.1 * jump);
}

TEST(VelocityJump, IsNotOneFootsSlipNorOnesWordAloneNorNoise) {
  const auto all = PerLeg<double>::filled(1.0);
  EXPECT_LT(velocity_after({{0.5, 0.0, 0.0, 0.0}}, all), 0.05);
  EXPECT_LT(velocity_after(PerLeg<double>::filled(0.3), {{1.0, 0.0, 0.0, 0.5}}), 0.1);
  EXPECT_LT(velocity_after(PerLeg<double>::filled(0.09), all), 0.03);
}

void expect_positive_semidefinite(const Eigen::MatrixXd& P, int tick) {
  ASSERT_TRUE(P.allFinite()) << tick;
  ASSERT_LT(distance(P, P.transpose()), 1e-18) << tick;
  // Rounding of the largest entry is all that may be missing to zero.
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(P).eigenvalues().minCoeff();
  ASSERT_GT(least, -1e-15 * P.cwiseAbs().maxCoeff() - 1e-18) << tick;
}

TEST(LegOdometryFilter, CovarianceStaysPositiveSemidefiniteThroughAHundredThousandTicks) {
  const EstimationConfig config;
  LegOdometryFilter filter(config);
  filter.reset(Vec3(0.0, 0.0, kHeight), feet_below_hips(0.0225));
  for (int tick = 0; tick < 100000; ++tick) {
    OdometryInput in;
    for (const Leg leg : kLegs) {
      in.foot[leg].p_BF_W = feet_below_hips(0.0225)[leg];
      in.foot[leg].trust = TrotPhase(leg, tick * kTick).trust(config.trust_window);
      in.foot[leg].use_height = true;
    }
    filter.update(in, kTick);
    if (tick % 97 != 0) continue;
    expect_positive_semidefinite(filter.horizontal_covariance(), tick);
    expect_positive_semidefinite(filter.vertical_covariance(), tick);
  }
}

TEST(LegOdometryFilter, CovarianceStaysPositiveSemidefiniteAndBoundedWhileCarried) {
  LegOdometryFilter filter{EstimationConfig{}};
  for (int tick = 0; tick < 200000; ++tick) {  // 400 s
    filter.update(OdometryInput{}, kTick);
    if (tick % 97 == 0) expect_positive_semidefinite(filter.horizontal_covariance(), tick);
  }
  EXPECT_LE(filter.horizontal_covariance()(0, 0), 1.0);
}

TEST(LegOdometryFilter, StandingStillStaysWhereItIs) {
  LegOdometryFilter filter{EstimationConfig{}};
  const Vec3 p_WB(0.1, 0.2, kHeight);
  PerLeg<Vec3> p_WF = feet_below_hips(0.0225);
  OdometryInput in;
  for (const Leg leg : kLegs) {
    in.foot[leg].p_BF_W = p_WF[leg];
    in.foot[leg].trust = 1.0;
    p_WF[leg] += p_WB;
  }
  filter.reset(p_WB, p_WF);
  OdometryEstimate out;
  for (int i = 0; i < 5000; ++i) out = filter.update(in, kTick);
  EXPECT_LT(distance(out.p_WB, p_WB), 1e-12);
  EXPECT_LT(out.v_WB_W.norm(), 1e-12);
}

/// A trunk that spins in place at constant height over feet that trot and roll without slip
/// (equations.md section 9); the feet's centre may be off the centre of rotation.
class IdealSpin {
 public:
  IdealSpin(bool filter_rolls, const Vec2& offset) : filter_rolls_(filter_rolls), offset_(offset) {
    for (const Leg leg : kLegs) p_WF_[leg] = touchdown(leg, 0.0);
    filter_.reset(Vec3(0.0, 0.0, kHeight), p_WF_);
  }

  struct Error {
    double velocity_rms;  ///< m/s
    double position;      ///< m, largest horizontal
  };

  /// Errors of the second of two turns.
  Error run() {
    const int turn = static_cast<int>(2.0 * kPi / kRate / kTick);
    double sum = 0.0, largest = 0.0;
    for (int i = 0; i < 2 * turn; ++i) {
      const OdometryEstimate out = filter_.update(advance(i * kTick), kTick);
      if (i < turn) continue;
      sum += out.v_WB_W.head<2>().squaredNorm();  // the trunk does not move
      largest = std::max(largest, out.p_WB.head<2>().norm());
    }
    return {std::sqrt(sum / turn), largest};
  }

 private:
  static constexpr double kRate = 0.7;  // rad/s
  static constexpr double kRadius = 0.0225;

  Vec3 touchdown(Leg leg, double time) const {
    const double mid_stance = time + 0.5 * TrotPhase::kDuty * TrotPhase::kPeriod;
    Vec3 p_WF = feet_below_hips(kRadius)[leg] + Vec3(offset_.x(), offset_.y(), kHeight);
    return rot_z(kRate * mid_stance) * p_WF;
  }

  struct Motion {
    FootState foot;
    Vec3 v_WF_W;
  };

  /// Leg motion that keeps the contact's material point still: J_C nu = 0.
  Motion rolling_leg(Leg leg, const Vec3& p_WF, double time) const {
    const LegGeometry geometry = paper_leg(leg);
    const Mat3 R_WB = rot_z(kRate * time);
    const Vec3 p_BF = R_WB.transpose() * (p_WF - Vec3(0.0, 0.0, kHeight));
    const Vec3 q = inverse_kinematics(geometry, p_BF - geometry.p_BH).q;
    const Vec3 w_WB_B(0.0, 0.0, kRate);
    const Vec3 v_contact = w_WB_B.cross(p_BF - kRadius * Vec3::UnitZ());
    const Vec3 dq = -foot_.contact_jacobian(geometry, q, Vec3::UnitZ()).inverse() * v_contact;
    const FootState foot = foot_state(geometry, q, dq);
    return {foot, foot_.rolling_velocity(R_WB * (w_WB_B + foot.w_BS_B), Vec3::UnitZ())};
  }

  OdometryInput advance(double time) {
    OdometryInput in;
    const Mat3 R_WB = rot_z(kRate * time);
    for (const Leg leg : kLegs) {
      const TrotPhase phase(leg, time);
      if (!phase.stance()) {
        p_WF_[leg] = touchdown(leg, time + (1.0 - phase.cycle) * TrotPhase::kPeriod);
        in.foot[leg].p_BF_W = p_WF_[leg] - Vec3(0.0, 0.0, kHeight);
        continue;
      }
      const Motion motion = rolling_leg(leg, p_WF_[leg], time);
      FootOdometry& out = in.foot[leg];
      out.p_BF_W = R_WB * motion.foot.p_BF;
      out.v_BF_W = R_WB * (Vec3(0.0, 0.0, kRate).cross(motion.foot.p_BF) + motion.foot.v_BF_B);
      if (filter_rolls_) out.v_WF_stance_W = motion.v_WF_W;
      out.trust = phase.trust(config_.trust_window);
      out.centre_height = kRadius;
      out.use_height = true;
      const Vec3 midway = p_WF_[leg] + 0.5 * kTick * motion.v_WF_W;
      p_WF_[leg] += kTick * rolling_leg(leg, midway, time + 0.5 * kTick).v_WF_W;
    }
    return in;
  }

  bool filter_rolls_;
  Vec2 offset_;
  EstimationConfig config_;
  RollingFoot foot_{FootModel::kRolling, kRadius};
  LegOdometryFilter filter_{config_};
  PerLeg<Vec3> p_WF_{};
};

TEST(LegOdometryFilter, RollingTermsRemoveTheErrorsOfAnIdealSpin) {
  const IdealSpin::Error with = IdealSpin(true, Vec2::Zero()).run();
  const IdealSpin::Error without = IdealSpin(false, Vec2::Zero()).run();
  // Measured 0.0045 mm/s, of the order of the tick squared, against 1.69 mm/s.
  EXPECT_LT(with.velocity_rms, 1e-5);
  EXPECT_GT(without.velocity_rms, 1e-3);
  EXPECT_LT(with.position, 5e-5);
  EXPECT_GT(without.position, 3e-4);
}

TEST(LegOdometryFilter, RollingTermsRemoveTheBiasOfFeetOffTheCentreOfRotation) {
  const Vec2 offset(0.02, 0.0);
  const IdealSpin::Error with = IdealSpin(true, offset).run();
  const IdealSpin::Error without = IdealSpin(false, offset).run();
  EXPECT_LT(with.velocity_rms, 1e-5);
  // The bias of a foot offset d, (r / H) w d = 1.09 mm/s, draws a circle of radius (r / H) d.
  EXPECT_GT(without.velocity_rms, 1.09e-3);
  EXPECT_GT(without.position, 1.55e-3);
  EXPECT_LT(with.position, 5e-5);
}

/// Height error after 3 s of a point-footed trot straight up a slope of 15 degrees.
double height_error_uphill(bool feet_on_flat_world) {
  const EstimationConfig config;
  LegOdometryFilter filter(config);
  const Vec3 v_WB_W = 0.3 * Vec3(std::cos(radians(15.0)), 0.0, std::sin(radians(15.0)));
  const double stance = TrotPhase::kDuty * TrotPhase::kPeriod;
  Vec3 p_WB(0.0, 0.0, kHeight);
  const PerLeg<Vec3> nominal = feet_below_hips(0.0);
  PerLeg<Vec3> p_WF;
  for (const Leg leg : kLegs) p_WF[leg] = p_WB + nominal[leg];
  filter.reset(p_WB, p_WF);
  OdometryEstimate out;
  for (double time = 0.0; time < 3.0; time += kTick) {
    OdometryInput in;
    for (const Leg leg : kLegs) {
      const TrotPhase phase(leg, time);
      if (!phase.stance()) p_WF[leg] = p_WB + nominal[leg] + 0.5 * stance * v_WB_W;
      FootOdometry& foot = in.foot[leg];
      foot.p_BF_W = p_WF[leg] - p_WB;
      foot.v_BF_W = -v_WB_W;
      foot.trust = phase.trust(config.trust_window);
      foot.use_height = feet_on_flat_world;
    }
    out = filter.update(in, kTick);
    p_WB += kTick * v_WB_W;
  }
  return std::abs(out.p_WB.z() - p_WB.z());
}

TEST(LegOdometryFilter, ClimbsASlopeOnlyWithoutRowsThatSayTheWorldIsFlat) {
  EXPECT_LT(height_error_uphill(false), 2e-3);
  EXPECT_GT(height_error_uphill(true), 0.1);  // of the 0.23 m climbed
}

}  // namespace
}  // namespace pirouette
