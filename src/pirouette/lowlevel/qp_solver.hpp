// Strictly convex, inequality-constrained QP given by its matrices; no allocation while solving.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "pirouette/lowlevel/least_distance.hpp"

namespace pirouette {

/// minimise 1/2 x' H x + g' x  subject to  C x >= lower,  H positive definite.
///
/// The caller fills H, g, C and lower of a prepared problem, then solves it.
/// The unconstrained optimum (one Cholesky factorisation H = L L') is tried first; when it violates
/// a constraint the exact active-set solver continues with the factor J = L'^-1, under the
/// iteration cap.
class QpSolver {
 public:
  /// n variables, m constraints.
  struct Problem {
    Eigen::MatrixXd H;      ///< n x n, both triangles
    Eigen::VectorXd g;      ///< n
    Eigen::MatrixXd C;      ///< m x n, block diagonal: each unit has its own constraints
    Eigen::VectorXd lower;  ///< m
    Eigen::VectorXd x;      ///< n, the solution
  };

  /// Sizes the workspaces for every problem of `unit * k` variables, k = 1 .. `max_units`, with
  /// `rows_per_unit * k` constraints; at most LeastDistance::kMaxVariables.
  QpSolver(int unit, int rows_per_unit, int max_units, int max_iterations);
  QpSolver(QpSolver&&) noexcept;             ///< moves
  QpSolver& operator=(QpSolver&&) noexcept;  ///< moves
  ~QpSolver();

  /// The problem of `units` units, to be filled; its matrices keep their last values.
  Problem& prepare(int units) noexcept;
  /// Solves the problem last prepared. On kFailed x is zero.
  QpSolution solve() noexcept;

 private:
  struct Workspace;
  QpSolution solve_constrained(Workspace& w) noexcept;

  int max_iterations_;
  LeastDistance active_set_;
  std::vector<std::unique_ptr<Workspace>> workspaces_;
  Workspace* current_ = nullptr;
};

}  // namespace pirouette
