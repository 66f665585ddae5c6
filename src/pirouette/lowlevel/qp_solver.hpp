// The one place that knows the QP library: strictly convex, inequality-constrained, no allocation
// while solving.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "pirouette/types/contact_forces.hpp"

namespace pirouette {

struct QpSolution {
  SolveStatus status = SolveStatus::kUnconstrained;
  int iterations = 0;  ///< of the active-set solver
};

/// minimise 1/2 x' H x + g' x  subject to  C x >= lower,  H positive definite.
///
/// The caller fills H, g, C and lower of a problem of the size at hand (`prepare`), then solves.
/// The unconstrained optimum (one Cholesky factorisation) is tried first; when it violates a
/// constraint the exact active-set solver (Goldfarb-Idnani, eiquadprog) takes over, under the
/// iteration cap.
class QpSolver {
 public:
  struct Problem {
    Eigen::MatrixXd H;      ///< n x n, both triangles
    Eigen::VectorXd g;      ///< n
    Eigen::MatrixXd C;      ///< m x n, block diagonal: each unit has its own constraints
    Eigen::VectorXd lower;  ///< m
    Eigen::VectorXd x;      ///< n, the solution
  };

  /// Up to here the active-set library works without the heap. The triangular inverse that it
  /// begins with takes n^2 numbers of scratch memory, from the stack while they are at most 128
  /// KiB: n <= 128.
  static constexpr int kMaxVariables = 126;

  /// Sizes the workspaces for every problem of `unit * k` variables, k = 1 .. `max_units`, with
  /// `rows_per_unit * k` constraints; at most kMaxVariables.
  QpSolver(int unit, int rows_per_unit, int max_units, int max_iterations);
  QpSolver(QpSolver&&) noexcept;
  QpSolver& operator=(QpSolver&&) noexcept;
  ~QpSolver();

  /// The problem of `units` units, to be filled; its matrices keep their last values.
  Problem& prepare(int units) noexcept;
  /// Solves the problem last prepared. On kFailed x is zero.
  QpSolution solve() noexcept;

 private:
  struct Workspace;
  std::vector<std::unique_ptr<Workspace>> workspaces_;
  Workspace* current_ = nullptr;
};

}  // namespace pirouette
