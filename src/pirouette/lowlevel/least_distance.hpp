// Least-distance QP; the only user of the QP library.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "pirouette/types/contact_forces.hpp"

namespace pirouette {

/// How a QP was solved.
struct QpSolution {
  SolveStatus status = SolveStatus::kUnconstrained;  ///< kUnconstrained, kConstrained or kFailed
  int iterations = 0;                                ///< of the active-set solver
};

/// N, violation of a force limit that is tolerated; far below what any sensor or motor resolves.
inline constexpr double kFeasibilityTolerance = 1e-6;

/// minimise |y|^2  subject to  C y >= lower, by the exact dual active-set method (Goldfarb-Idnani,
/// eiquadprog).
///
/// Every strictly convex QP has this form in the coordinates y of  x = x* + J y, where x* is the
/// unconstrained optimum and J J' the inverse of the Hessian. So a factor that is already
/// known is not computed again, and the library tests for zero with a Hessian of condition
/// number 1.
class LeastDistance {
 public:
  /// minimise |y|^2 subject to C y >= lower; m constraints, n variables.
  struct Problem {
    Eigen::MatrixXd C;      ///< m x n
    Eigen::VectorXd lower;  ///< m
    Eigen::VectorXd y;      ///< n, the solution
  };

  /// Largest number of variables without a heap allocation in the library. Its triangular inverse
  /// takes n^2 numbers of scratch memory, from the stack while they are at most 128 KiB: n <= 128.
  static constexpr int kMaxVariables = 126;

  /// Sizes the workspaces for every problem of `unit * k` variables, k = 1 .. `max_units`, with
  /// `rows_per_unit * k` constraints; at most kMaxVariables.
  LeastDistance(int unit, int rows_per_unit, int max_units);
  LeastDistance(LeastDistance&&) noexcept;             ///< moves
  LeastDistance& operator=(LeastDistance&&) noexcept;  ///< moves
  ~LeastDistance();

  /// The problem of `units` units, to be filled; its matrices keep their last values.
  Problem& prepare(int units) noexcept;
  /// Solves the problem last prepared: kConstrained, or kFailed after `max_iterations` or when no y
  /// obeys the constraints.
  QpSolution solve(int max_iterations) noexcept;

 private:
  struct Workspace;
  std::vector<std::unique_ptr<Workspace>> workspaces_;
  Workspace* current_ = nullptr;
};

}  // namespace pirouette
