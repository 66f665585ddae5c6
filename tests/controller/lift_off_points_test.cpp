#include "pirouette/controller/lift_off_points.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

TEST(LiftOffPoints, KeepWhereAFootWasInItsFirstTickInTheAir) {
  LiftOffPoints points;
  PerLeg<Vec3> p_WF = PerLeg<Vec3>::filled(Vec3(0.1, 0.2, 0.3));
  points.start(p_WF);
  FootContacts contacts;
  contacts[Leg::kFR].in_contact = true;
  p_WF[Leg::kFR].x() = 1.0;
  EXPECT_EQ(points.update(contacts, p_WF)[Leg::kFR].x(), 0.1);  // has not left yet
  contacts[Leg::kFR].in_contact = false;
  for (const double x : {2.0, 3.0, 4.0}) {
    p_WF[Leg::kFR].x() = x;
    EXPECT_EQ(points.update(contacts, p_WF)[Leg::kFR].x(), 2.0);
  }
  p_WF[Leg::kRL].x() = 5.0;
  EXPECT_EQ(points.update(contacts, p_WF)[Leg::kRL].x(), 0.1);  // has never touched
}

}  // namespace
}  // namespace pirouette
