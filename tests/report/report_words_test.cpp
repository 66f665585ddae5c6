// The texts of reports and what fills them.
#include "pirouette/report/report_words.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace pirouette {
namespace {

TEST(ReportWords, AreFilledByName) {
  EXPECT_EQ(fill("{a} of {b}, {a}", {{"b", "2"}, {"a", "1"}}), "1 of 2, 1");
  EXPECT_EQ(fill("nothing", {{"a", "1"}}), "nothing");
  EXPECT_EQ(fill("", {}), "");
}

TEST(ReportWords, ShowWhatNothingFills) { EXPECT_EQ(fill("{a} {b} {", {{"a", "1"}}), "1 {b} {"); }

TEST(ReportWords, AreNotFilledTwice) {
  EXPECT_EQ(fill("{a}{b}", {{"a", "{b}"}, {"b", "{a}"}}), "{b}{a}");
}

TEST(ReportWords, AreJoinedBySeparators) {
  EXPECT_EQ(joined_by("; ", std::vector<std::string>{"a", "", "c"}), "a; ; c");
  EXPECT_EQ(joined_by("; ", std::vector<std::string>{}), "");
}

}  // namespace
}  // namespace pirouette
