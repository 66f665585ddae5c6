// Reports of random experiments, of results that are made up.
#include "pirouette/report/survival_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "pirouette/config/toml.hpp"
#include "pirouette/report/trial_table.hpp"
#include "pirouette/study/repeat_command.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

constexpr const char* kFile = R"(trials = 40
max_falls = 2
[random]
plant.friction = {uniform = [0.4, 1.0]}
[[rows]]
label = "flat"
controller = "pirouette"
[[rows]]
label = "slope"
controller = "asc"
[rows.random]
plant.terrain = {uniform = [1, 10], text = "slope:{}"}
)";

class SurvivalReports : public test::TempFolderTest {
 protected:
  void SetUp() override {
    TempFolderTest::SetUp();
    std::ofstream(folder_ / "random.toml") << kFile;
    Result<Experiment> loaded = load_experiment(folder_ / "random.toml");
    ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
    experiment_ = std::move(loaded).value();
  }

  /// Trial i is i mm off; those of `fallen` fall, after i s.
  SweepResult made_up(const std::vector<std::size_t>& fallen) const {
    SweepResult result;
    for (std::size_t i = 0; i < experiment_.trials.size(); ++i) {
      const bool fell = std::find(fallen.begin(), fallen.end(), i) != fallen.end();
      const auto size = static_cast<double>(i);
      result.keys.push_back("key" + std::to_string(i));
      result.values.push_back({{"fell", fell ? 1.0 : 0.0},
                               {"fall_time_s", fell ? Number(size) : std::nullopt},
                               {"stand_down_delay_s", fell ? Number(0.25) : std::nullopt},
                               {"com.distance_to_point_mean_mm", size}});
    }
    return result;
  }

  Experiment experiment_;
};

TEST_F(SurvivalReports, CountFallsByRowWithWilsonIntervals) {
  const SweepResult result = made_up({3, 5});
  const SurvivalReport report(experiment_, result);
  ASSERT_EQ(report.groups.size(), 3u);
  EXPECT_EQ(report.groups[0].falls, 2u);
  EXPECT_EQ(report.groups[1].falls, 0u);
  EXPECT_EQ(report.groups[2].falls, 2u);
  EXPECT_EQ(report.groups[2].trials, 20u);
  const std::string text = report.markdown();
  // 20 of 20: low = n / (n + z^2) = 20 / 23.84.
  EXPECT_NE(text.find("| flat | 20 | 0 | 100.0 % | 83.9 % to 100.0 % |"), text.npos) << text;
  EXPECT_NE(text.find("| slope | 20 | 2 | 90.0 % |"), text.npos) << text;
  EXPECT_NE(text.find("Allowed are 2 falls: holds."), text.npos);
  EXPECT_FALSE(std::regex_search(text, std::regex("\\{[a-z_]+\\}"))) << text;  // all is filled
}

TEST_F(SurvivalReports, LeaveFallsOutOfTheQuantiles) {
  const SweepResult result = made_up({39});
  const SurvivalReport report(experiment_, result);
  // Trials 0 to 38: the median is 19 mm, the largest 38 mm.
  EXPECT_NE(report.markdown().find(
                "| mean distance to the point, mm | all | 1.9 | 19 | 36.1 | 37.6 | 38 |"),
            std::string::npos)
      << report.markdown();
}

TEST_F(SurvivalReports, ListTheEarliestFallsThenTheLargestDistances) {
  const SweepResult result = made_up({30, 5});
  const SurvivalReport report(experiment_, result);
  EXPECT_EQ(report.worst, (std::vector<std::size_t>{5, 30, 39, 38, 37, 36, 35, 34, 33, 32}));
  EXPECT_NE(report.markdown().find("seed " + std::to_string(experiment_.trials[5].seed) +
                                   ": fell after 5 s"),
            std::string::npos);
}

TEST_F(SurvivalReports, MissTheirBoundWithTooManyFalls) {
  EXPECT_TRUE(SurvivalReport(experiment_, made_up({1, 2})).missed_bounds().empty());
  const std::vector<std::string> missed =
      SurvivalReport(experiment_, made_up({1, 2, 3})).missed_bounds();
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_EQ(missed.front(), "3 of 40 trials fell; allowed: 2");
}

TEST_F(SurvivalReports, MissTheirBoundWithAFallThatDoesNotEndInTheStandDown) {
  SweepResult result = made_up({1, 2});
  EXPECT_NE(
      SurvivalReport(experiment_, result)
          .markdown()
          .find(
              "Of 2 falls 2 ended in the controller's stand-down, at most 0.25 s after the fall."),
      std::string::npos);
  result.values[2]["stand_down_delay_s"] = std::nullopt;
  const std::vector<std::string> missed = SurvivalReport(experiment_, result).missed_bounds();
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_EQ(missed.front(), "1 of 2 falls did not end in the stand-down");
}

TEST_F(SurvivalReports, HaveATableWithWhatWasDrawn) {
  std::istringstream table(trial_table(experiment_, made_up({})));
  std::string head, first, second;
  std::getline(table, head);
  std::getline(table, first);
  std::getline(table, second);
  EXPECT_TRUE(head.starts_with("trial,key,row,plant.friction,plant.terrain,seed,fell")) << head;
  EXPECT_NE(first.find(",flat," + std::to_string(experiment_.trials[0].seed)), first.npos) << first;
  EXPECT_NE(second.find("," + experiment_.trials[1].config->plant.terrain + ","), second.npos);
}

/// The configuration that `line`, made by repeat_command() without quoted words but --set, gives.
Config replayed(const std::string& line) {
  const std::map<std::string, std::string> keys = {{"--rate", "run.rate"},
                                                   {"--turns", "run.turns"},
                                                   {"--seed", "run.seed"},
                                                   {"--terrain", "plant.terrain"}};
  ConfigSources sources;
  std::istringstream words(line);
  std::string program, verb, option, value;
  words >> program >> verb;
  while (words >> option >> value) {
    if (option == "--set") {
      sources.overrides.push_back(value);
    } else if (option == "--controller") {
      sources.controller = value;
    } else {
      sources.overrides.push_back(keys.at(option) + "=" + value);
    }
  }
  return load_config(sources).value();
}

TEST_F(SurvivalReports, NameACommandThatRepeatsTheTrial) {
  for (const ExperimentTrial& trial : experiment_.trials) {
    const std::string line = repeat_command(*trial.config);
    EXPECT_EQ(trial_key(replayed(line)), trial_key(*trial.config)) << line;
  }
}

TEST(ShellWord, IsQuotedWhereTheShellWouldReadIt) {
  EXPECT_EQ(shell_word("plant.friction=0.4"), "plant.friction=0.4");
  EXPECT_EQ(shell_word("run.point=[0.1, 0.2]"), "'run.point=[0.1, 0.2]'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace pirouette
