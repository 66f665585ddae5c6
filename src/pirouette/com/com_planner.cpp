#include "pirouette/com/com_planner.hpp"

#include <algorithm>
#include <cmath>

namespace pirouette {
namespace {

constexpr double kFadeTime = 0.02;  // s, for jumps against the schedule
constexpr double kEarliestLanding =
    0.5;                            // share of the swing before which a touch is not a landing
constexpr double kNoWeight = 1e-6;  // total weight that counts as none
constexpr std::array<Leg, 2> kFirstPair = {Leg::kFR, Leg::kRL};
constexpr std::array<Leg, 2> kSecondPair = {Leg::kFL, Leg::kRR};

double smooth_step(double f) { return f * f * f * (10.0 + f * (-15.0 + 6.0 * f)); }

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

bool in_swing(const GaitPhase& gait, const std::array<Leg, 2>& pair) {
  return !gait.leg[pair[0]].stance && !gait.leg[pair[1]].stance;
}

}  // namespace

double psp_bump(PspWeight family, double width, double progress) {
  // The widths of the families match: each has its default shape at the Gaussian's default sigma.
  constexpr double kDefaultWidth = 0.25, kPoissonLambda = 4.0, kGeometricRho = 0.05;
  const double f = std::clamp(progress, 0.0, 1.0);
  switch (family) {
    case PspWeight::kGaussian: {
      const double end = std::exp(-0.125 / square(width));
      return (std::exp(-0.5 * square((f - 0.5) / width)) - end) / (1.0 - end);
    }
    case PspWeight::kGeometric: {
      const double rho = std::pow(kGeometricRho, kDefaultWidth / width);
      return (std::pow(rho, 2.0 * std::abs(f - 0.5)) - rho) / (1.0 - rho);
    }
    case PspWeight::kPoisson: {
      const double lambda = kPoissonLambda * square(kDefaultWidth / width);
      const double y = 2.0 * std::min(f, 1.0 - f);
      return std::pow(y * std::exp(1.0 - y), lambda);
    }
    case PspWeight::kPolynomial:
      return 4.0 * f * (1.0 - f);
  }
  return 0.0;
}

double psp_weight(bool stance, double bump, double duty, double swing_weight_min) {
  const double at_switch = (1.0 - duty) + duty * swing_weight_min;
  const double at_middle = stance ? 1.0 : swing_weight_min;
  return at_switch + (at_middle - at_switch) * bump;
}

std::optional<Vec2> weighted_centroid(const PerLeg<Vec2>& points, const PerLeg<double>& weights) {
  Vec2 sum = Vec2::Zero();
  double total = 0.0;
  for (const Leg leg : kLegs) {
    sum += weights[leg] * points[leg];
    total += weights[leg];
  }
  if (total < kNoWeight) return std::nullopt;
  return sum / total;
}

std::optional<Vec2> on_diagonal_target(const Vec2& stance_a, const Vec2& stance_b,
                                       const Vec2& swing_a, const Vec2& swing_b, double bump) {
  constexpr double kLeastCrossing = radians(20.0);
  const Vec2 stance = stance_b - stance_a, swing = swing_b - swing_a;
  const double turn = cross(stance, swing);
  if (std::abs(turn) <= std::sin(kLeastCrossing) * stance.norm() * swing.norm())
    return std::nullopt;
  const double along = cross(swing_a - stance_a, swing) / turn;
  if (along < 0.0 || along > 1.0) return std::nullopt;
  return stance_a + ((1.0 - bump) * along + bump * 0.5) * stance;
}

double bledt2018_weight(bool stance, double progress, double sigma) {
  const double scale = sigma * std::sqrt(2.0);
  const double begun = std::erf(progress / scale), left = std::erf((1.0 - progress) / scale);
  return stance ? 0.5 * (begun + left) : 0.5 * (2.0 - begun - left);
}

Vec2 bledt2018_target(const PerLeg<Vec2>& feet, const PerLeg<double>& weights) {
  constexpr std::array<Leg, kLegCount> kAround = {Leg::kFR, Leg::kFL, Leg::kRL, Leg::kRR};
  Vec2 sum = Vec2::Zero();
  for (std::size_t i = 0; i < kLegCount; ++i) {
    const Leg leg = kAround[i];
    Vec2 vertex = weights[leg] * feet[leg];
    double total = weights[leg];
    for (const Leg neighbour : {kAround[(i + 1) % kLegCount], kAround[(i + 3) % kLegCount]}) {
      const Vec2 virtual_point = weights[leg] * feet[leg] + (1.0 - weights[leg]) * feet[neighbour];
      vertex += weights[neighbour] * virtual_point;
      total += weights[neighbour];
    }
    sum += total < kNoWeight ? feet[leg] : Vec2(vertex / total);
  }
  return sum / static_cast<double>(kLegCount);
}

void CentreOfMassPlanner::reset() noexcept { *this = CentreOfMassPlanner(config_); }

ComTarget CentreOfMassPlanner::update(const ComPlannerInput& in, double dt) noexcept {
  ComTarget target;
  for (const Leg leg : kLegs) {
    update_vertex(in, leg, dt);
    target.weight[leg] = vertices_[leg].weight();
  }
  target.plan = config_.planner == ComPlanner::kPsp ? psp_plan(in, dt) : linear_plan(in);
  started_ = true;
  return target;
}

void CentreOfMassPlanner::update_vertex(const ComPlannerInput& in, Leg leg, double dt) noexcept {
  Vertex& vertex = vertices_[leg];
  const LegPhase& phase = in.gait.leg[leg];
  const bool lifts_off = vertex.scheduled_stance && !phase.stance;
  const bool may_land = phase.stance || phase.progress >= kEarliestLanding;
  const bool lands = in.touching[leg] && may_land;
  const bool supporting = started_ ? (vertex.supporting && !lifts_off) || lands : phase.stance;

  const Vec3 nominal = nominal_vertex(in, leg, supporting);
  if (started_ && supporting != vertex.supporting) {
    vertex.jump = vertex.faded() - nominal;
    vertex.fade = 1.0;
  } else {
    vertex.fade = std::max(0.0, vertex.fade - dt / kFadeTime);
  }
  vertex.nominal = nominal;
  vertex.supporting = supporting;
  vertex.scheduled_stance = phase.stance;
}

Vec3 CentreOfMassPlanner::nominal_vertex(const ComPlannerInput& in, Leg leg,
                                         bool supporting) const noexcept {
  const LegPhase& phase = in.gait.leg[leg];
  const double duty = in.gait.stance_duration / (in.gait.stance_duration + in.gait.swing_duration);
  // A foot that lands early, or is late, waits at the switch, where the bump is 0.
  const bool on_schedule = supporting == phase.stance;
  const double bump = on_schedule ? psp_bump(config_.weight, config_.width, phase.progress) : 0.0;
  const double weight = psp_weight(phase.stance, bump, duty, config_.swing_weight_min);

  Vec2 p_W;
  if (supporting) {
    p_W = in.contact[leg];
  } else if (phase.stance) {
    p_W = vertices_[leg].nominal.tail<2>();
  } else {
    p_W =
        in.lift_off[leg] + smooth_step(phase.progress) * (in.next_foothold[leg] - in.lift_off[leg]);
  }
  return {weight, p_W.x(), p_W.y()};
}

std::optional<Vec2> CentreOfMassPlanner::polygon_target() const noexcept {
  PerLeg<Vec2> points;
  PerLeg<double> weights;
  for (const Leg leg : kLegs) {
    points[leg] = vertices_[leg].p_W();
    weights[leg] = vertices_[leg].weight();
  }
  return weighted_centroid(points, weights);
}

std::optional<Vec2> CentreOfMassPlanner::diagonal_target(const ComPlannerInput& in) const noexcept {
  const bool first_swings = in_swing(in.gait, kFirstPair),
             second_swings = in_swing(in.gait, kSecondPair);
  if (first_swings && second_swings) return std::nullopt;
  const auto& swing_pair = first_swings ? kFirstPair : kSecondPair;
  const auto& stance_pair = first_swings ? kSecondPair : kFirstPair;

  double bump = 0.0;
  PerLeg<Vec2> feet;
  for (const Leg leg : kLegs) feet[leg] = vertices_[leg].p_W();
  if (first_swings || second_swings) {
    const double progress = in.gait.leg[swing_pair[0]].progress;
    bump = psp_bump(config_.weight, config_.width, progress);
    // In mid-swing the crossing has no weight, so the swing diagonal may change unseen.
    for (const Leg leg : swing_pair)
      feet[leg] = progress < 0.5 ? in.lift_off[leg] : in.next_foothold[leg];
  }
  return on_diagonal_target(feet[stance_pair[0]], feet[stance_pair[1]], feet[swing_pair[0]],
                            feet[swing_pair[1]], bump);
}

ComPlan CentreOfMassPlanner::psp_plan(const ComPlannerInput& in, double dt) noexcept {
  if (!started_) offset_ = in.com - in.reference;
  std::optional<Vec2> target = config_.on_diagonal ? diagonal_target(in) : std::nullopt;
  if (!target) target = polygon_target();
  const Vec2 wanted = target ? Vec2(config_.gain * (*target - in.reference)) : offset_;
  offset_ += clamp_norm(Vec2(wanted - offset_), config_.max_speed * dt);

  return {.p_WG = in.reference + offset_};
}

ComPlan CentreOfMassPlanner::linear_plan(const ComPlannerInput& in) const noexcept {
  const double period = in.gait.stance_duration + in.gait.swing_duration;
  const Vec2 step = clamp_norm(Vec2(in.reference - in.com), config_.max_speed * period);
  return {.p_WG = in.com + step};
}

}  // namespace pirouette
