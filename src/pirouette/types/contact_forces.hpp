// Ground reaction forces, planned by the MPC and refined by the whole-body control.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

/// How a solution was found.
enum class SolveStatus : int {
  kUnconstrained = 0,  ///< the unconstrained optimum obeys every constraint
  kConstrained = 1,    ///< the active-set solver converged
  kHeld = 2,           ///< the solver failed; the last good forces are held
  kFailed = 3,         ///< the solver failed; the controller reports kHeld or stands down
};

/// Forces of the ground on the feet.
struct ContactForces {
  PerLeg<Vec3> f_W = PerLeg<Vec3>::filled(Vec3::Zero());  ///< N, on the robot, world axes
  SolveStatus status = SolveStatus::kUnconstrained;       ///< how they were found
  int iterations = 0;                                     ///< of the active-set solver
};

}  // namespace pirouette
