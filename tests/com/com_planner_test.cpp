#include "pirouette/com/com_planner.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "pirouette/base/rotation.hpp"
#include "support/vectors.hpp"

namespace pirouette {
namespace {

using test::distance;
using test::to_vec2;

constexpr std::array<PspWeight, 4> kFamilies = {PspWeight::kGaussian, PspWeight::kGeometric,
                                                PspWeight::kPoisson, PspWeight::kPolynomial};

struct Shape {
  PspWeight family;
  double width;
};

/// The family and ComConfig::width that a "shape" and "param" of the vectors stand for.
Shape to_shape(const nlohmann::json& c) {
  const std::string shape = c.at("shape");
  if (shape == "poly") return {PspWeight::kPolynomial, 0.25};
  const double param = c.at("param");
  if (shape == "gauss") return {PspWeight::kGaussian, param};
  if (shape == "poisson") return {PspWeight::kPoisson, 0.25 / std::sqrt(param / 4.0)};
  return {PspWeight::kGeometric, 0.25 * std::log(0.05) / std::log(param)};
}

TEST(PspWeight, MatchesScipyDensities) {
  const auto& section = test::vectors("psp_weights");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    const Shape shape = to_shape(c);
    const double bump = psp_bump(shape.family, shape.width, c.at("phase"));
    EXPECT_NEAR(bump, c.at("bump").get<double>(), tol);
    EXPECT_NEAR(psp_weight(true, bump, c.at("duty"), c.at("w_min")), c.at("w_stance").get<double>(),
                tol);
    EXPECT_NEAR(psp_weight(false, bump, c.at("duty"), c.at("w_min")), c.at("w_swing").get<double>(),
                tol);
  }
}

TEST(PspWeight, BumpRisesFromZeroToOneAndIsSymmetric) {
  for (const PspWeight family : kFamilies) {
    for (const double width : {0.1, 0.25, 0.5, 2.0}) {
      EXPECT_NEAR(psp_bump(family, width, 0.0), 0.0, 1e-15);
      EXPECT_NEAR(psp_bump(family, width, 0.5), 1.0, 1e-15);
      for (double f = 0.0; f < 0.5; f += 0.01) {
        EXPECT_LE(psp_bump(family, width, f), psp_bump(family, width, f + 0.01) + 1e-12);
        EXPECT_NEAR(psp_bump(family, width, f), psp_bump(family, width, 1.0 - f), 1e-12);
      }
      EXPECT_EQ(psp_bump(family, width, -1.0), psp_bump(family, width, 0.0));
      EXPECT_EQ(psp_bump(family, width, 2.0), psp_bump(family, width, 1.0));
    }
  }
}

TEST(PspWeight, IsSmoothInTimeAcrossASwitch) {
  constexpr double kDuty = 0.6, kLeast = 0.1, kStep = 1e-6;
  for (const PspWeight family : kFamilies) {
    const auto weight = [&](bool stance, double f) {
      return psp_weight(stance, psp_bump(family, 0.25, f), kDuty, kLeast);
    };
    EXPECT_NEAR(weight(true, 1.0), weight(false, 0.0), 1e-15);
    const double before = (weight(true, 1.0) - weight(true, 1.0 - kStep)) / (kStep * kDuty);
    const double after = (weight(false, kStep) - weight(false, 0.0)) / (kStep * (1.0 - kDuty));
    EXPECT_NEAR(before, after, 1e-4 * (1.0 + std::abs(before)));
  }
}

TEST(PspTarget, IsTheWeightedMeanOfTheFeet) {
  const auto& section = test::vectors("psp_com");
  for (const auto& c : section.at("cases")) {
    PerLeg<Vec2> feet;
    PerLeg<double> weights;
    for (const Leg leg : kLegs) {
      feet[leg] = to_vec2(c.at("P")[index(leg)]);
      weights[leg] = c.at("w")[index(leg)];
    }
    const std::optional<Vec2> target = weighted_centroid(feet, weights);
    ASSERT_EQ(target.has_value(), c.at("com") != "hold");
    if (target) {
      EXPECT_LT(distance(*target, to_vec2(c.at("com"))), section.at("tol").get<double>());
    }
  }
}

TEST(PspTarget, AncestorMatchesItsPublishedFormula) {
  constexpr std::array<Leg, 4> kAround = {Leg::kFR, Leg::kFL, Leg::kRL, Leg::kRR};
  const auto& section = test::vectors("psp_bledt2018");
  const double tol = section.at("tol");
  for (const auto& c : section.at("cases")) {
    PerLeg<Vec2> feet;
    PerLeg<double> weights;
    for (std::size_t i = 0; i < kLegCount; ++i) {
      feet[kAround[i]] = to_vec2(c.at("P")[i]);
      weights[kAround[i]] = bledt2018_weight(c.at("stance")[i], c.at("phase")[i], c.at("sigma"));
      EXPECT_NEAR(weights[kAround[i]], c.at("Phi")[i].get<double>(), tol);
    }
    EXPECT_LT(distance(bledt2018_target(feet, weights), to_vec2(c.at("com"))), tol);
  }
}

TEST(OnDiagonalTarget, MovesFromTheCrossingToTheMidpointOnTheStanceLine) {
  const Vec2 a(0.2, -0.1), b(-0.2, 0.1), c(0.25, 0.1), d(-0.15, -0.1);
  const std::optional<Vec2> crossing = on_diagonal_target(a, b, c, d, 0.0);
  ASSERT_TRUE(crossing);
  EXPECT_LT(distance(*crossing, *on_diagonal_target(c, d, a, b, 0.0)), 1e-15);
  EXPECT_LT(distance(*on_diagonal_target(a, b, c, d, 1.0), Vec2(0.5 * (a + b))), 1e-15);
}

TEST(OnDiagonalTarget, IsAbsentForAlmostParallelOrUncrossedDiagonals) {
  const Vec2 a(0.2, 0.0), b(-0.2, 0.0);
  EXPECT_FALSE(on_diagonal_target(a, b, {0.2, 0.05}, {-0.2, -0.05}, 0.5));
  EXPECT_FALSE(on_diagonal_target(a, b, {0.3, 0.1}, {0.3, -0.1}, 0.5));
  EXPECT_FALSE(on_diagonal_target(a, a, {0.3, 0.1}, {0.3, -0.1}, 0.5));
}

// An open-loop trot whose feet land at given points; the body does not matter to the planner.
class Trot {
 public:
  Trot(double period, double duty, double scatter, unsigned seed = 3)
      : period_(period), duty_(duty), generator_(seed), scatter_(scatter) {}

  double spin_rate = 0.0;  ///< rad/s about the origin
  double late = 0.0;       ///< s that FR touches down after the schedule; negative: early

  ComPlannerInput at(double time) {
    ComPlannerInput in;
    in.gait.walking = true;
    in.gait.stance_duration = duty_ * period_;
    in.gait.swing_duration = (1.0 - duty_) * period_;
    for (const Leg leg : kLegs) fill(in, leg, time);
    return in;
  }

 private:
  void fill(ComPlannerInput& in, Leg leg, double time) {
    const bool first_pair = leg == Leg::kFR || leg == Leg::kRL;
    const double strides = time / period_ + (first_pair ? 0.0 : 0.5) + 1e-9;
    const int stride = static_cast<int>(std::floor(strides));
    const double cycle = strides - stride;
    LegPhase& phase = in.gait.leg[leg];
    phase.stance = cycle < duty_;
    phase.progress = phase.stance ? cycle / duty_ : (cycle - duty_) / (1.0 - duty_);
    in.contact[leg] = foothold(leg, stride);
    in.lift_off[leg] = foothold(leg, stride);
    in.next_foothold[leg] = foothold(leg, stride + 1);
    in.touching[leg] = phase.stance;
    if (leg == Leg::kFR && stride > 0) {
      const double since_touchdown = cycle * period_;
      if (phase.stance && since_touchdown < late) in.touching[leg] = false;
      if (!phase.stance && (1.0 - cycle) * period_ < -late) {
        in.touching[leg] = true;
        in.contact[leg] = foothold(leg, stride + 1);
      }
    }
  }

  // Aimed for the middle of its stance, plus scatter.
  Vec2 foothold(Leg leg, int stride) {
    auto [entry, is_new] = footholds_.try_emplace({index(leg), stride});
    if (is_new) {
      const bool first_pair = leg == Leg::kFR || leg == Leg::kRL;
      const double mid_stance = period_ * (stride - (first_pair ? 0.0 : 0.5) + 0.5 * duty_);
      const Vec2 nominal(fore_sign(leg) * 0.19, side_sign(leg) * 0.111);
      entry->second = rot2(spin_rate * mid_stance) * nominal +
                      scatter_ * Vec2(noise_(generator_), noise_(generator_));
    }
    return entry->second;
  }

  double period_, duty_;
  std::mt19937 generator_;
  std::normal_distribution<double> noise_;
  double scatter_;
  std::map<std::pair<std::size_t, int>, Vec2> footholds_;
};

constexpr double kDt = 0.00025;

ComConfig unlimited() {
  ComConfig config;
  config.max_speed = 1e3;
  config.gain = 1.0;
  config.swing_weight_min = 0.0;
  return config;
}

TEST(CentreOfMassPlanner, TargetOfAnIdealSpinIsItsCentreForEveryWeight) {
  for (const PspWeight family : kFamilies) {
    for (const bool on_diagonal : {false, true}) {
      ComConfig config = unlimited();
      config.weight = family;
      config.on_diagonal = on_diagonal;
      CentreOfMassPlanner planner(config);
      Trot trot(0.5, 0.5, 0.0);
      trot.spin_rate = 0.7;
      for (double t = 0.0; t < 1.0; t += 0.002) {
        EXPECT_LT(planner.update(trot.at(t), 0.002).plan.p_WG.norm(), 1e-14);
      }
    }
  }
}

TEST(CentreOfMassPlanner, TargetIsContinuousOverSwitchesWithScatteredFootholds) {
  for (const double duty : {0.5, 0.6}) {
    for (const bool on_diagonal : {false, true}) {
      ComConfig config = unlimited();
      config.on_diagonal = on_diagonal;
      CentreOfMassPlanner planner(config);
      Trot trot(0.5, duty, 0.01);
      Vec2 previous = planner.update(trot.at(0.0), kDt).plan.p_WG;
      double worst = 0.0;
      for (int i = 1; i < 16000; ++i) {
        const Vec2 target = planner.update(trot.at(i * kDt), kDt).plan.p_WG;
        worst = std::max(worst, (target - previous).norm());
        previous = target;
      }
      EXPECT_LT(worst, 2e-4);  // m per 0.25 ms; a jump would be of the size of the scatter, 1e-2
    }
  }
}

TEST(CentreOfMassPlanner, OnDiagonalTargetStaysOnTheSupportLine) {
  ComConfig config = unlimited();
  config.on_diagonal = true;
  CentreOfMassPlanner planner(config);
  Trot trot(0.5, 0.5, 0.01);
  for (int i = 0; i < 16000; ++i) {
    const ComPlannerInput in = trot.at(i * kDt);
    const Vec2 target = planner.update(in, kDt).plan.p_WG;
    if (i < 200) continue;  // the planner starts at the CoM and lets its first step fade
    const bool first_pair = in.gait.leg[Leg::kFR].stance;
    const Vec2 a = in.contact[first_pair ? Leg::kFR : Leg::kFL];
    const Vec2 b = in.contact[first_pair ? Leg::kRL : Leg::kRR];
    const Vec2 line = (b - a).normalized();
    // 1e-9: the gait below rounds its phase by as much, and the planner fades that step out.
    ASSERT_LT(std::abs(line.x() * (target - a).y() - line.y() * (target - a).x()), 1e-9);
  }
}

TEST(CentreOfMassPlanner, EarlyAndLateContactsDoNotMakeTheTargetJump) {
  for (const double late : {0.04, -0.04}) {
    CentreOfMassPlanner planner(unlimited());
    Trot trot(0.5, 0.6, 0.01);
    trot.late = late;
    Vec2 previous = planner.update(trot.at(0.0), kDt).plan.p_WG;
    for (int i = 1; i < 8000; ++i) {
      const ComTarget target = planner.update(trot.at(i * kDt), kDt);
      EXPECT_LT((target.plan.p_WG - previous).norm(), 4e-4);
      previous = target.plan.p_WG;
      for (const double weight : target.weight) {
        EXPECT_GE(weight, 0.0);
        EXPECT_LE(weight, 1.0);
      }
    }
  }
}

TEST(CentreOfMassPlanner, ALateFootWaitsAtTheWeightOfTheSwitch) {
  CentreOfMassPlanner planner(unlimited());
  Trot trot(0.5, 0.6, 0.0);
  trot.late = 0.05;
  for (double t = 0.0; t < 0.52; t += kDt) planner.update(trot.at(t), kDt);
  const ComTarget target = planner.update(trot.at(0.52), kDt);
  EXPECT_NEAR(target.weight[Leg::kFR], 1.0 - 0.6, 1e-12);
  EXPECT_GT(target.weight[Leg::kRL], 1.0 - 0.6);
}

TEST(CentreOfMassPlanner, FourStandingFeetCountEqually) {
  CentreOfMassPlanner planner(unlimited());
  Trot trot(0.5, 0.6, 0.01);
  ComPlannerInput in = trot.at(0.0);
  Vec2 centroid = Vec2::Zero();
  for (const Leg leg : kLegs) {
    in.gait.leg[leg] = {.stance = true, .progress = 0.5};
    in.touching[leg] = true;
    centroid += 0.25 * in.contact[leg];
  }
  EXPECT_LT(distance(planner.update(in, kDt).plan.p_WG, centroid), 1e-15);
}

TEST(CentreOfMassPlanner, OffsetFromTheReferenceObeysGainAndSpeedLimit) {
  ComConfig config;
  config.max_speed = 0.2;
  config.gain = 0.5;
  CentreOfMassPlanner planner(config);
  Trot trot(0.5, 0.5, 0.0);
  ComPlannerInput in = trot.at(0.0);
  in.reference = in.com = Vec2(0.06, 0.0);  // 6 cm ahead of the middle of the feet
  EXPECT_LT(distance(planner.update(in, 0.002).plan.p_WG, Vec2(0.06 - 0.2 * 0.002, 0.0)), 1e-12);
  ComTarget target;
  for (int i = 0; i < 500; ++i) target = planner.update(in, 0.002);
  EXPECT_LT(distance(target.plan.p_WG, Vec2(0.03, 0.0)), 1e-12);
}

TEST(CentreOfMassPlanner, AMovingReferenceIsNotHeldBackByTheSpeedLimit) {
  ComConfig config;
  config.gain = 0.0;
  CentreOfMassPlanner planner(config);
  Trot trot(0.5, 0.5, 0.0);
  ComTarget target;
  for (int i = 0; i < 1000; ++i) {
    ComPlannerInput in = trot.at(i * 0.002);
    in.reference = in.com = Vec2(0.001 * i, 0.0);  // 0.5 m/s
    target = planner.update(in, 0.002);
    EXPECT_LT(distance(target.plan.p_WG, in.reference), 1e-12);
  }
}

TEST(CentreOfMassPlanner, LinearPlanLeadsStraightToTheReference) {
  ComConfig config;
  config.planner = ComPlanner::kLinear;
  config.max_speed = 0.2;
  CentreOfMassPlanner planner(config);
  Trot trot(0.5, 0.5, 0.01);
  ComPlannerInput in = trot.at(0.1);
  in.com = {0.3, 0.4};
  const ComPlan far = planner.update(in, 0.002).plan;
  EXPECT_LT(distance(far.p_WG, Vec2(in.com - 0.1 * in.com.normalized())), 1e-12);
  in.com = {0.03, 0.04};
  EXPECT_LT(distance(planner.update(in, 0.002).plan.p_WG, in.reference), 1e-15);
}

TEST(CentreOfMassPlanner, TurningTheWorldTurnsTheTarget) {
  const Mat2 turn = rot2(0.8);
  CentreOfMassPlanner planner{ComConfig{}}, turned_planner{ComConfig{}};
  Trot trot(0.5, 0.6, 0.01);
  for (int i = 0; i < 500; ++i) {
    ComPlannerInput in = trot.at(i * 0.002);
    const Vec2 target = planner.update(in, 0.002).plan.p_WG;
    for (const Leg leg : kLegs) {
      for (Vec2* point : {&in.contact[leg], &in.lift_off[leg], &in.next_foothold[leg]})
        *point = turn * *point;
    }
    EXPECT_LT(distance(turned_planner.update(in, 0.002).plan.p_WG, turn * target), 1e-14);
  }
}

}  // namespace
}  // namespace pirouette
