// Ground reaction forces planned by the MPC and refined by the WBC.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

enum class SolveStatus : int {
  kUnconstrained = 0,  ///< the unconstrained optimum obeys every constraint
  kConstrained = 1,    ///< the active-set solver converged
  kHeld = 2,           ///< the solver failed; the last good forces are held
  kFailed = 3,         ///< the solver's own word; the controller turns it into kHeld or stands down
};

struct ContactForces {
  PerLeg<Vec3> f_W = PerLeg<Vec3>::filled(Vec3::Zero());  ///< N, on the robot, world axes
  SolveStatus status = SolveStatus::kUnconstrained;
  int iterations = 0;  ///< of the active-set solver
};

}  // namespace pirouette
