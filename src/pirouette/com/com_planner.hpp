// Horizontal target of the CoM: weighted mean of the feet's projected support polygon (PSP).
#pragma once

#include <optional>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/com/com_config.hpp"
#include "pirouette/types/com_plan.hpp"
#include "pirouette/types/gait_phase.hpp"

namespace pirouette {

/// Bump over a phase, in [0, 1]: 0 at `progress` 0 and 1, 1 at the middle, symmetric. `width` as in
/// ComConfig::width; the polynomial ignores it.
/// [Zhu21] Eq. (16), normalised (E18): docs/equations.md#eq-16
double psp_bump(PspWeight family, double width, double progress);

/// Vertex weight of a foot (E18): largest in mid-stance, `swing_weight_min` in mid-swing; value and
/// slope are continuous at a switch between stance and swing.
double psp_weight(bool stance, double bump, double duty, double swing_weight_min);

/// Weighted mean (m) of `points` (m); absent when the weights sum to zero.
/// [Zhu21] Eqs. (17)-(18), corrected (E19): docs/equations.md#eq-18
std::optional<Vec2> weighted_centroid(const PerLeg<Vec2>& points, const PerLeg<double>& weights);

/// Target (m) on the line of the stance feet (E20): in mid-swing the midpoint of the stance
/// diagonal, at its ends (`bump` 0) the crossing with the swing diagonal. Absent when the diagonals
/// are close to parallel or cross outside the stance diagonal.
std::optional<Vec2> on_diagonal_target(const Vec2& stance_a, const Vec2& stance_b,
                                       const Vec2& swing_a, const Vec2& swing_b, double bump);

/// Weight of a foot in the planner that the PSP comes from: [Bledt18], eq. 10, one sigma for all
/// its terms.
double bledt2018_weight(bool stance, double progress, double sigma);

/// Target (m) of that planner, from its virtual predictive support polygon: [Bledt18], eqs. 11-12.
Vec2 bledt2018_target(const PerLeg<Vec2>& feet, const PerLeg<double>& weights);

/// Input of CentreOfMassPlanner::update(); points are horizontal, world axes.
struct ComPlannerInput {
  GaitPhase gait;                                             ///< phase of each leg
  PerLeg<Vec2> contact = PerLeg<Vec2>::filled(Vec2::Zero());  ///< m, where a foot in stance stands
  PerLeg<Vec2> lift_off =
      PerLeg<Vec2>::filled(Vec2::Zero());  ///< m, where a foot in swing last stood
  PerLeg<Vec2> next_foothold = PerLeg<Vec2>::filled(Vec2::Zero());  ///< m, contact points
  PerLeg<bool> touching{};                                          ///< feet on the ground
  Vec2 reference = Vec2::Zero();  ///< m, path reference of the CoM
  Vec2 com = Vec2::Zero();        ///< m, estimated CoM
};

/// Output of CentreOfMassPlanner::update().
struct ComTarget {
  ComPlan plan;             ///< target of the CoM
  PerLeg<double> weight{};  ///< vertex weights, each in [swing_weight_min, 1]
};

/// psp: the weighted mean of feet and coming footholds, followed as an offset from the path
/// reference, whose speed is limited. linear: the point of the straight line from the measured CoM
/// to the path reference that is reached within a stride at the speed limit.
class CentreOfMassPlanner {
 public:
  /// No offset from the path reference.
  explicit CentreOfMassPlanner(const ComConfig& config) : config_(config) {}

  /// Target after one tick of `dt` (s).
  ComTarget update(const ComPlannerInput& in, double dt) noexcept;
  void reset() noexcept;  ///< no offset from the path reference

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, started, vertices, offset] = self;
    visit(started, vertices, offset);
  }

 private:
  /// Vertex of one foot: (weight, x, y). At an early or late contact weight and position jump, and
  /// the jump is faded out.
  struct Vertex {
    Vec3 nominal = Vec3::Zero();
    Vec3 jump = Vec3::Zero();  ///< before minus after
    double fade = 0.0;         ///< share of the jump that is left
    bool supporting = true;
    bool scheduled_stance = true;

    Vec3 faded() const { return nominal + fade * jump; }
    double weight() const { return faded().x(); }
    Vec2 p_W() const { return faded().tail<2>(); }
  };

  void update_vertex(const ComPlannerInput& in, Leg leg, double dt) noexcept;
  Vec3 nominal_vertex(const ComPlannerInput& in, Leg leg, bool supporting) const noexcept;
  std::optional<Vec2> polygon_target() const noexcept;
  std::optional<Vec2> diagonal_target(const ComPlannerInput& in) const noexcept;
  ComPlan psp_plan(const ComPlannerInput& in, double dt) noexcept;
  ComPlan linear_plan(const ComPlannerInput& in) const noexcept;

  ComConfig config_;
  bool started_ = false;
  PerLeg<Vertex> vertices_;
  Vec2 offset_ = Vec2::Zero();  ///< m, target from the path reference
};

}  // namespace pirouette
