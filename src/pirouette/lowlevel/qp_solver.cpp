#include "pirouette/lowlevel/qp_solver.hpp"

#include <Eigen/Cholesky>

namespace pirouette {

struct QpSolver::Workspace {
  Workspace(int unit, int rows_per_unit, int unit_count)
      : variables_per_unit(unit),
        rows(rows_per_unit),
        units(unit_count),
        cholesky(unit * unit_count),
        J(unit * unit_count, unit * unit_count),
        slack(rows_per_unit * unit_count) {
    const int n = unit * unit_count, m = rows_per_unit * unit_count;
    problem.H.setIdentity(n, n);
    problem.g.setZero(n);
    problem.C.setZero(m, n);
    problem.lower.setZero(m);
    problem.x.setZero(n);
  }

  /// The rows and columns of C that are not zero.
  auto own_constraints(int unit) const {
    return problem.C.block(unit * rows, unit * variables_per_unit, rows, variables_per_unit);
  }

  void find_slack() noexcept {
    slack = -problem.lower;
    for (int i = 0; i < units; ++i) {
      slack.segment(i * rows, rows).noalias() += own_constraints(i).lazyProduct(
          problem.x.segment(i * variables_per_unit, variables_per_unit));
    }
  }

  int variables_per_unit, rows, units;  ///< rows of constraints per unit
  Problem problem;
  Eigen::LLT<Eigen::MatrixXd> cholesky;
  Eigen::MatrixXd J;
  Eigen::VectorXd slack;
};

QpSolver::QpSolver(int unit, int rows_per_unit, int max_units, int max_iterations)
    : max_iterations_(max_iterations), active_set_(unit, rows_per_unit, max_units) {
  workspaces_.reserve(static_cast<size_t>(max_units));
  for (int k = 1; k <= max_units; ++k) {
    workspaces_.push_back(std::make_unique<Workspace>(unit, rows_per_unit, k));
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
  QpSolution solution = {SolveStatus::kFailed, 0};
  w.cholesky.compute(p.H);
  if (w.cholesky.info() == Eigen::Success) {
    p.x = -p.g;
    w.cholesky.solveInPlace(p.x);
    w.find_slack();
    if (w.slack.allFinite()) {
      solution.status = SolveStatus::kUnconstrained;
      if (w.slack.minCoeff() < -kFeasibilityTolerance) solution = solve_constrained(w);
    }
  }
  if (solution.status == SolveStatus::kFailed) p.x.setZero();
  return solution;
}

QpSolution QpSolver::solve_constrained(Workspace& w) noexcept {
  w.J.setIdentity();
  w.cholesky.matrixU().solveInPlace(w.J);
  LeastDistance::Problem& nearest = active_set_.prepare(w.units);
  for (int i = 0; i < w.units; ++i) {
    nearest.C.middleRows(i * w.rows, w.rows) = w.own_constraints(i).lazyProduct(
        w.J.middleRows(i * w.variables_per_unit, w.variables_per_unit));
  }
  nearest.lower = -w.slack;
  const QpSolution solution = active_set_.solve(max_iterations_);
  w.problem.x.noalias() += w.J * nearest.y;
  return solution;
}

}  // namespace pirouette
