#include "pirouette/gait/gait_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace pirouette {
namespace {

constexpr double kDt = 0.002;  // s, 500 Hz

GaitConfig timing(double period, double duty) {
  GaitConfig config;
  config.period = period;
  config.duty = duty;
  return config;
}

int feet_down(const GaitPhase& phase) {
  int count = 0;
  for (const LegPhase& leg : phase.leg) count += leg.stance;
  return count;
}

std::string stance_pattern(const GaitPhase& phase) {
  std::string pattern;
  for (const LegPhase& leg : phase.leg) pattern += leg.stance ? '1' : '0';
  return pattern;
}

void expect_same(const LegPhase& a, const LegPhase& b, double tolerance) {
  EXPECT_EQ(a.stance, b.stance);
  EXPECT_NEAR(a.progress, b.progress, tolerance);
  EXPECT_NEAR(a.duration, b.duration, tolerance);
  if (std::isinf(a.time_remaining)) {
    EXPECT_EQ(a.time_remaining, b.time_remaining);
  } else {
    EXPECT_NEAR(a.time_remaining, b.time_remaining, tolerance);
  }
  EXPECT_EQ(a.stride, b.stride);
}

class AnyTrot : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Duties, AnyTrot, ::testing::Values(0.4, 0.5, 0.6, 0.75));

TEST(GaitClock, StandsOnFourFeetUntilToldToWalk) {
  GaitClock clock(timing(0.5, 0.6));
  for (int i = 0; i < 10; ++i) {
    const GaitPhase phase = clock.update(false, kDt);
    EXPECT_FALSE(phase.walking);
    EXPECT_EQ(feet_down(phase), 4);
    EXPECT_TRUE(std::isinf(phase.leg[Leg::kFR].time_remaining));
  }
}

TEST_P(AnyTrot, NoFootIsCaughtInMidSwingAtTheStart) {
  GaitClock clock(timing(0.5, GetParam()));
  GaitPhase before = clock.update(false, kDt);
  for (int i = 0; i < 500; ++i) {
    const GaitPhase phase = clock.update(true, kDt);
    for (const Leg leg : kLegs) {
      if (before.leg[leg].stance && !phase.leg[leg].stance) {
        EXPECT_LE(phase.leg[leg].progress * phase.swing_duration, kDt);
      }
    }
    before = phase;
  }
}

TEST_P(AnyTrot, DiagonalFeetMoveTogetherAndPairsAreHalfAStrideApart) {
  GaitClock clock(timing(0.5, GetParam()));
  for (int i = 0; i < 250; ++i) clock.update(true, kDt);
  for (int i = 0; i < 250; ++i) {
    const GaitPhase phase = clock.update(true, kDt);
    expect_same(phase.leg[Leg::kFR], phase.leg[Leg::kRL], 0.0);
    expect_same(phase.leg[Leg::kFL], phase.leg[Leg::kRR], 0.0);
    const LegPhase later = clock.phase_at(Leg::kFR, 0.25);
    EXPECT_EQ(later.stance, phase.leg[Leg::kFL].stance);
    EXPECT_NEAR(later.progress, phase.leg[Leg::kFL].progress, 1e-12);
  }
}

TEST_P(AnyTrot, EachFootIsDownForItsShareOfTheStride) {
  GaitClock clock(timing(0.5, GetParam()));
  for (int i = 0; i < 250; ++i) clock.update(true, kDt);
  PerLeg<int> down{};
  for (int i = 0; i < 250; ++i) {
    const GaitPhase phase = clock.update(true, kDt);
    for (const Leg leg : kLegs) down[leg] += phase.leg[leg].stance;
  }
  for (const Leg leg : kLegs) EXPECT_NEAR(down[leg], 250 * GetParam(), 1.0);
}

TEST_P(AnyTrot, LookingAheadSeesWhatComes) {
  GaitClock clock(timing(0.5, GetParam()));
  for (const int warm_up : {1, 40, 130, 300}) {
    clock.reset();
    for (int i = 0; i < warm_up; ++i) clock.update(true, kDt);
    const GaitClock then = clock;
    for (int ahead = 1; ahead < 1000; ++ahead) {
      const GaitPhase phase = clock.update(true, kDt);
      for (const Leg leg : kLegs)
        expect_same(then.phase_at(leg, ahead * kDt), phase.leg[leg], 1e-9);
    }
  }
}

TEST_P(AnyTrot, StoppingLandsTheFeetInTheAirAndLiftsNoOther) {
  for (int stop_at = 1; stop_at < 260; stop_at += 7) {
    GaitClock clock(timing(0.5, GetParam()));
    GaitPhase before;
    for (int i = 0; i < stop_at; ++i) before = clock.update(true, kDt);
    for (int i = 0; i < 250; ++i) {
      const GaitPhase phase = clock.update(false, kDt);
      for (const Leg leg : kLegs) {
        EXPECT_TRUE(phase.leg[leg].stance || !before.leg[leg].stance);
        if (!before.leg[leg].stance && phase.leg[leg].stance) {
          EXPECT_NEAR(before.leg[leg].time_remaining, kDt, 1e-9);
        }
      }
      before = phase;
    }
    EXPECT_FALSE(before.walking);
    EXPECT_EQ(feet_down(before), 4);
  }
}

TEST_P(AnyTrot, LookingAheadWhileStoppingSeesTheRest) {
  GaitClock clock(timing(0.5, GetParam()));
  for (int i = 0; i < 100; ++i) clock.update(true, kDt);
  clock.update(false, kDt);
  const GaitClock then = clock;
  for (int ahead = 1; ahead < 300; ++ahead) {
    const GaitPhase phase = clock.update(false, kDt);
    for (const Leg leg : kLegs)
      EXPECT_EQ(then.phase_at(leg, ahead * kDt).stance, phase.leg[leg].stance);
  }
}

TEST(GaitClock, WalkingAgainBeforeStandingLiftsNoFootLate) {
  GaitClock clock(timing(0.5, 0.6));
  for (int i = 0; i < 100; ++i) clock.update(true, kDt);
  for (int i = 0; i < 20; ++i) clock.update(false, kDt);
  GaitPhase before = clock.update(true, kDt);
  EXPECT_TRUE(before.walking);
  for (int i = 0; i < 500; ++i) {
    const GaitPhase phase = clock.update(true, kDt);
    for (const Leg leg : kLegs) {
      if (before.leg[leg].stance && !phase.leg[leg].stance) {
        EXPECT_LE(phase.leg[leg].progress * phase.swing_duration, kDt);
      }
    }
    before = phase;
  }
  EXPECT_LT(feet_down(before), 4);
}

TEST(GaitClock, DutyAboveHalfStartsOnFourFeet) {
  GaitClock clock(timing(0.5, 0.6));
  const GaitPhase start = clock.update(true, kDt);
  EXPECT_TRUE(start.walking);
  EXPECT_EQ(feet_down(start), 4);
  EXPECT_NEAR(start.leg[Leg::kFL].time_remaining, 0.05, 1e-12);
}

TEST(GaitClock, DutyBelowHalfFlies) {
  GaitClock clock(timing(0.5, 0.4));
  int flight = 0;
  for (int i = 0; i < 500; ++i) flight += feet_down(clock.update(true, kDt)) == 0;
  EXPECT_GT(flight, 50);
}

TEST(GaitClock, StridesAreCountedAtLiftOff) {
  GaitClock clock(timing(0.5, 0.6));
  GaitPhase phase;
  for (int i = 0; i < 1 + 10 * 250; ++i) phase = clock.update(true, kDt);
  for (const Leg leg : kLegs) EXPECT_EQ(phase.leg[leg].stride, 10);
}

TEST(GaitClock, PatternRepeatsToTheTickForHours) {
  GaitClock clock(timing(0.5, 0.6));
  std::string first;
  for (int i = 0; i < 250; ++i) first += stance_pattern(clock.update(true, kDt));
  std::string stride;
  for (int n = 1; n < 20000; ++n) {  // 2.8 h
    stride.clear();
    for (int i = 0; i < 250; ++i) stride += stance_pattern(clock.update(true, kDt));
    ASSERT_EQ(stride, first) << "stride " << n;
  }
  EXPECT_NEAR(clock.update(true, kDt).cycle, 0.0, 1e-12);
}

TEST(GaitClock, KeepsTimeWhenTheTickDoesNotDivideTheStride) {
  GaitClock clock(timing(0.333, 0.6));
  GaitPhase phase;
  const int ticks = 500 * 3600;
  for (int i = 0; i <= ticks; ++i) phase = clock.update(true, kDt);
  const double strides = ticks * kDt / 0.333;
  EXPECT_NEAR(phase.cycle, strides - std::floor(strides), 1e-6);
}

TEST(GaitClock, NewTimingCatchesNoFootInTheAir) {
  for (const double duty : {0.4, 0.5, 0.75}) {
    GaitClock clock(timing(0.5, 0.6));
    GaitPhase before;
    for (int i = 0; i < 100; ++i) before = clock.update(true, kDt);
    clock.set_timing(0.3, duty);
    for (int i = 0; i < 1000; ++i) {
      const GaitPhase phase = clock.update(true, kDt);
      for (const Leg leg : kLegs) {
        const LegPhase& was = before.leg[leg];
        const LegPhase& is = phase.leg[leg];
        if (was.stance && !is.stance) {
          EXPECT_LE(is.progress * is.duration, kDt + 1e-9);
        }
        if (!was.stance && is.stance) {
          EXPECT_LE(was.time_remaining, kDt + 1e-9);
        }
      }
      before = phase;
    }
    EXPECT_NEAR(before.stance_duration, 0.3 * duty, 1e-12);
    EXPECT_NEAR(before.swing_duration, 0.3 * (1.0 - duty), 1e-12);
  }
}

TEST(GaitClock, HurriesInTheMiddleOfTheStrideWithoutAJumpOfThePhase) {
  GaitClock clock(timing(0.5, 0.6));
  GaitPhase before;
  for (int i = 0; i < 180; ++i) before = clock.update(true, kDt);
  clock.set_timing(0.25, 0.6);
  clock.hurry();
  const GaitPhase phase = clock.update(true, kDt);
  EXPECT_NEAR(phase.cycle, before.cycle + kDt / 0.25, 1e-12);
  for (const Leg leg : kLegs) {
    EXPECT_EQ(phase.leg[leg].stance, before.leg[leg].stance);
    const double left = 0.5 * before.leg[leg].time_remaining - kDt;
    EXPECT_NEAR(phase.leg[leg].time_remaining, left, 1e-12);
  }
  clock.set_timing(0.5, 0.6);
  clock.hurry();  // only ever shortens
  EXPECT_NEAR(clock.update(true, kDt).cycle, phase.cycle + kDt / 0.25, 1e-12);
}

}  // namespace
}  // namespace pirouette
