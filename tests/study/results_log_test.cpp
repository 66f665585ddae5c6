// Lines of results.jsonl: read back as they were written, or told with what is wrong.
#include "pirouette/study/results_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pirouette/base/fingerprint.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

/// A trial without a fall; the metric number i, of 1/3 + i.
ResultsLine line_of(const std::string& key, double radius = 1.5) {
  ResultsLine line{"tiny", "a \"row\"", key, {}};
  double value = 1.0 / 3.0;
  for (const std::string& name : metric_names()) line.values[name] = value += 1.0;
  line.values["fell"] = 0.0;
  line.values["interrupted"] = 0.0;
  line.values["fall_time_s"] = std::nullopt;
  line.values["com.radius_mean_mm"] = radius;
  return line;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

/// The line with another text in place of `from`, and the checksum of that.
std::string forged(const std::string& from, const std::string& to) {
  std::string text = to_text(line_of("0123456789abcdef"));
  text = replaced(text.substr(0, text.rfind(",\"check\"")) + "}", from, to);
  Fingerprint check;
  check.add(text);
  text.pop_back();
  return text + ",\"check\":\"" + check.hex() + "\"}";
}

std::string why_wrong(const std::string& text) {
  const Result<ResultsLine> line = parse_results_line(text);
  return line ? "good" : line.errors().front().to_string();
}

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

TEST(ResultsLines, ReadBackAsTheyWere) {
  const ResultsLine line = line_of("0123456789abcdef");
  const Result<ResultsLine> back = parse_results_line(to_text(line));
  ASSERT_TRUE(back) << back.errors().front().to_string();
  EXPECT_EQ(back.value().experiment, line.experiment);
  EXPECT_EQ(back.value().row, line.row);
  EXPECT_EQ(back.value().key, line.key);
  EXPECT_EQ(back.value().values, line.values);
}

TEST(ResultsLines, AreWrongWithAnyByteChanged) {
  const std::string text = to_text(line_of("0123456789abcdef"));
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string damaged = text;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_FALSE(parse_results_line(damaged)) << damaged;
    EXPECT_FALSE(parse_results_line(text.substr(0, i))) << text.substr(0, i);
  }
}

TEST(ResultsLines, SayWhatIsWrong) {
  const std::string text = to_text(line_of("0123456789abcdef"));
  EXPECT_EQ(why_wrong(text.substr(0, 60)), "is no whole line of JSON");
  EXPECT_EQ(why_wrong(replaced(text, "1.5", "-5")),
            "is damaged or edited: its checksum does not fit");
  EXPECT_EQ(why_wrong(R"({"trial":"0123456789abcdef","metrics":{"fell":0.0}})"),
            "has no checksum, as lines of older versions");
}

TEST(ResultsLines, AreWrongWithAValueThatCannotBe) {
  const std::string radius = "\"com.radius_mean_mm\":1.5";
  EXPECT_EQ(why_wrong(forged(radius, radius)), "good");
  EXPECT_EQ(why_wrong(forged(radius, "\"com.radius_mean_mm\":null")), "good");
  EXPECT_EQ(why_wrong(forged(radius, "\"com.radius_mean_mm\":-5")),
            "com.radius_mean_mm: given -5; allowed: a finite number from 0 on, or null");
  EXPECT_EQ(why_wrong(forged(radius, "\"com.radius_mean_mm\":\"1.5\"")),
            "com.radius_mean_mm: given \"1.5\"; allowed: a finite number from 0 on, or null");
  EXPECT_EQ(why_wrong(forged(radius, "\"com.radius_mean_mm\":NaN")), "is no JSON");
  EXPECT_EQ(why_wrong(forged(radius, "\"com.radius_mean_mm\":1e999")), "is no JSON");
  EXPECT_EQ(why_wrong(forged(radius, "\"com.radius\":1.5")), "com.radius_mean_mm: missing");
  EXPECT_EQ(why_wrong(forged(radius, radius + ",\"com.radius\":1.5")),
            "com.radius: no such metric");
  EXPECT_EQ(why_wrong(forged("\"fell\":0.0", "\"fell\":2")), "fell: given 2; allowed: 0 or 1");
  EXPECT_EQ(why_wrong(forged("\"fell\":0.0", "\"fell\":null")),
            "fell: given null; allowed: 0 or 1");
  EXPECT_EQ(why_wrong(forged("\"fell\":0.0", "\"fell\":1.0")),
            "fall_time_s: given null; allowed: a time with a fall, null without one");
  EXPECT_EQ(why_wrong(forged("\"tiny\"", "3")), "experiment: missing: a text");
  EXPECT_EQ(why_wrong(forged("\"row\"", "\"wor\"")), "row: missing: a text");
  EXPECT_EQ(why_wrong(forged("\"metrics\"", "\"numbers\"")),
            "metrics: missing: a number or null for each metric");
}

TEST(MetricRanges, LeaveWhatHasASignAlone) {
  EXPECT_TRUE(metric_range("yaw_rate_error").holds(-0.1));
  EXPECT_TRUE(metric_range("angle_error_deg").holds(-0.1));
  EXPECT_TRUE(metric_range("com.circle_centre_x_mm").holds(-1.0));
  EXPECT_TRUE(metric_range("attitude.pitch_mean").holds(-1.0));
  EXPECT_FALSE(metric_range("com.distance_to_point_p95_mm").holds(-1.0));
  EXPECT_FALSE(metric_range("attitude.relative_roll_variance").holds(-1e-9));
}

class ResultsLogs : public test::TempFolderTest {
 protected:
  void write(const std::string& name, const std::vector<std::string>& lines) const {
    std::ofstream file(folder_ / name);
    for (const std::string& line : lines) file << line << "\n";
  }

  /// "results.jsonl:2: why", in the order of files and lines.
  static std::vector<std::string> rejected(const ResultsLog& log) {
    std::vector<std::string> texts;
    for (Error error : log.rejected()) {
      error.file = fs::path(error.file).filename();
      texts.push_back(error.to_string());
    }
    std::sort(texts.begin(), texts.end());
    return texts;
  }
};

TEST_F(ResultsLogs, TakeBrokenLinesOutOfTheFile) {
  const std::string first = to_text(line_of("a")), second = to_text(line_of("b"));
  write("results.jsonl", {first, "", replaced(second, "1.5", "-5"), second});
  std::ofstream(folder_ / "results.jsonl", std::ios::app) << first.substr(0, 40);
  const std::vector<std::string> expected = {
      "results.jsonl:2: is no whole line of JSON",
      "results.jsonl:3: is damaged or edited: its checksum does not fit"};
  EXPECT_EQ(rejected(ResultsLog::read(folder_)), expected);
  {
    Result<ResultsLog> log = ResultsLog::open(folder_, {}, false);
    ASSERT_TRUE(log);
    std::vector<std::string> all = expected;
    all.emplace_back("results.jsonl:5: is cut off, as by a kill");
    EXPECT_EQ(rejected(log.value()), all);
    EXPECT_NE(log.value().find("b"), nullptr);
    EXPECT_FALSE(ResultsLog::open(folder_, {}, false)) << "the new file is not locked";
    EXPECT_FALSE(log.value().append(line_of("c")));
  }
  EXPECT_EQ(read(folder_ / "results.jsonl"),
            first + "\n" + second + "\n" + to_text(line_of("c")) + "\n");
  EXPECT_TRUE(ResultsLog::read(folder_).rejected().empty());
}

TEST_F(ResultsLogs, RejectOldLines) {
  write("results.jsonl", {R"({"trial":"a","metrics":{"fell":0.0}})"});
  const ResultsLog log = ResultsLog::read(folder_);
  EXPECT_EQ(log.find("a"), nullptr);
  EXPECT_EQ(rejected(log), std::vector<std::string>{
                               "results.jsonl:1: has no checksum, as lines of older versions"});
}

TEST_F(ResultsLogs, KeepOneOfEqualLinesAndNoneOfDifferentOnes) {
  const std::string line = to_text(line_of("a")), other = to_text(line_of("b"));
  write("results-1of2.jsonl", {line, other});
  write("results.jsonl", {line, to_text(line_of("b", 2.5)), other});
  const ResultsLog log = ResultsLog::read(folder_);
  EXPECT_NE(log.find("a"), nullptr);
  EXPECT_EQ(log.find("b"), nullptr);
  const std::string differs = " has other values than another line for the same trial, b";
  EXPECT_EQ(rejected(log),
            (std::vector<std::string>{"results-1of2.jsonl:2:" + differs,
                                      "results.jsonl:1: is the result at " +
                                          (folder_ / "results-1of2.jsonl").string() + ":1 again",
                                      "results.jsonl:2:" + differs, "results.jsonl:3:" + differs}));
  ASSERT_TRUE(ResultsLog::open(folder_, {}, false));
  EXPECT_EQ(read(folder_ / "results-1of2.jsonl"), line + "\n");
  EXPECT_EQ(read(folder_ / "results.jsonl"), "");
}

TEST_F(ResultsLogs, LeaveTheFileOfAnotherProcessAlone) {
  const std::string line = to_text(line_of("a"));
  const Result<ResultsLog> other = ResultsLog::open(folder_, Shard{1, 2}, false);
  ASSERT_TRUE(other);
  write("results-1of2.jsonl", {line, "broken"});
  const Result<ResultsLog> log = ResultsLog::open(folder_, {}, false);
  ASSERT_TRUE(log);
  EXPECT_EQ(log.value().rejected().size(), 1u);
  EXPECT_EQ(read(folder_ / "results-1of2.jsonl"), line + "\nbroken\n");
}

TEST_F(ResultsLogs, HoldATrialOnceThatRanTwiceForItsTrace) {
  Result<ResultsLog> log = ResultsLog::open(folder_, {}, false);
  ASSERT_TRUE(log);
  EXPECT_FALSE(log.value().append(line_of("a")));
  EXPECT_FALSE(log.value().append(line_of("a")));
  EXPECT_EQ(read(folder_ / "results.jsonl"), to_text(line_of("a")) + "\n");
}

}  // namespace
}  // namespace pirouette
