#include "pirouette/lowlevel/force_recursion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace pirouette {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Mat12 = Eigen::Matrix<double, 12, 12>;

constexpr double kMass = 9.0;

class Draws {
 public:
  explicit Draws(unsigned seed) : generator_(seed) {}

  double uniform(double limit) {
    return std::uniform_real_distribution<double>(-limit, limit)(generator_);
  }
  bool coin(double share) { return uniform(0.5) + 0.5 < share; }

  /// Attitude rates, force effects and errors of the robot's size, and feet that stand in
  /// `stance_share` of the steps.
  void fill(ForceProblem& problem, int horizon, double stance_share) {
    problem.dt = 0.03 + uniform(0.01);
    problem.steps = 0;
    problem.forces = 0;
    for (int step = 0; step < horizon && problem.forces + 4 <= kMaxForces; ++step) {
      const auto k = static_cast<size_t>(problem.steps++);
      problem.T[k] = Mat3::Identity() + Mat3::NullaryExpr([&] { return uniform(0.5); });
      problem.free_error[k] = BodyDeviation::NullaryExpr([&] { return uniform(1.0); });
      for (const Leg leg : kLegs) {
        if (!coin(stance_share)) continue;
        PlannedForce& force = problem.force[static_cast<size_t>(problem.forces++)];
        force.step = step;
        force.leg = leg;
        force.W = Mat3::NullaryExpr([&] { return uniform(0.1); });
      }
    }
  }

 private:
  std::mt19937 generator_;
};

/// 1/2 f' H f + g' f of all forces at once, by stacking the steps' matrices.
struct Condensed {
  MatrixXd H;
  VectorXd g;

  Condensed(const MpcConfig& config, const ForceProblem& problem) {
    BodyDeviation weight;
    weight << Eigen::Map<const Vec3>(config.weight_rpy.data()),
        Eigen::Map<const Vec3>(config.weight_position.data()),
        Eigen::Map<const Vec3>(config.weight_angular_velocity.data()),
        Eigen::Map<const Vec3>(config.weight_velocity.data());
    const double h = problem.dt;
    const int n = 3 * problem.forces;
    H = config.weight_force * MatrixXd::Identity(n, n);
    g = VectorXd::Zero(n);
    MatrixXd response = MatrixXd::Zero(12, n);
    for (int step = 0, i = 0; step < problem.steps; ++step) {
      const auto k = static_cast<size_t>(step);
      Mat12 rate = Mat12::Zero();
      rate.block<3, 3>(0, 6) = problem.T[k];
      rate.block<3, 3>(3, 9).setIdentity();
      response = ((Mat12::Identity() + h * rate) * response).eval();
      for (; i < problem.forces && problem.force[static_cast<size_t>(i)].step == step; ++i) {
        MatrixXd push = MatrixXd::Zero(12, 3);  // change of the velocities
        push.middleRows<3>(6) = problem.force[static_cast<size_t>(i)].W;
        push.middleRows<3>(9) = h / kMass * Mat3::Identity();
        response.middleCols<3>(3 * i) = push + 0.5 * h * rate * push;
      }
      H += response.transpose() * weight.asDiagonal() * response;
      g += response.transpose() * weight.cwiseProduct(problem.free_error[k]);
    }
  }
};

VectorXd stacked(const std::array<Vec3, kMaxForces>& f_W, int forces) {
  VectorXd out(3 * forces);
  for (int i = 0; i < forces; ++i) out.segment<3>(3 * i) = f_W[static_cast<size_t>(i)];
  return out;
}

class Recursion : public testing::TestWithParam<int> {
 protected:
  static constexpr int kDraws = 40;

  /// Calls `check(problem number)` for feet that stand seldom, in half of the steps, and always.
  template <class Check>
  void for_random_problems(const Check& check) {
    Draws draws(3);
    for (int i = 0; i < kDraws; ++i) {
      const std::array share = {0.1, 0.5, 1.0};
      draws.fill(recursion_.problem(), GetParam(), share[static_cast<size_t>(i) % share.size()]);
      check(i);
    }
  }

  MpcConfig config_;
  ForceRecursion recursion_{config_, kMass};
  std::array<Vec3, kMaxForces> f_W_;
};

TEST_P(Recursion, FindsTheOptimumOfTheCondensedProblem) {
  for_random_problems([&](int draw) {
    const ForceProblem& problem = recursion_.problem();
    const Condensed condensed(config_, problem);
    ASSERT_TRUE(recursion_.sweep());
    recursion_.roll_out(VectorXd(), f_W_);
    const VectorXd f = stacked(f_W_, problem.forces);
    if (f.size() == 0) return;
    const VectorXd expected = -condensed.H.llt().solve(condensed.g);
    // 1e-9 of the largest force: rounding times the Hessian's condition number, up to 1e6.
    EXPECT_LT((f - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.cwiseAbs().maxCoeff()) << draw;
  });
}

TEST_P(Recursion, FactorsTheInverseOfTheCondensedHessian) {
  for_random_problems([&](int draw) {
    const ForceProblem& problem = recursion_.problem();
    ASSERT_TRUE(recursion_.sweep());
    const int n = 3 * problem.forces;
    MatrixXd J = MatrixXd::Zero(n, n);
    std::array<Mat3, kMaxForces> column;
    for (int j = 0; j < problem.forces; ++j) {
      recursion_.factor_column(j, problem.forces, column);
      for (int i = j; i < problem.forces; ++i) {
        J.block<3, 3>(3 * i, 3 * j) = column[static_cast<size_t>(i)];
      }
    }
    const MatrixXd identity = J.transpose() * Condensed(config_, problem).H * J;
    EXPECT_LT((identity - MatrixXd::Identity(n, n)).norm(), 1e-9) << draw;
  });
}

TEST_P(Recursion, RollsOutThePlanThatTheCoordinatesStandFor) {
  for_random_problems([&](int draw) {
    const ForceProblem& problem = recursion_.problem();
    ASSERT_TRUE(recursion_.sweep());
    recursion_.roll_out(VectorXd(), f_W_);
    VectorXd expected = stacked(f_W_, problem.forces);
    const int given = problem.forces / 2;  // the others count as zero
    const VectorXd y = VectorXd::Random(3 * given);
    std::array<Mat3, kMaxForces> column;
    for (int j = 0; j < given; ++j) {
      recursion_.factor_column(j, problem.forces, column);
      for (int i = j; i < problem.forces; ++i) {
        expected.segment<3>(3 * i) += column[static_cast<size_t>(i)] * y.segment<3>(3 * j);
      }
    }
    recursion_.roll_out(y, f_W_);
    const VectorXd f = stacked(f_W_, problem.forces);
    EXPECT_LT((f - expected).norm(), 1e-11 * expected.norm() + 1e-12) << draw;  // sums of 40 terms
  });
}

INSTANTIATE_TEST_SUITE_P(ForceRecursion, Recursion, testing::Values(1, 2, 3, 10, 16, 24));

TEST(ForceRecursion, KeepsItsPrecisionWhenForceCostsNextToNothing) {
  MpcConfig config;
  config.weight_force = 1e-9;  // the least that the configuration allows
  ForceRecursion recursion(config, kMass);
  std::array<Vec3, kMaxForces> f_W;
  Draws draws(7);
  for (int i = 0; i < 20; ++i) {
    ForceProblem& problem = recursion.problem();
    draws.fill(problem, 16, 0.6);
    const Condensed condensed(config, problem);
    ASSERT_TRUE(recursion.sweep());
    recursion.roll_out(VectorXd(), f_W);
    const VectorXd f = stacked(f_W, problem.forces);
    // The optimum itself is ill-conditioned here (1e10); what remains of the gradient is not.
    EXPECT_LT((condensed.H * f + condensed.g).norm(), 1e-9 * condensed.g.norm());
  }
}

TEST(ForceRecursion, RefusesWhatIsNotPositiveDefinite) {
  MpcConfig config;
  config.weight_velocity.fill(-1e3);
  ForceRecursion recursion(config, kMass);
  Draws(1).fill(recursion.problem(), 4, 1.0);
  EXPECT_FALSE(recursion.sweep());
}

}  // namespace
}  // namespace pirouette
