#include "pirouette/lowlevel/qp_solver.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <bit>
#include <limits>
#include <optional>
#include <random>

#include "pirouette/lowlevel/friction_pyramid.hpp"

namespace pirouette {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kUnit = 3;
constexpr int kMaxUnits = 20;
constexpr int kMaxIterations = 200;

/// Random problems of `units` forces under one friction pyramid each.
class Draws {
 public:
  explicit Draws(unsigned seed) : generator_(seed) {}

  double normal() { return std::normal_distribution<double>()(generator_); }
  Vec3 vec3() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }

  /// `pull`: typical distance of the unconstrained optimum from the origin, N.
  void fill(QpSolver::Problem& p, int units, double pull) {
    const int n = kUnit * units;
    const MatrixXd root = MatrixXd::NullaryExpr(n, n, [&] { return normal(); });
    p.H = root * root.transpose() / n + 1e-3 * MatrixXd::Identity(n, n);
    p.g = -p.H * VectorXd::NullaryExpr(n, [&] { return pull * normal(); });
    p.C.setZero();
    for (int i = 0; i < units; ++i) {
      const Vec3 n_W = (Vec3::UnitZ() + 0.2 * vec3()).normalized();
      const FrictionPyramid pyramid(n_W, 0.6, 2.0, 150.0);
      p.C.block<kPyramidRows, 3>(kPyramidRows * i, 3 * i) = pyramid.C;
      p.lower.segment<kPyramidRows>(kPyramidRows * i) = pyramid.lower;
    }
  }

 private:
  std::mt19937 generator_;
};

/// The optimum of a 3-variable problem by trying every set of at most 3 active rows.
std::optional<Vec3> by_enumeration(const QpSolver::Problem& p) {
  for (unsigned set = 0; set < (1U << kPyramidRows); ++set) {
    const int active = std::popcount(set);
    if (active > kUnit) continue;
    MatrixXd kkt = MatrixXd::Zero(kUnit + active, kUnit + active);
    VectorXd right(kUnit + active);
    kkt.topLeftCorner(kUnit, kUnit) = p.H;
    right.head(kUnit) = -p.g;
    for (int row = 0, i = kUnit; row < kPyramidRows; ++row) {
      if (!(set & (1U << row))) continue;
      kkt.row(i).head(kUnit) = p.C.row(row);
      kkt.col(i).head(kUnit) = -p.C.row(row).transpose();
      right[i++] = p.lower[row];
    }
    const Eigen::FullPivLU<MatrixXd> lu(kkt);
    if (!lu.isInvertible()) continue;  // rows that are not independent
    const VectorXd solution = lu.solve(right);
    const Vec3 x = solution.head<kUnit>();
    const bool feasible = (p.C * x - p.lower).minCoeff() > -1e-9;
    if (feasible && (active == 0 || solution.tail(active).minCoeff() > -1e-9)) return x;
  }
  return std::nullopt;
}

/// Stationarity of the Lagrangian with non-negative multipliers on the rows that x touches.
void expect_optimal(const QpSolver::Problem& p, double scale) {
  const VectorXd slack = p.C * p.x - p.lower;
  EXPECT_GT(slack.minCoeff(), -1e-6);  // the tolerance the solver states, N
  std::vector<int> active;
  for (int row = 0; row < slack.size(); ++row) {
    if (slack[row] < 1e-6) active.push_back(row);
  }
  const VectorXd gradient = p.H * p.x + p.g;
  // 1e-9 of the gradient at the origin: the active-set solver's own roundings.
  const double tolerance = 1e-9 * scale;
  if (active.empty()) {
    EXPECT_LT(gradient.cwiseAbs().maxCoeff(), tolerance);
    return;
  }
  MatrixXd rows(active.size(), p.x.size());
  for (std::size_t i = 0; i < active.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = p.C.row(active[i]);
  }
  const VectorXd multipliers = rows.transpose().colPivHouseholderQr().solve(gradient);
  EXPECT_LT((rows.transpose() * multipliers - gradient).cwiseAbs().maxCoeff(), tolerance);
  EXPECT_GT(multipliers.minCoeff(), -tolerance);
}

class Qp : public testing::Test {
 protected:
  QpSolver solver_{kUnit, kPyramidRows, kMaxUnits, kMaxIterations};
  Draws draws_{5};
};

TEST_F(Qp, IsTheCholeskySolutionWhenThatObeysTheConstraints) {
  for (const int units : {1, 2, 7, kMaxUnits}) {
    QpSolver::Problem& p = solver_.prepare(units);
    draws_.fill(p, units, 1.0);
    const VectorXd inside = VectorXd::NullaryExpr(kUnit * units, [](Eigen::Index i) {
      return i % 3 == 2 ? 40.0 : 1.0;  // N, well within a pyramid that leans by a few degrees
    });
    p.g = -p.H * inside;
    const QpSolution solution = solver_.solve();
    EXPECT_EQ(solution.status, SolveStatus::kUnconstrained);
    EXPECT_EQ(solution.iterations, 0);
    EXPECT_LT((p.x - inside).cwiseAbs().maxCoeff(), 1e-9);  // condition number up to 1e4
  }
}

TEST_F(Qp, AgreesWithEnumerationOfTheActiveSetsOfOneForce) {
  int constrained = 0;
  for (int i = 0; i < 500; ++i) {
    QpSolver::Problem& p = solver_.prepare(1);
    draws_.fill(p, 1, 100.0);
    const std::optional<Vec3> expected = by_enumeration(p);
    ASSERT_TRUE(expected.has_value());
    const QpSolution solution = solver_.solve();
    ASSERT_NE(solution.status, SolveStatus::kFailed);
    constrained += solution.status == SolveStatus::kConstrained;
    // 1e-6 N: the solver's feasibility tolerance, within which it keeps the unconstrained optimum.
    EXPECT_LT((p.x - *expected).norm(), 1e-5);
  }
  EXPECT_GT(constrained, 300);  // most draws pull the force out of its pyramid
}

TEST_F(Qp, MeetsTheKktConditionsOfLargeProblems) {
  for (int i = 0; i < 30; ++i) {
    QpSolver::Problem& p = solver_.prepare(kMaxUnits);
    draws_.fill(p, kMaxUnits, 80.0);
    const double scale = p.g.cwiseAbs().maxCoeff();
    const QpSolution solution = solver_.solve();
    ASSERT_EQ(solution.status, SolveStatus::kConstrained);
    EXPECT_GT(solution.iterations, 0);
    expect_optimal(p, scale);
  }
}

TEST_F(Qp, AnswersTheProblemAtHandWhateverWasSolvedBefore) {
  const auto solve = [](QpSolver& solver, int units, unsigned seed) {
    QpSolver::Problem& p = solver.prepare(units);
    Draws(seed).fill(p, units, 80.0);
    solver.solve();
    return p.x;
  };
  const VectorXd alone = solve(solver_, 4, 1);
  solve(solver_, 4, 2);
  solve(solver_, kMaxUnits, 3);
  EXPECT_EQ(solve(solver_, 4, 1), alone);
}

TEST_F(Qp, FailsWithZerosWhenTheConstraintsContradict) {
  QpSolver::Problem& p = solver_.prepare(2);
  draws_.fill(p, 2, 10.0);
  p.lower[4] = 200.0;  // least normal force above the largest one, 150 N
  EXPECT_EQ(solver_.solve().status, SolveStatus::kFailed);
  EXPECT_EQ(p.x, VectorXd::Zero(6));
}

TEST_F(Qp, FailsWithZerosWhenTheHessianIsNotPositiveDefinite) {
  QpSolver::Problem& p = solver_.prepare(2);
  draws_.fill(p, 2, 10.0);
  p.H(3, 3) = -1.0;
  EXPECT_EQ(solver_.solve().status, SolveStatus::kFailed);
  EXPECT_EQ(p.x, VectorXd::Zero(6));
}

TEST_F(Qp, FailsWithZerosWhenAnInputIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const int spoilt : {0, 1, 2, 3}) {
    QpSolver::Problem& p = solver_.prepare(2);
    draws_.fill(p, 2, 10.0);
    if (spoilt == 0) p.H(1, 1) = kNan;
    if (spoilt == 1) p.g[0] = kNan;
    if (spoilt == 2) p.C(3, 2) = kNan;
    if (spoilt == 3) p.lower[3] = kNan;
    EXPECT_EQ(solver_.solve().status, SolveStatus::kFailed) << spoilt;
    EXPECT_EQ(p.x, VectorXd::Zero(6)) << spoilt;
  }
}

TEST_F(Qp, FailsWithZerosAtTheIterationCap) {
  QpSolver capped(kUnit, kPyramidRows, kMaxUnits, 3);
  QpSolver::Problem& p = capped.prepare(kMaxUnits);
  draws_.fill(p, kMaxUnits, 80.0);
  EXPECT_EQ(capped.solve().status, SolveStatus::kFailed);
  EXPECT_EQ(p.x, VectorXd::Zero(kUnit * kMaxUnits));

  QpSolver::Problem& again = solver_.prepare(kMaxUnits);
  Draws(5).fill(again, kMaxUnits, 80.0);
  EXPECT_EQ(solver_.solve().status, SolveStatus::kConstrained);  // the cap was the only obstacle
}

TEST_F(Qp, RecoversFromAFailure) {
  QpSolver::Problem& p = solver_.prepare(2);
  draws_.fill(p, 2, 80.0);
  const QpSolver::Problem good = p;
  p.H.setZero();
  EXPECT_EQ(solver_.solve().status, SolveStatus::kFailed);
  p = good;
  EXPECT_NE(solver_.solve().status, SolveStatus::kFailed);
  expect_optimal(p, p.g.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace pirouette
