// Optimal contact forces of the linear single rigid body without force limits, by dynamic
// programming.
#pragma once

#include <Eigen/Core>
#include <array>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/lowlevel/mpc_config.hpp"

namespace pirouette {

inline constexpr int kMaxHorizon = 24;  ///< steps
/// Largest number of forces in a prediction. 16 steps of a trot of duty 0.6 have 40, as have 10
/// steps on four feet.
inline constexpr int kMaxForces = 42;

/// Change of the body's state by the forces: attitude (rad), CoM position, angular velocity and CoM
/// velocity, world axes.
using BodyDeviation = Eigen::Matrix<double, 12, 1>;

/// A force of the prediction.
struct PlannedForce {
  int step = 0;        ///< in which it acts
  Leg leg = Leg::kFR;  ///< on which it acts
  Mat3 W;              ///< rad/s per N: change of angular velocity by this force over its step
};

/// Problem of the recursion. Forces are ordered by step.
struct ForceProblem {
  double dt = 0.0;                  ///< s, length of a step
  int steps = 0;                    ///< of the prediction
  int forces = 0;                   ///< in all steps
  std::array<Mat3, kMaxHorizon> T;  ///< attitude rate per angular velocity, during a step (E24)
  std::array<BodyDeviation, kMaxHorizon> free_error;  ///< at a step's end, without forces
  std::array<PlannedForce, kMaxForces> force;         ///< the first `forces` are used
};

/// Riccati recursion over single forces: docs/equations.md#force-recursion.
///
/// The forces of a step act one after the other on the state that the step's motion has reached, so
/// that every stage of the recursion has three inputs. Each stage also is a row of blocks of the
/// factor J of the condensed problem's inverse Hessian J J': with y = 0 the roll-out gives the
/// optimum f*, and any other plan is f = f* + J y at the additional cost |y|^2.
class ForceRecursion {
 public:
  /// `mass` in kg.
  ForceRecursion(const MpcConfig& config, double mass);

  /// The problem, to be filled before sweep().
  ForceProblem& problem() { return problem_; }
  const ForceProblem& problem() const { return problem_; }  ///< as filled

  /// Backward pass, from the end of the horizon. Returns false when the problem is not positive
  /// definite.
  bool sweep() noexcept;

  /// Forward pass: forces `f_W` = f* + J y (N, world axes). `y` may be shorter than the plan; its
  /// other elements are zero.
  void roll_out(const Eigen::VectorXd& y, std::array<Vec3, kMaxForces>& f_W) const noexcept;

  /// Column `j` of J in 3 x 3 blocks: column[i], i = j .. count - 1. Those above are zero.
  void factor_column(int j, int count, std::array<Mat3, kMaxForces>& column) const noexcept;

 private:
  using Mat12x3 = Eigen::Matrix<double, 12, 3>;

  /// f = Z (y - y0 - Y' d) for the deviation d that the force finds.
  struct Feedback {
    Mat12x3 Y;
    Vec3 y0;
    Mat3 Z;  ///< upper triangular
  };

  template <int Rows>
  Eigen::Matrix<double, Rows, 3> times_input(const Eigen::Matrix<double, Rows, 12>& M,
                                             const PlannedForce& force) const noexcept;
  template <int Columns>
  void apply(const PlannedForce& force, const Eigen::Matrix<double, 3, Columns>& f,
             Eigen::Matrix<double, 12, Columns>& d) const noexcept;
  template <int Columns>
  void advance(int step, Eigen::Matrix<double, 12, Columns>& d) const noexcept;
  void carry_back(int step) noexcept;

  BodyDeviation weight_;
  double weight_force_;
  double mass_;
  ForceProblem problem_;
  std::array<Feedback, kMaxForces> feedback_;
  Eigen::Matrix<double, 12, 12> P_;  ///< the cost to go is d' P d + 2 q' d
  BodyDeviation q_;
};

}  // namespace pirouette
