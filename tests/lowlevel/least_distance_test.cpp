#include "pirouette/lowlevel/least_distance.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace pirouette {
namespace {

using Eigen::VectorXd;

constexpr int kUnit = 3;
constexpr int kRows = 6;
constexpr int kMaxIterations = 50;

class Nearest : public testing::Test {
 protected:
  /// |y_i| <= 1 for every component, except that the tests below change single rows.
  LeastDistance::Problem& box(int units) {
    LeastDistance::Problem& p = solver_.prepare(units);
    p.C.setZero();
    p.lower.setConstant(-1.0);
    for (int i = 0; i < kUnit * units; ++i) {
      p.C(2 * i, i) = 1.0;
      p.C(2 * i + 1, i) = -1.0;
    }
    return p;
  }

  LeastDistance solver_{kUnit, kRows, LeastDistance::kMaxVariables / kUnit};
};

TEST_F(Nearest, IsTheFootOfThePerpendicularOnAPlane) {
  LeastDistance::Problem& p = box(2);
  const VectorXd normal = VectorXd::LinSpaced(6, 0.1, 0.6);
  p.C.row(3) = normal;
  p.lower[3] = 0.5;
  ASSERT_EQ(solver_.solve(kMaxIterations).status, SolveStatus::kConstrained);
  EXPECT_LT((p.y - 0.5 / normal.squaredNorm() * normal).norm(), 1e-14);
}

TEST_F(Nearest, IsTheCornerThatSeparateBoundsLeave) {
  for (const int units : {1, 5, LeastDistance::kMaxVariables / kUnit}) {
    LeastDistance::Problem& p = box(units);
    for (int i = 0; i < kUnit * units; i += 2) p.lower[2 * i] = 0.25;
    ASSERT_EQ(solver_.solve(2 * kUnit * units).status, SolveStatus::kConstrained);
    for (int i = 0; i < kUnit * units; ++i) EXPECT_NEAR(p.y[i], i % 2 ? 0.0 : 0.25, 1e-14);
  }
}

TEST_F(Nearest, FailsWhenThereIsNone) {
  LeastDistance::Problem& p = box(2);
  p.lower[4] = 2.0;  // and at most 1, by the row below
  EXPECT_EQ(solver_.solve(kMaxIterations).status, SolveStatus::kFailed);
}

TEST_F(Nearest, FailsWhenABoundIsNotFinite) {
  box(2).lower[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solver_.solve(kMaxIterations).status, SolveStatus::kFailed);
}

TEST_F(Nearest, FailsAtTheIterationCap) {
  LeastDistance::Problem& p = box(5);
  for (int i = 0; i < 10; ++i) p.lower[2 * i] = 0.5;  // ten active rows
  const QpSolution solution = solver_.solve(5);
  EXPECT_EQ(solution.status, SolveStatus::kFailed);
  EXPECT_EQ(solution.iterations, 5);
}

}  // namespace
}  // namespace pirouette
