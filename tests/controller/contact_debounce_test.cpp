#include "pirouette/controller/contact_debounce.hpp"

#include <gtest/gtest.h>

namespace pirouette {
namespace {

TEST(ContactDebounce, ChangesWhenTheRawFlagHasDifferedLongEnough) {
  ContactDebounce flag(3);
  EXPECT_FALSE(flag.update(true));
  EXPECT_FALSE(flag.update(true));
  EXPECT_TRUE(flag.update(true));
  EXPECT_TRUE(flag.update(false));
  EXPECT_TRUE(flag.update(false));
  EXPECT_FALSE(flag.update(false));
}

TEST(ContactDebounce, CountsOnlyWhatIsInARow) {
  ContactDebounce flag(2);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(flag.update(i % 2 == 0)) << i;
}

TEST(ContactDebounce, OfOneTickIsTheRawFlag) {
  ContactDebounce flag(1);
  for (const bool raw : {true, true, false, true, false, false}) EXPECT_EQ(flag.update(raw), raw);
}

TEST(ContactDebounce, TakesAFlagThatIsSetAtOnce) {
  ContactDebounce flag(3);
  EXPECT_TRUE(flag.set(true));
  EXPECT_TRUE(flag.update(false));
  EXPECT_FALSE(flag.set(false));
  flag.set(true);
  flag.reset();
  EXPECT_FALSE(flag.update(true));
}

}  // namespace
}  // namespace pirouette
