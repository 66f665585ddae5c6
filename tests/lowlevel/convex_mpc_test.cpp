#include "pirouette/lowlevel/convex_mpc.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>
#include <random>

#include "pirouette/lowlevel/friction_pyramid.hpp"
#include "pirouette/lowlevel/qp_solver.hpp"
#include "support/single_rigid_body.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::discretised;
using test::distance;
using test::exact_rate_map;
using test::srb_dynamics;
using test::SrbDynamics;
using test::SrbState;

constexpr double kMass = 9.0;
const Mat3 kInertia = Vec3(0.07, 0.26, 0.242).asDiagonal();
constexpr double kHeight = 0.27;

MpcConfig config_with_horizon(int horizon) {
  MpcConfig config;
  config.horizon = horizon;
  return config;
}

Mat3 inertia_W(const RollPitchYaw& rpy) {
  const Mat3 R_WB = rotation_from_rpy(rpy);
  return R_WB * kInertia * R_WB.transpose();
}

SrbState stacked(const BodyMotion& m) {
  SrbState x;
  x << m.rpy, m.p_WG, m.w_WB_W, m.v_WG_W, -kGravity;
  return x;
}

Vec3 total(const ContactForces& forces) {
  return std::accumulate(forces.f_W.begin(), forces.f_W.end(), Vec3(Vec3::Zero()));
}

/// Standing still at the reference with the feet below the hips, for the whole horizon.
MpcInput standing() {
  MpcInput in;
  in.now.p_WG.z() = kHeight;
  for (MpcStep& step : in.steps) {
    step.reference = in.now;
    step.p_WG_mid = in.now.p_WG;
    step.stance = PerLeg<bool>::filled(true);
    for (const Leg leg : kLegs)
      step.p_WC[leg] = {0.19 * fore_sign(leg), 0.111 * side_sign(leg), 0.0};
  }
  return in;
}

/// Standing with an error in every state, so that every force has something to do.
MpcInput disturbed() {
  MpcInput in = standing();
  in.now.rpy = {0.03, -0.02, 0.05};
  in.now.p_WG += Vec3(0.01, -0.02, 0.004);
  in.now.w_WB_W = {0.1, -0.2, 0.15};
  in.now.v_WG_W = {0.05, 0.08, -0.06};
  return in;
}

/// The world seen in a mirror whose plane is world xz: left and right legs change places.
MpcInput mirrored(MpcInput in) {
  const Vec3 polar(1.0, -1.0, 1.0), axial(-1.0, 1.0, -1.0);
  const auto mirror = [&](BodyMotion& m) {
    m.rpy = axial.cwiseProduct(m.rpy);
    m.p_WG = polar.cwiseProduct(m.p_WG);
    m.w_WB_W = axial.cwiseProduct(m.w_WB_W);
    m.v_WG_W = polar.cwiseProduct(m.v_WG_W);
  };
  mirror(in.now);
  for (MpcStep& step : in.steps) {
    mirror(step.reference);
    step.rpy_mid = {-step.rpy_mid.roll, step.rpy_mid.pitch, -step.rpy_mid.yaw};
    step.p_WG_mid = polar.cwiseProduct(step.p_WG_mid);
    std::swap(step.p_WC[Leg::kFR], step.p_WC[Leg::kFL]);
    std::swap(step.p_WC[Leg::kRR], step.p_WC[Leg::kRL]);
    for (Vec3& p_WC : step.p_WC) p_WC = polar.cwiseProduct(p_WC);
  }
  return in;
}

/// The whole world turned by `yaw` about the z axis.
MpcInput turned(MpcInput in, double yaw) {
  const Mat3 R = rot_z(yaw);
  const auto turn = [&](BodyMotion& m) {
    m.rpy.z() += yaw;
    m.p_WG = R * m.p_WG;
    m.w_WB_W = R * m.w_WB_W;
    m.v_WG_W = R * m.v_WG_W;
  };
  turn(in.now);
  for (MpcStep& step : in.steps) {
    turn(step.reference);
    step.rpy_mid.yaw += yaw;
    step.p_WG_mid = R * step.p_WG_mid;
    for (Vec3& p_WC : step.p_WC) p_WC = R * p_WC;
  }
  return in;
}

/// A body that turns, tilts and steps at random; each foot stands in `stance_share` of the steps.
MpcInput random_input(std::mt19937& generator, double stance_share) {
  const auto uniform = [&](double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(generator);
  };
  const auto vec3 = [&](double limit) {
    const double x = uniform(limit), y = uniform(limit), z = uniform(limit);
    return Vec3(x, y, z);
  };
  const auto motion = [&] { return BodyMotion{vec3(0.6), vec3(0.5), vec3(2.0), vec3(1.0)}; };
  MpcInput in;
  in.dt = 0.03 + uniform(0.01);
  in.n_W = (Vec3::UnitZ() + vec3(0.3)).normalized();
  in.now = motion();
  for (MpcStep& step : in.steps) {
    step.reference = motion();
    step.rpy_mid = {uniform(0.5), uniform(0.5), uniform(3.0)};
    step.p_WG_mid = vec3(0.3);
    for (const Leg leg : kLegs) {
      step.stance[leg] = uniform(0.5) + 0.5 < stance_share;
      step.p_WC[leg] = vec3(0.5);
    }
  }
  in.steps[0].stance[Leg::kRL] = true;
  return in;
}

/// min 1/2 U'HU + g'U by stacking powers of the discrete dynamics (equations.md section 8).
struct NaiveCondensing {
  MatrixXd H;
  VectorXd g;

  NaiveCondensing(const MpcConfig& config, const MpcInput& in) {
    std::vector<SrbDynamics> steps;
    int inputs = 0;
    for (int k = 0; k < config.horizon; ++k) {
      const MpcStep& step = in.steps[static_cast<std::size_t>(k)];
      std::vector<Vec3> arms;
      for (const Leg leg : kLegs) {
        if (step.stance[leg]) arms.push_back(step.p_WC[leg] - step.p_WG_mid);
      }
      if (inputs + 3 * static_cast<int>(arms.size()) > 3 * kMaxForces) break;
      steps.push_back(discretised(
          srb_dynamics(kMass, inertia_W(step.rpy_mid), exact_rate_map(step.rpy_mid), arms), in.dt));
      inputs += 3 * static_cast<int>(arms.size());
    }
    SrbState weight;
    weight << Eigen::Map<const Vec3>(config.weight_rpy.data()),
        Eigen::Map<const Vec3>(config.weight_position.data()),
        Eigen::Map<const Vec3>(config.weight_angular_velocity.data()),
        Eigen::Map<const Vec3>(config.weight_velocity.data()), 0.0;

    H = 2.0 * config.weight_force * MatrixXd::Identity(inputs, inputs);
    g = VectorXd::Zero(inputs);
    SrbState free = stacked(in.now);                               // state without any force
    MatrixXd response = MatrixXd::Zero(test::kSrbStates, inputs);  // d(state)/dU
    int first = 0;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const SrbDynamics& d = steps[k];
      free = (d.A * free).eval();
      response = (d.A * response).eval();
      response.middleCols(first, d.B.cols()) += d.B;
      first += static_cast<int>(d.B.cols());
      const SrbState error = free - stacked(in.steps[k].reference);
      H += 2.0 * response.transpose() * weight.asDiagonal() * response;
      g += 2.0 * response.transpose() * weight.cwiseProduct(error);
    }
  }
};

TEST(SingleRigidBody, DiscretisationMatchesScipysMatrixExponential) {
  const auto& section = test::vectors("srb_discretisation");
  for (const auto& c : section.at("cases")) {
    const Vec3 ypr = test::to_vec3(c.at("yaw_pitch_roll"));
    const RollPitchYaw rpy = {ypr[2], ypr[1], ypr[0]};
    const bool exact = c.at("euler_map") == "exact";
    const double tol = exact ? 1e-8 : section.at("tol").get<double>();  // "tol_note" of the vectors
    const Mat3 R_WB = test::to_mat3(c.at("R_body"));
    EXPECT_LT(distance(rotation_from_rpy(rpy), R_WB), 1e-12);
    const Mat3 I_W = R_WB * test::to_vec3(c.at("I_body")).asDiagonal() * R_WB.transpose();
    std::vector<Vec3> arms;
    for (const auto& arm : c.at("r_contacts_world")) arms.push_back(test::to_vec3(arm));
    const SrbDynamics continuous = srb_dynamics(
        c.at("mass"), I_W, exact ? exact_rate_map(rpy) : test::small_angle_rate_map(rpy), arms);
    const SrbDynamics discrete = discretised(continuous, c.at("dt"));
    const auto expect_equal = [&](const MatrixXd& given, const char* key) {
      for (Eigen::Index row = 0; row < given.rows(); ++row) {
        for (Eigen::Index column = 0; column < given.cols(); ++column) {
          EXPECT_NEAR(given(row, column), c.at(key).at(row).at(column).get<double>(), tol) << key;
        }
      }
    };
    expect_equal(continuous.A, "A");
    expect_equal(continuous.B, "B");
    expect_equal(discrete.A, "Ad");
    expect_equal(discrete.B, "Bd");
  }
}

/// The whole plan by a dense QP of all forces.
VectorXd dense_plan(const MpcConfig& config, const MpcInput& in, SolveStatus& status) {
  const NaiveCondensing naive(config, in);
  const auto forces = static_cast<int>(naive.g.size()) / 3;
  QpSolver solver(3, kPyramidRows, forces, config.max_iterations);
  QpSolver::Problem& problem = solver.prepare(forces);
  problem.H = naive.H;
  problem.g = naive.g;
  const FrictionPyramid pyramid(in.n_W, config.friction, config.min_normal_force,
                                config.max_normal_force);
  for (int i = 0; i < forces; ++i) {
    problem.C.block<kPyramidRows, 3>(kPyramidRows * i, 3 * i) = pyramid.C;
    problem.lower.segment<kPyramidRows>(kPyramidRows * i) = pyramid.lower;
  }
  status = solver.solve().status;
  return problem.x;
}

/// The input's errors of state and reference scaled, so that the forces stay near the weight's.
MpcInput calmed(MpcInput in, double share) {
  for (MpcStep& step : in.steps) {
    BodyMotion& m = step.reference;
    m.rpy = in.now.rpy + share * (m.rpy - in.now.rpy);
    m.p_WG = in.now.p_WG + share * (m.p_WG - in.now.p_WG);
    m.w_WB_W *= share;
    m.v_WG_W *= share;
  }
  in.now.w_WB_W *= share;
  in.now.v_WG_W *= share;
  return in;
}

class Horizon : public testing::TestWithParam<int> {};

TEST_P(Horizon, PlansWhatADenseQpOfAllForcesGives) {
  MpcConfig config = config_with_horizon(GetParam());
  config.max_iterations = 1000;
  ConvexMpc mpc(config, kMass, kInertia);
  std::mt19937 generator(11);
  int constrained = 0;
  for (int i = 0; i < 24; ++i) {
    // 0.9: more forces than kMaxForces in 16 steps.
    const MpcInput in = calmed(random_input(generator, i % 2 ? 0.35 : 0.9), i < 12 ? 0.02 : 1.0);
    SolveStatus status;
    const VectorXd expected = dense_plan(config, in, status);
    ASSERT_NE(status, SolveStatus::kFailed);
    EXPECT_EQ(mpc.update(in).status, status);
    constrained += status == SolveStatus::kConstrained;
    ASSERT_EQ(3 * mpc.plan().size(), static_cast<std::size_t>(expected.size()));
    const VectorXd plan = Eigen::Map<const VectorXd>(mpc.plan()[0].data(), expected.size());
    // 1e-9 of the weight or the largest force: rounding times the Hessian's condition number, 10^5.
    const double scale = std::max(kMass * kGravity, expected.cwiseAbs().maxCoeff());
    EXPECT_LT(distance(plan, expected), 1e-9 * scale) << i;
  }
  EXPECT_GT(constrained, 10);
}

INSTANTIATE_TEST_SUITE_P(ConvexMpc, Horizon, testing::Values(1, 2, 3, 10, 16, 24));

TEST(ConvexMpc, EndsItsPredictionBeforeItHasMoreForcesThanTheSolverTakes) {
  ConvexMpc mpc(config_with_horizon(kMaxHorizon), kMass, kInertia);
  mpc.update(standing());
  EXPECT_EQ(mpc.plan().size(), 40U);  // 10 steps of 4 feet; 11 would be 44 > kMaxForces
}

class StandingMpc : public testing::Test {
 protected:
  ContactForces solve(const MpcInput& in) { return mpc_.update(in); }

  MpcConfig config_;
  ConvexMpc mpc_{config_, kMass, kInertia};
};

TEST_F(StandingMpc, CarriesTheWeightEquallyOnAllFeet) {
  config_.weight_force = 1e-9;  // so that sparing force costs less height than rounding does
  ConvexMpc mpc(config_, kMass, kInertia);
  const ContactForces forces = mpc.update(standing());
  EXPECT_EQ(forces.status, SolveStatus::kUnconstrained);
  for (const Vec3& f_W : forces.f_W) {
    EXPECT_LT(distance(f_W, 0.25 * kMass * kGravity * Vec3::UnitZ()), 1e-3);
  }
}

TEST_F(StandingMpc, SparesLittleOfTheWeightAtTheDefaultWeights) {
  EXPECT_LT(distance(total(solve(standing())), kMass * kGravity * Vec3::UnitZ()),
            0.01 * kMass * kGravity);
}

TEST_F(StandingMpc, PushesBackTowardsTheReference) {
  MpcInput in = standing();
  in.now.p_WG.x() += 0.02;
  in.now.v_WG_W.y() -= 0.1;
  const Vec3 f_W = total(solve(in));
  EXPECT_LT(f_W.x(), -0.1);
  EXPECT_GT(f_W.y(), 0.1);

  in = standing();
  in.now.rpy.z() = -0.1;
  double moment = 0.0;
  const ContactForces forces = solve(in);
  for (const Leg leg : kLegs) moment += in.steps[0].p_WC[leg].cross(forces.f_W[leg]).z();
  EXPECT_GT(moment, 0.1);
}

TEST_F(StandingMpc, IsMirrorSymmetric) {
  const ContactForces forces = solve(disturbed());
  const ContactForces mirror = solve(mirrored(disturbed()));
  const Vec3 polar(1.0, -1.0, 1.0);
  // 1e-9 N: rounding times the condition number of H, about 10^5.
  const auto expect_mirrored = [&](Leg left, Leg right) {
    EXPECT_LT(distance(mirror.f_W[left], polar.cwiseProduct(forces.f_W[right])), 1e-9);
    EXPECT_LT(distance(mirror.f_W[right], polar.cwiseProduct(forces.f_W[left])), 1e-9);
  };
  expect_mirrored(Leg::kFL, Leg::kFR);
  expect_mirrored(Leg::kRL, Leg::kRR);
  EXPECT_GT(distance(forces.f_W[Leg::kFL], forces.f_W[Leg::kFR]), 0.1);  // the test has an effect
}

TEST_F(StandingMpc, TurnsWithTheWorld) {
  const ContactForces forces = solve(disturbed());
  ASSERT_EQ(forces.status, SolveStatus::kUnconstrained);  // the pyramid itself is not round
  const ContactForces after = solve(turned(disturbed(), 1.0));
  for (const Leg leg : kLegs) {
    EXPECT_LT(distance(after.f_W[leg], rot_z(1.0) * forces.f_W[leg]), 1e-9);
  }
}

/// Of one force, N; negative outside the friction pyramid.
double friction_reserve(const MpcConfig& config, const Vec3& n_W, const Vec3& f_W) {
  Vec3 t1, t2;
  ground_tangents(n_W, t1, t2);
  const double largest = std::max(std::abs(f_W.dot(t1)), std::abs(f_W.dot(t2)));
  return std::min({config.friction * f_W.dot(n_W) - largest, f_W.dot(n_W) - config.min_normal_force,
                   config.max_normal_force - f_W.dot(n_W)});
}

TEST_F(StandingMpc, KeepsEveryForceInThePyramidOfASlope) {
  MpcInput in = standing();
  in.n_W = rot_y(radians(-20.0)) * Vec3::UnitZ();
  for (MpcStep& step : in.steps) {
    for (Vec3& p_WC : step.p_WC) p_WC.z() = -in.n_W.x() / in.n_W.z() * p_WC.x();
  }
  for (const double speed : {0.0, 0.2, 0.5}) {
    in.now.v_WG_W = {-speed, speed, 0.0};  // downhill and sideways
    const ContactForces forces = solve(in);
    ASSERT_NE(forces.status, SolveStatus::kFailed);
    double least = 1e9;
    for (const Vec3& f_W : forces.f_W) {
      least = std::min(least, friction_reserve(config_, in.n_W, f_W));
    }
    EXPECT_GT(least, -1e-6);  // the solver's stated tolerance, N
    if (speed > 0.0) {
      EXPECT_EQ(forces.status, SolveStatus::kConstrained);
      EXPECT_LT(least, 1e-6);
    }
  }
}

TEST_F(StandingMpc, PutsNoForceOnLegsInTheAir) {
  MpcInput in = standing();
  for (MpcStep& step : in.steps) step.stance[Leg::kFL] = step.stance[Leg::kRR] = false;
  const ContactForces forces = solve(in);
  EXPECT_EQ(forces.f_W[Leg::kFL], Vec3::Zero());
  EXPECT_EQ(forces.f_W[Leg::kRR], Vec3::Zero());
  EXPECT_GT(forces.f_W[Leg::kFR].z(), 30.0);
  EXPECT_GT(forces.f_W[Leg::kRL].z(), 30.0);
}

TEST_F(StandingMpc, HasNoForcesToGiveWhenAllLegsStayInTheAir) {
  MpcInput in = standing();
  for (MpcStep& step : in.steps) step.stance = {};
  solve(disturbed());
  const ContactForces forces = solve(in);
  EXPECT_EQ(forces.status, SolveStatus::kUnconstrained);
  for (const Vec3& f_W : forces.f_W) EXPECT_EQ(f_W, Vec3::Zero());
}

TEST_F(StandingMpc, FailsWithZerosWhenNoForceIsAllowed) {
  config_.min_normal_force = 100.0;
  config_.max_normal_force = 50.0;
  ConvexMpc mpc(config_, kMass, kInertia);
  const ContactForces forces = mpc.update(disturbed());
  EXPECT_EQ(forces.status, SolveStatus::kFailed);
  for (const Vec3& f_W : forces.f_W) EXPECT_EQ(f_W, Vec3::Zero());
}

TEST_F(StandingMpc, FailsWithZerosAtTheIterationCap) {
  MpcInput in = disturbed();
  in.now.v_WG_W = {1.0, -0.8, 0.0};  // many forces at the edge of friction
  const ContactForces free = solve(in);
  ASSERT_EQ(free.status, SolveStatus::kConstrained);
  ASSERT_GT(free.iterations, 4);
  config_.max_iterations = 4;
  ConvexMpc capped(config_, kMass, kInertia);
  const ContactForces forces = capped.update(in);
  EXPECT_EQ(forces.status, SolveStatus::kFailed);
  EXPECT_LE(forces.iterations, 4);
  for (const Vec3& f_W : forces.f_W) EXPECT_EQ(f_W, Vec3::Zero());
}

TEST_F(StandingMpc, FailsWithZerosWhenAnInputIsNotFiniteAndRecovers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const int spoilt : {0, 1, 2, 3}) {
    MpcInput in = disturbed();
    if (spoilt == 0) in.now.rpy.x() = kNan;
    if (spoilt == 1) in.steps[3].p_WC[Leg::kFL].y() = kNan;
    if (spoilt == 2) in.steps[5].rpy_mid.yaw = kNan;
    if (spoilt == 3) in.n_W.z() = kNan;
    const ContactForces forces = solve(in);
    EXPECT_EQ(forces.status, SolveStatus::kFailed) << spoilt;
    for (const Vec3& f_W : forces.f_W) EXPECT_EQ(f_W, Vec3::Zero()) << spoilt;
    EXPECT_EQ(solve(disturbed()).status, SolveStatus::kUnconstrained) << spoilt;
  }
}

}  // namespace
}  // namespace pirouette
