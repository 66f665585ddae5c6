#include "pirouette/controller/flag_trust.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace pirouette {
namespace {

constexpr double kDt = 0.002;    ///< s
constexpr double kPeriod = 0.5;  ///< s
constexpr double kDuty = 0.6;

class FlagTrustTest : public testing::Test {
 protected:
  FlagTrust trust;

  void stand(double duration, const std::function<bool(double)>& flag) {
    for (double t = 0.0; t < duration; t += kDt) trust.update(flag(t), LegPhase{}, false, kDt);
  }
  /// `flag` of the scheduled stance and the progress in it.
  void walk(double duration, const std::function<bool(bool, double)>& flag) {
    for (double t = 0.0; t < duration; t += kDt) {
      const double cycle = std::fmod(t / kPeriod, 1.0);
      LegPhase phase;
      phase.stance = cycle < kDuty;
      phase.progress = phase.stance ? cycle / kDuty : (cycle - kDuty) / (1.0 - kDuty);
      trust.update(flag(phase.stance, phase.progress), phase, true, kDt);
    }
  }
};

TEST_F(FlagTrustTest, BelievesAFlagThatFollowsTheSchedule) {
  stand(1.0, [](double) { return true; });
  walk(60.0, [](bool stance, double) { return stance; });
  EXPECT_TRUE(trust.believed());
}

TEST_F(FlagTrustTest, BelievesOneThatIsLateEarlyAndNowAndThenWrong) {
  int sample = 0;
  stand(1.0, [](double) { return true; });
  walk(60.0, [&](bool stance, double progress) {
    const bool wrong = ++sample % 5 == 0;
    return (stance ? progress > 0.2 : progress < 0.4 || progress > 0.9) != wrong;
  });
  EXPECT_TRUE(trust.believed());
}

TEST_F(FlagTrustTest, DropsOneThatIsFalseWhileStanding) {
  stand(0.5, [](double) { return false; });
  EXPECT_FALSE(trust.believed());
}

TEST_F(FlagTrustTest, WaitsWhileTheRobotSettles) {
  stand(0.5, [](double t) { return t > 0.1; });
  EXPECT_TRUE(trust.believed());
}

TEST_F(FlagTrustTest, DropsOneThatIsNeverTrueUnderALoadedLeg) {
  stand(0.5, [](double) { return true; });
  walk(4.0, [](bool, double) { return false; });
  EXPECT_FALSE(trust.believed());
}

TEST_F(FlagTrustTest, DropsOneThatIsTrueThroughSwings) {
  stand(0.5, [](double) { return true; });
  walk(6.0, [](bool, double) { return true; });
  EXPECT_FALSE(trust.believed());
}

TEST_F(FlagTrustTest, OneStrideInTheAirIsNoReason) {
  stand(0.5, [](double) { return true; });
  walk(0.5, [](bool, double) { return false; });
  walk(5.0, [](bool stance, double) { return stance; });
  EXPECT_TRUE(trust.believed());
}

TEST_F(FlagTrustTest, BelievesAgainOnlyAfterAReset) {
  stand(0.5, [](double) { return false; });
  stand(5.0, [](double) { return true; });
  EXPECT_FALSE(trust.believed());
  trust.reset();
  EXPECT_TRUE(trust.believed());
}

}  // namespace
}  // namespace pirouette
