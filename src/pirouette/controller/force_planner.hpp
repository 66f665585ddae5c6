// Contact forces of the MPC: when it is solved, its input, and the forces between solutions.
#pragma once

#include "pirouette/controller/tick_clock.hpp"
#include "pirouette/gait/gait_clock.hpp"
#include "pirouette/lowlevel/convex_mpc.hpp"
#include "pirouette/lowlevel/mpc_config.hpp"
#include "pirouette/types/body_reference.hpp"
#include "pirouette/types/contact_forces.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/foothold_plan.hpp"
#include "pirouette/types/gait_phase.hpp"
#include "pirouette/types/robot_state.hpp"
#include "pirouette/types/terrain_plane.hpp"

namespace pirouette {

/// Input of ForcePlanner::update(), all of this tick.
struct ForcePlannerInput {
  const RobotState& state;         ///< estimated state of the robot
  const GaitPhase& gait;           ///< phase of each leg
  const GaitClock& clock;          ///< predicts the stances over the horizon
  const FootContacts& contacts;    ///< contact of each foot
  const TerrainPlane& plane;       ///< estimated ground plane
  const FootholdPlan& footholds;   ///< planned footholds
  const BodyReference& reference;  ///< body reference
};

/// Solves every mpc.solve_period and whenever the contact set changes.
class ForcePlanner {
 public:
  /// `control_period` (s) is that of update(). `standing_period` (s) stands in for the stride's
  /// while the robot does not walk; `com_height` in m above the plane.
  ForcePlanner(const MpcConfig& config, double control_period, double standing_period,
               double com_height, double mass, const Mat3& inertia_B)
      : config_(config),
        ticks_per_solve_(std::max(1, ticks_in(config.solve_period, control_period))),
        standing_period_(standing_period),
        com_height_(com_height),
        mpc_(config, mass, inertia_B) {}

  /// Forces of the last successful solution; status kHeld while solutions have failed since.
  ContactForces update(const ForcePlannerInput& in) noexcept;

  /// What the MPC is asked: contacts and references step by step, lever arms about the reference.
  MpcInput mpc_input(const ForcePlannerInput& in) const noexcept;

  int failures() const { return failures_; }  ///< failed solutions in a row
  /// us, of the last update; 0: the MPC was not solved
  double solve_us() const { return solve_us_; }
  void reset() noexcept;  ///< no forces planned, no failures

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, ticks_per_solve, standing_period, com_height, mpc, failures, ticks_until_solve,
           solved_contacts, forces, solve_us] = self;
    visit(failures, ticks_until_solve, solved_contacts, forces);
  }

 private:
  MpcConfig config_;
  int ticks_per_solve_;
  double standing_period_;
  double com_height_;
  ConvexMpc mpc_;
  int failures_ = 0;
  int ticks_until_solve_ = 0;
  PerLeg<bool> solved_contacts_{};  ///< contact set of the last solution
  ContactForces forces_;
  double solve_us_ = 0.0;
};

}  // namespace pirouette
