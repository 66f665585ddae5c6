#include "pirouette/lowlevel/qp_solver.hpp"

#include <Eigen/Cholesky>
#include <eiquadprog/eiquadprog-fast.hpp>

namespace pirouette {

namespace {

// Slack below which a constraint counts as met, N: far below what any sensor or motor resolves.
constexpr double kFeasibilityTolerance = 1e-6;

using eiquadprog::solvers::EIQUADPROG_FAST_OPTIMAL;
using eiquadprog::solvers::EiquadprogFast;

}  // namespace

struct QpSolver::Workspace {
  Workspace(int unit, int rows_per_unit, int units, int max_iterations)
      : Workspace(unit * units, rows_per_unit * units, max_iterations) {
    variables_per_unit = unit;
    rows = rows_per_unit;
  }

  Workspace(int n, int m, int max_iterations)
      : factor(n, n), slack(m), negative_lower(m), no_equalities(0, n), no_offsets(0) {
    problem.H.setIdentity(n, n);
    problem.g.setZero(n);
    problem.C.setZero(m, n);
    problem.lower.setZero(m);
    problem.x.setZero(n);
    active_set.reset(static_cast<size_t>(n), 0, static_cast<size_t>(m));
    active_set.setMaxIter(max_iterations);
  }

  void find_slack() noexcept {
    slack = -problem.lower;
    for (Eigen::Index row = 0, column = 0; row < slack.size();
         row += rows, column += variables_per_unit) {
      slack.segment(row, rows).noalias() +=
          problem.C.block(row, column, rows, variables_per_unit)
              .lazyProduct(problem.x.segment(column, variables_per_unit));
    }
  }

  int variables_per_unit = 1;
  int rows = 1;  ///< of constraints per unit
  Problem problem;
  Eigen::MatrixXd factor;
  Eigen::VectorXd slack;
  Eigen::VectorXd negative_lower;
  Eigen::MatrixXd no_equalities;
  Eigen::VectorXd no_offsets;
  EiquadprogFast active_set;
};

QpSolver::QpSolver(int unit, int rows_per_unit, int max_units, int max_iterations) {
  workspaces_.reserve(static_cast<size_t>(max_units));
  for (int k = 1; k <= max_units; ++k) {
    workspaces_.push_back(std::make_unique<Workspace>(unit, rows_per_unit, k, max_iterations));
  }
  current_ = workspaces_.front().get();
}

QpSolver::QpSolver(QpSolver&&) noexcept = default;
QpSolver& QpSolver::operator=(QpSolver&&) noexcept = default;
QpSolver::~QpSolver() = default;

QpSolver::Problem& QpSolver::prepare(int units) noexcept {
  current_ = workspaces_[static_cast<size_t>(units - 1)].get();
  return current_->problem;
}

QpSolution QpSolver::solve() noexcept {
  Workspace& w = *current_;
  Problem& p = w.problem;

  w.factor = p.H;
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> cholesky(w.factor);
  if (cholesky.info() != Eigen::Success) {
    p.x.setZero();
    return {SolveStatus::kFailed, 0};
  }
  p.x = -p.g;
  cholesky.solveInPlace(p.x);
  w.find_slack();
  if (!w.slack.allFinite()) {
    p.x.setZero();
    return {SolveStatus::kFailed, 0};
  }
  if (w.slack.minCoeff() >= -kFeasibilityTolerance) return {SolveStatus::kUnconstrained, 0};

  w.negative_lower = -p.lower;
  const auto status = w.active_set.solve_quadprog(p.H, p.g, w.no_equalities, w.no_offsets, p.C,
                                                  w.negative_lower, p.x);
  const int iterations = w.active_set.getIteratios();
  if (status != EIQUADPROG_FAST_OPTIMAL || !p.x.allFinite()) {
    p.x.setZero();
    return {SolveStatus::kFailed, iterations};
  }
  return {SolveStatus::kConstrained, iterations};
}

}  // namespace pirouette
