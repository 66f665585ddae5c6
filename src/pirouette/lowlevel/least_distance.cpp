#include "pirouette/lowlevel/least_distance.hpp"

#include <eiquadprog/eiquadprog-fast.hpp>

namespace pirouette {

using eiquadprog::solvers::EIQUADPROG_FAST_OPTIMAL;
using eiquadprog::solvers::EiquadprogFast;

struct LeastDistance::Workspace {
  Workspace(int n, int m)
      : identity(Eigen::MatrixXd::Identity(n, n)),
        zero(Eigen::VectorXd::Zero(n)),
        negative_lower(m),
        no_equalities(0, n),
        no_offsets(0) {
    problem.C.setZero(m, n);
    problem.lower.setZero(m);
    problem.y.setZero(n);
    active_set.reset(static_cast<size_t>(n), 0, static_cast<size_t>(m));
  }

  Problem problem;
  Eigen::MatrixXd identity;
  Eigen::VectorXd zero;
  Eigen::VectorXd negative_lower;
  Eigen::MatrixXd no_equalities;
  Eigen::VectorXd no_offsets;
  EiquadprogFast active_set;
};

LeastDistance::LeastDistance(int unit, int rows_per_unit, int max_units) {
  workspaces_.reserve(static_cast<size_t>(max_units));
  for (int k = 1; k <= max_units; ++k) {
    workspaces_.push_back(std::make_unique<Workspace>(unit * k, rows_per_unit * k));
  }
  current_ = workspaces_.front().get();
}

LeastDistance::LeastDistance(LeastDistance&&) noexcept = default;
LeastDistance& LeastDistance::operator=(LeastDistance&&) noexcept = default;
LeastDistance::~LeastDistance() = default;

LeastDistance::Problem& LeastDistance::prepare(int units) noexcept {
  current_ = workspaces_[static_cast<size_t>(units - 1)].get();
  return current_->problem;
}

QpSolution LeastDistance::solve(int max_iterations) noexcept {
  Workspace& w = *current_;
  Problem& p = w.problem;
  if (!p.lower.allFinite()) return {SolveStatus::kFailed, 0};
  w.negative_lower = -p.lower;
  w.active_set.setMaxIter(max_iterations);
  const auto status = w.active_set.solve_quadprog(w.identity, w.zero, w.no_equalities, w.no_offsets,
                                                  p.C, w.negative_lower, p.y);
  const bool solved = status == EIQUADPROG_FAST_OPTIMAL && p.y.allFinite();
  return {solved ? SolveStatus::kConstrained : SolveStatus::kFailed, w.active_set.getIteratios()};
}

}  // namespace pirouette
