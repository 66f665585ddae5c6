// Random experiments: what is drawn, on what it depends, and what is said of a wrong file.
#include "pirouette/study/experiment_draw.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "pirouette/config/config.hpp"
#include "pirouette/study/experiment_file.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

ExperimentDraw friction() { return {.key = "plant.friction", .min = 0.4, .max = 1.0}; }

double number(const std::string& literal) { return std::strtod(literal.c_str(), nullptr); }

TEST(ExperimentDraw, IsUniformOverItsRange) {
  constexpr int kTrials = 20000;
  double sum = 0.0, squares = 0.0, least = 1.0, most = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double share = (number(drawn_value(friction(), 1, trial)) - 0.4) / 0.6;
    sum += share;
    squares += share * share;
    least = std::min(least, share);
    most = std::max(most, share);
  }
  // Five standard errors of the mean (1 / sqrt(12 n)) and of the mean square (sqrt(4 / 45 / n)).
  EXPECT_NEAR(sum / kTrials, 0.5, 5.0 / std::sqrt(12.0 * kTrials));
  EXPECT_NEAR(squares / kTrials, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / kTrials));
  EXPECT_GE(least, 0.0);
  EXPECT_LT(least, 0.001);
  EXPECT_GT(most, 0.999);
  EXPECT_LE(most, 1.0 + 1e-12);  // rounding of the share
}

TEST(ExperimentDraw, HasFourDigitsAndDependsOnSeedTrialAndKey) {
  const std::string value = drawn_value(friction(), 1, 0);
  EXPECT_LE(value.size(), std::string("0.1234").size());
  EXPECT_EQ(value, drawn_value(friction(), 1, 0));
  EXPECT_NE(value, drawn_value(friction(), 2, 0));
  EXPECT_NE(value, drawn_value(friction(), 1, 1));
  ExperimentDraw other = friction();
  other.key = "plant.torque_scale";
  EXPECT_NE(value, drawn_value(other, 1, 0));
}

TEST(ExperimentDraw, TakesEitherSignHalfOfTheTime) {
  ExperimentDraw rate{.key = "run.rate", .min = 0.3, .max = 1.2, .either_sign = true};
  int negative = 0;
  constexpr int kTrials = 10000;
  for (int trial = 0; trial < kTrials; ++trial) {
    const double value = number(drawn_value(rate, 3, trial));
    EXPECT_GE(std::abs(value), 0.3);
    EXPECT_LE(std::abs(value), 1.2);
    negative += value < 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(negative, kTrials / 2, 5.0 * std::sqrt(kTrials / 4.0));  // five standard errors
}

TEST(ExperimentDraw, PutsTheNumberIntoItsText) {
  const ExperimentDraw slope{
      .key = "plant.terrain", .min = 7.5, .max = 7.5, .text = "slope:{}+rough:0.01"};
  EXPECT_EQ(drawn_value(slope, 1, 0), "\"slope:7.5+rough:0.01\"");
}

TEST(ExperimentDraw, ChoosesEachValueEquallyOften) {
  const ExperimentDraw choice{.key = "plant.terrain", .values = {"\"a\"", "\"b\"", "\"c\""}};
  std::map<std::string, int> counts;
  constexpr int kTrials = 9000;
  for (int trial = 0; trial < kTrials; ++trial) ++counts[drawn_value(choice, 1, trial)];
  ASSERT_EQ(counts.size(), 3u);
  // Five standard errors of a binomial count with p = 1/3.
  for (const auto& [value, count] : counts) {
    EXPECT_NEAR(count, kTrials / 3, 5.0 * std::sqrt(kTrials * 2.0 / 9.0)) << value;
  }
}

constexpr const char* kGood = R"(trials = 7
seed = 5
max_falls = 1
[random]
plant.friction = {uniform = [0.4, 1.0]}
run.rate = {choice = [0.5, 0.7]}
[[rows]]
label = "flat"
controller = "pirouette"
[[rows]]
label = "slope"
controller = "asc"
[rows.set]
plant.torsional_friction = 0.01
[rows.random]
plant.terrain = {uniform = [1, 10], text = "slope:{}"}
)";

class RandomExperiments : public test::TempFolderTest {
 protected:
  Result<Experiment> load(const std::string& text, const ExperimentChanges& changes = {}) {
    const fs::path file = folder_ / "random.toml";
    std::ofstream(file) << text;
    return load_experiment(file, changes);
  }

  /// What is said first of the good experiment with `from` replaced by `to`, without the folder.
  std::string error_of(const std::string& from, const std::string& to) {
    std::string text = kGood;
    text.replace(text.find(from), from.size(), to);
    const Result<Experiment> experiment = load(text);
    if (experiment) return "no error";
    const std::string error = experiment.errors().front().to_string();
    return error.substr(error.find("random.toml"));
  }
};

TEST_F(RandomExperiments, TakeTheRowsInTurnAndDrawForEachTrial) {
  const Result<Experiment> loaded = load(kGood);
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  const Experiment& experiment = loaded.value();
  ASSERT_EQ(experiment.trials.size(), 7u);
  std::set<std::int64_t> seeds;
  for (std::size_t i = 0; i < experiment.trials.size(); ++i) {
    const ExperimentTrial& trial = experiment.trials[i];
    const Config& config = *trial.config;
    EXPECT_EQ(trial.row, i % 2);
    EXPECT_EQ(config.controller, i % 2 == 0 ? "pirouette" : "asc");
    EXPECT_EQ(config.plant.terrain.starts_with("slope:"), i % 2 == 1);
    EXPECT_EQ(config.plant.torsional_friction, i % 2 == 0 ? 0.005 : 0.01);
    EXPECT_EQ(std::to_string(config.plant.friction).substr(0, 6),
              std::to_string(number(drawn_value(friction(), 5, static_cast<std::int64_t>(i))))
                  .substr(0, 6));
    EXPECT_EQ(config.run.seed, trial.seed);
    seeds.insert(trial.seed);
  }
  EXPECT_EQ(seeds.size(), 7u);
  EXPECT_EQ(experiment.random_keys(),
            (std::vector<std::string>{"plant.friction", "plant.terrain", "run.rate"}));
  EXPECT_EQ(experiment.random->max_falls, 1);
}

TEST_F(RandomExperiments, DrawTheSameForATrialHoweverManyThereAre) {
  const Result<Experiment> few = load(kGood, {.trials = 3});
  const Result<Experiment> many = load(kGood);
  ASSERT_TRUE(few && many);
  ASSERT_EQ(few.value().trials.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(few.value().trials[i].seed, many.value().trials[i].seed);
    EXPECT_EQ(few.value().trials[i].config->plant.friction,
              many.value().trials[i].config->plant.friction);
  }
  const Result<Experiment> other = load(kGood, {.draw_seed = 6});
  ASSERT_TRUE(other);
  EXPECT_NE(other.value().trials[0].seed, many.value().trials[0].seed);
}

TEST_F(RandomExperiments, NameWhatIsWrong) {
  EXPECT_EQ(error_of("trials = 7\n", ""),
            "random.toml:1: trials: missing: how many trials draw from [random]");
  EXPECT_EQ(error_of("trials = 7", "trials = 0").substr(0, 30), "random.toml:1: trials: given 0");
  EXPECT_EQ(error_of("seed = 5", "seeds = [1]"),
            "random.toml:2: seeds: unknown key; did you mean seed?");
  EXPECT_EQ(error_of("uniform = [0.4", "unifrom = [0.4").substr(0, 51),
            "random.toml:5: random.plant.friction.unifrom: given");
  EXPECT_EQ(error_of("[0.4, 1.0]", "[1.0, 0.4]"),
            "random.toml:5: random.plant.friction: given [1.0, 0.4]; allowed: MIN up to MAX");
  EXPECT_EQ(error_of("[0.4, 1.0]", "[0.4]"),
            "random.toml:5: random.plant.friction: given [0.4]; allowed: [MIN, MAX]");
  EXPECT_EQ(error_of("slope:{}", "slope:"),
            "random.toml:16: rows.random.plant.terrain.text: given \"slope:\"; allowed: a text "
            "with {} in it");
  EXPECT_EQ(error_of("[0.4, 1.0]}", "[-2.0, -1.0]}").substr(0, 37),
            "random.toml:5: plant.friction: given ");
  // A value out of range that is drawn late, if at all: the range is told.
  EXPECT_EQ(error_of("[0.4, 1.0]", "[0.4, 5.01]"),
            "random.toml:5: plant.friction: given [0.4, 5.01]; allowed: 0.0 to 5.0");
  EXPECT_EQ(error_of("[1, 10]", "[1, 40.1]").substr(0, 52),
            "random.toml:16: plant.terrain: \"slope:40.1\": the slo");
  EXPECT_EQ(error_of("plant.friction =", "plant.frction =").substr(0, 56),
            "random.toml:5: plant.frction: unknown key; did you mean ");
  EXPECT_EQ(error_of("run.rate = {choice", "run.seed = {choice"),
            "random.toml:6: random.run.seed: is drawn for every trial anyway");
}

}  // namespace
}  // namespace pirouette
