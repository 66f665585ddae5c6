#include "pirouette/controller/gyro_watch.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

constexpr double kDt = 0.002;  ///< s

class GyroWatchTest : public testing::Test {
 protected:
  GyroWatch watch;
  PerLeg<FootState> feet;
  FootContacts contacts;
  PerLeg<bool> encoder_stuck{};

  GyroWatchTest() {
    for (const Leg leg : kLegs) {
      feet[leg].p_BF = Vec3(0.2 * fore_sign(leg), 0.15 * side_sign(leg), -0.28);
      contacts[leg].in_contact = contacts[leg].measured = true;
    }
  }

  /// Whether they agree to the end of `duration` (s) on a trunk that turns at `w` and moves at `v`.
  bool agree(double w, const Vec3& v, double gyro, double duration) {
    bool agree = true;
    for (const Leg leg : kLegs) feet[leg].v_BF_B = -v - Vec3(0.0, 0.0, w).cross(feet[leg].p_BF);
    for (double t = 0.0; t < duration; t += kDt) {
      agree = watch.update(Vec3(0.0, 0.0, gyro), feet, contacts, encoder_stuck, kDt);
    }
    return agree;
  }
};

TEST_F(GyroWatchTest, AgreesInEveryMotionWithARightGyro) {
  for (const double w : {0.0, 0.7, -4.0, 10.0}) {
    EXPECT_TRUE(agree(w, Vec3(0.5, -0.2, 0.0), w, 2.0));
    EXPECT_TRUE(agree(w, Vec3::Zero(), 0.95 * w + 0.1, 2.0));
  }
}

TEST_F(GyroWatchTest, SeesAWrongSignAWrongUnitAndOneThatIsStuck) {
  EXPECT_FALSE(agree(0.7, Vec3::Zero(), -0.7, 1.0));
  watch.reset();
  EXPECT_FALSE(agree(0.7, Vec3::Zero(), 40.0, 0.1));
  watch.reset();
  EXPECT_FALSE(agree(3.0, Vec3::Zero(), 0.0, 1.0));
}

TEST_F(GyroWatchTest, ForgivesAPush) {
  EXPECT_TRUE(agree(0.7, Vec3::Zero(), 0.7, 1.0));
  EXPECT_TRUE(agree(3.0, Vec3::Zero(), 0.7, 0.1)) << "feet that slip";
  EXPECT_TRUE(agree(0.7, Vec3::Zero(), 0.7, 1.0));
}

TEST_F(GyroWatchTest, LeavesOutFeetInTheAirAndStuckEncoders) {
  contacts[Leg::kFR].in_contact = contacts[Leg::kRL].in_contact = false;
  EXPECT_TRUE(agree(0.7, Vec3::Zero(), 0.7, 1.0));
  feet[Leg::kFR].v_BF_B = Vec3(5.0, 5.0, 0.0);
  EXPECT_TRUE(watch.update(Vec3(0.0, 0.0, 0.7), feet, contacts, encoder_stuck, kDt));
  encoder_stuck[Leg::kFL] = true;  // one foot is left: no opinion
  EXPECT_TRUE(agree(0.7, Vec3::Zero(), -9.0, 1.0));
}

}  // namespace
}  // namespace pirouette
