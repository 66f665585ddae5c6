// The one place that knows the QP library.
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

/// Slack below which a force limit counts as met, N: far below what any sensor or motor resolves.
inline constexpr double kFeasibilityTolerance = 1e-6;

/// minimise |y|^2  subject to  C y >= lower, by the exact dual active-set method (Goldfarb-Idnani,
/// eiquadprog).
///
/// Every strictly convex QP has this form in the coordinates y of  x = x* + J y, where x* is the
/// unconstrained optimum and J J' the inverse of the Hessian. So whoever has a factor already does
/// not factorise again, and the library's tests for zero see a Hessian of condition number one.
class LeastDistance {
 public:
  struct Problem {
    Eigen::MatrixXd C;      ///< m x n
    Eigen::VectorXd lower;  ///< m
    Eigen::VectorXd y;      ///< n, the solution
  };

  /// Up to here the library works without the heap. The triangular inverse that it begins with
  /// takes n^2 numbers of scratch memory, from the stack while they are at most 128 KiB: n <= 128.
  static constexpr int kMaxVariables = 126;

  /// Sizes the workspaces for every problem of `unit * k` variables, k = 1 .. `max_units`, with
  /// `rows_per_unit * k` constraints; at most kMaxVariables.
  LeastDistance(int unit, int rows_per_unit, int max_units);
  LeastDistance(LeastDistance&&) noexcept;
  LeastDistance& operator=(LeastDistance&&) noexcept;
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
