// Experiment files: what they expand to, and what is said when they are wrong.
#include "pirouette/study/experiment_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "pirouette/config/config.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGood = R"(title = "A small experiment"
seeds = [3, 5]
ladder = ["baseline", "ours"]
[common]
run.turns = 1
gait.period = 0.4
[[rows]]
label = "baseline"
controller = "mit"
paper = "MIT"
[rows.set]
gait.period = 0.5
[[rows]]
label = "ours"
controller = "pirouette"
[[axes]]
key = "plant.torsional_friction"
values = [0.005, 0.02]
[[axes]]
key = "profile"
values = ["nominal", "realistic"]
[trace]
profile = "nominal"
plant.torsional_friction = 0.02
[[columns]]
metric = "com.radius_mean_mm"
title = "radius, mm"
[[paper]]
row = "MIT"
profile = "nominal"
[paper.metrics]
com.radius_mean_mm = 27.9
[[bounds]]
row = "ours"
metric = "com.radius_mean_mm"
max = 5.0
)";

class ExperimentFiles : public test::TempFolderTest {
 protected:
  fs::path file() const { return folder_ / "experiment.toml"; }

  Result<Experiment> load(const std::string& text, const ExperimentChanges& changes = {}) {
    std::ofstream(file()) << text;
    return load_experiment(file(), changes);
  }

  /// The good experiment with `from` replaced by `to`.
  static std::string good_but(const std::string& from, const std::string& to) {
    std::string text = kGood;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return text.replace(at, from.size(), to);
  }

  /// The errors of the good experiment with `from` replaced by `to`, "LINE: key: message" each.
  std::string errors_of(const std::string& from, const std::string& to) {
    const Result<Experiment> experiment = load(good_but(from, to));
    if (experiment) return "no error";
    std::string text;
    for (const Error& error : experiment.errors()) {
      std::string line = error.to_string();
      if (line.starts_with(file().string() + ":")) line.erase(0, file().string().size() + 1);
      text += (text.empty() ? "" : "\n") + line;
    }
    return text;
  }
};

TEST_F(ExperimentFiles, NameTheLineWithAControlCharacter) {
  const std::string allowed = "; allowed: a text without control characters, on one line";
  EXPECT_EQ(errors_of("label = \"baseline\"", "label = \"base\\nline\""),
            "8: rows.label: given \"base\\x0aline\"" + allowed);
  EXPECT_EQ(errors_of("radius, mm", "\\u001b[31mradius, mm"),
            "27: columns.title: given \"\\x1b[31mradius, mm\"" + allowed);
  EXPECT_EQ(errors_of("A small", "A\\u009bsmall"),
            "1: title: given \"A\\xc2\\x9bsmall experiment\"" + allowed);
  EXPECT_EQ(errors_of("\"realistic\"]", "\"real\\u007f\"]"),
            "21: axes.values: given \"real\\x7f\"" + allowed);
  EXPECT_EQ(errors_of("seeds = [3, 5]", "\"se\\reds\" = [3, 5]"),
            "2: se\\x0deds: a key; allowed: one without control characters");
}

TEST_F(ExperimentFiles, MayHaveANoteOfSeveralLines) {
  EXPECT_TRUE(load(std::string("note = \"\"\"one\n\ttwo ± π \U0001F600\"\"\"\n") + kGood));
  EXPECT_FALSE(load(std::string("note = \"one\\u0007\"\n") + kGood));
}

TEST_F(ExperimentFiles, AreRefusedByANameThatBreaksALine) {
  for (const std::string name : {"a\nb", "a\x1b[31m", "a\xff"}) {
    const fs::path path = folder_ / (name + ".toml");
    std::ofstream(path) << kGood;
    const Result<Experiment> experiment = load_experiment(path);
    ASSERT_FALSE(experiment);
    EXPECT_NE(experiment.errors().front().to_string().find("allowed: a file name in UTF-8"),
              std::string::npos);
  }
}

TEST_F(ExperimentFiles, ExpandRowsThenAxesThenSeeds) {
  const Result<Experiment> loaded = load(kGood);
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  const Experiment& experiment = loaded.value();
  ASSERT_EQ(experiment.trials.size(), 2u * 2u * 2u * 2u);
  const ExperimentTrial& second = experiment.trials[1];
  EXPECT_EQ(second.row, 0u);
  EXPECT_EQ(second.config->run.seed, 5);
  EXPECT_EQ(experiment.trials[2].config->profile, "realistic");
  EXPECT_EQ(experiment.trials[4].config->plant.torsional_friction, 0.02);
  EXPECT_EQ(experiment.trials[8].config->controller, "pirouette");
}

TEST_F(ExperimentFiles, TakeRobotsAsTheFirstAxis) {
  const fs::path copy = folder_ / "other.xml";
  fs::copy(fs::path(PIROUETTE_SOURCE_DIR) / "robots/mini_cheetah/mini_cheetah.xml", copy);
  const Result<Experiment> loaded =
      load("robots = [\"mini_cheetah\", \"" + copy.string() + "\"]\n" + kGood);
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  const Experiment& experiment = loaded.value();
  ASSERT_EQ(experiment.axes.size(), 3u);
  EXPECT_EQ(experiment.axes.front().key, "robot");
  ASSERT_EQ(experiment.trials.size(), 2u * 16u);
  for (std::size_t i = 0; i < experiment.trials.size(); ++i) {
    const bool first = (i / 8) % 2 == 0;  // rows, then robots, then 2 x 2 axis values x 2 seeds
    EXPECT_EQ(experiment.trials[i].config->robot, first ? "mini_cheetah" : copy.string());
  }
}

TEST_F(ExperimentFiles, NameWhatIsWrongWithRobots) {
  const std::string title = "title = \"A small experiment\"";
  EXPECT_EQ(errors_of(title, "robot = \"mini_cheetah\"\nrobots = [\"mini_cheetah\"]"),
            "2: robots: given beside robot; allowed: one of them");
  EXPECT_EQ(errors_of(title, "robots = [1]"),
            "1: robots: given [1]; allowed: a list of names under robots/ or MJCF files");
  EXPECT_EQ(errors_of(title, "robots = [\"mini_cheetah\", \"mini_chetah\"]").substr(0, 31),
            "1: robot: given \"mini_chetah\"; ");
  EXPECT_EQ(errors_of("key = \"profile\"\nvalues = [\"nominal\", \"realistic\"]",
                      "key = \"robot\"\nvalues = [\"mini_cheetah\"]")
                .substr(0, 51),
            "19: axes.key: robots are given by the list `robots`");
}

TEST_F(ExperimentFiles, RowsOverrideWhatIsCommonAndAxesOverrideRows) {
  const Result<Experiment> loaded =
      load(good_but("gait.period = 0.5", "gait.period = 0.5\nplant.torsional_friction = 0.1"));
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  EXPECT_EQ(loaded.value().trials.front().config->gait.period, 0.5);
  EXPECT_EQ(loaded.value().trials.front().config->plant.torsional_friction, 0.005);
  EXPECT_EQ(loaded.value().trials.back().config->gait.period, 0.4);
}

TEST_F(ExperimentFiles, KeepTheTraceOfTheFirstSeedWhereAsked) {
  const Result<Experiment> loaded = load(kGood);
  ASSERT_TRUE(loaded);
  for (const ExperimentTrial& trial : loaded.value().trials) {
    const bool wanted = trial.config->profile == "nominal" &&
                        trial.config->plant.torsional_friction == 0.02 && trial.seed == 3;
    EXPECT_EQ(trial.keep_trace, wanted);
  }
}

TEST_F(ExperimentFiles, KeepATraceForEachOfSeveralValues) {
  const Result<Experiment> loaded =
      load(good_but("torsional_friction = 0.02", "torsional_friction = [0.005, 0.02]"));
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  for (const ExperimentTrial& trial : loaded.value().trials) {
    EXPECT_EQ(trial.keep_trace, trial.config->profile == "nominal" && trial.seed == 3);
  }
}

TEST_F(ExperimentFiles, HoldPrintedFiguresAndBounds) {
  const Result<Experiment> loaded = load(kGood);
  ASSERT_TRUE(loaded);
  ASSERT_EQ(loaded.value().printed.size(), 1u);
  EXPECT_EQ(loaded.value().printed.front().metrics.at("com.radius_mean_mm"), 27.9);
  ASSERT_EQ(loaded.value().bounds.size(), 1u);
  EXPECT_EQ(loaded.value().bounds.front().max, 5.0);
  EXPECT_FALSE(loaded.value().bounds.front().min);
}

TEST_F(ExperimentFiles, HoldTheBoundsOfARow) {
  const Result<Experiment> loaded =
      load(good_but("controller = \"pirouette\"",
                    "controller = \"pirouette\"\nmax = {fell = 0, com.drift_per_turn_mm = 0.5}"));
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  const std::vector<ExperimentBound>& bounds = loaded.value().bounds;
  ASSERT_EQ(bounds.size(), 3u);
  EXPECT_EQ(bounds[0].row, "ours");
  EXPECT_EQ(bounds[0].metric, "com.drift_per_turn_mm");
  EXPECT_EQ(bounds[0].max, 0.5);
  EXPECT_EQ(bounds[1].metric, "fell");
}

TEST_F(ExperimentFiles, HoldBoundsRelativeToAnotherRow) {
  const Result<Experiment> loaded = load(good_but("max = 5.0", "share = 0.5\nof = \"baseline\""));
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  EXPECT_EQ(loaded.value().bounds.front().relative_to, "baseline");
  EXPECT_EQ(loaded.value().bounds.front().share, 0.5);
  EXPECT_EQ(errors_of("max = 5.0", "share = 0.5"), "33: bounds: share and of go together");
  EXPECT_EQ(errors_of("max = 5.0", "share = 0.5\nof = \"mine\""),
            "33: bounds.of: given \"mine\"; allowed: \"baseline\", \"ours\"");
}

TEST_F(ExperimentFiles, HoldFiguresPrintedForAnUnnamedValue) {
  const std::string axis = "axis = \"plant.torsional_friction\"\n";
  const Result<Experiment> loaded =
      load(good_but("[paper.metrics]", axis + "among = [0.005, 0.02]\n[paper.metrics]"));
  ASSERT_TRUE(loaded) << loaded.errors().front().to_string();
  EXPECT_EQ(loaded.value().printed.front().among, loaded.value().axes.front());
  EXPECT_EQ(errors_of("[paper.metrics]", axis + "among = [0.01]\n[paper.metrics]"),
            "32: paper.among: given 0.01; allowed: 0.005, 0.02");
  EXPECT_EQ(errors_of("[paper.metrics]", "among = [0.005]\n[paper.metrics]").substr(0, 23),
            "28: paper.axis: missing");
}

TEST_F(ExperimentFiles, LetTheCommandLineChangeSeedsAndTurns) {
  const Result<Experiment> loaded = load(kGood, {.seeds = 3, .turns = 0.5});
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded.value().seeds, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(loaded.value().trials.front().config->run.turns, 0.5);
  const Result<Experiment> wrong = load(kGood, {.seeds = 0, .turns = -1.0});
  ASSERT_FALSE(wrong);
  ASSERT_EQ(wrong.errors().size(), 2u);
  EXPECT_TRUE(wrong.errors()[0].to_string().starts_with("--seeds: given 0"));
  EXPECT_TRUE(wrong.errors()[1].to_string().starts_with("--turns: given -1"));
}

TEST_F(ExperimentFiles, NameTheLineOfAWrongParameterOnce) {
  EXPECT_EQ(errors_of("gait.period = 0.4", "gait.perid = 0.4"),
            "6: gait.perid: unknown key; did you mean gait.period?");
  EXPECT_EQ(errors_of("gait.period = 0.5", "gait.period = 9"),
            "12: gait.period: given 9; allowed: 0.15 to 2 s");
  EXPECT_EQ(errors_of("0.02]", "\"much\"]").substr(0, 42),
            "18: plant.torsional_friction: given \"much\"");
  EXPECT_EQ(errors_of("\"realistic\"]", "\"realistc\"]").substr(0, 29),
            "21: profile: given \"realistc\"");
}

TEST_F(ExperimentFiles, NameTheLineOfWhatATrialWouldRefuse) {
  EXPECT_EQ(errors_of("gait.period = 0.5", "plant.terrain = \"slope:99\"").substr(0, 38),
            "12: plant.terrain: \"slope:99\": the slo");
  EXPECT_EQ(errors_of("gait.period = 0.5", "plant.command_latency = 0.0015"),
            "12: plant.command_latency: must be a whole number of physics steps, plant.timestep");
  EXPECT_EQ(errors_of("gait.period = 0.5",
                      "plant.terrain = \"rough:0.05\"\nrun.start_offset = [4.5, 0.0]"),
            "13: run.start_offset: the start is nearer than 1 m to the edge of this terrain, which "
            "ends 5.000000 m from the origin");
}

TEST_F(ExperimentFiles, NameTheLineOfAWrongController) {
  const std::string text = errors_of("controller = \"mit\"", "controller = \"mti\"");
  EXPECT_EQ(text.substr(0, 33), "7: controller: given \"mti\"; allow") << text;
}

TEST_F(ExperimentFiles, NameWhatIsWrongWithTheExperimentItself) {
  EXPECT_EQ(errors_of("seeds = [3, 5]", "seeds = [3, 3]").substr(0, 22), "2: seeds: given [3, 3]");
  EXPECT_EQ(errors_of("seeds = [3, 5]", "sedes = [3, 5]"),
            "2: sedes: unknown key; did you mean seeds?");
  EXPECT_EQ(errors_of("label = \"ours\"\n", ""),
            "3: ladder: given \"ours\"; allowed: \"baseline\", \"\"\n"
            "13: rows.label: missing: a text in quotes\n"
            "32: bounds.row: given \"ours\"; allowed: \"baseline\", \"\"");
  EXPECT_EQ(errors_of("row = \"MIT\"", "row = \"ETH\""),
            "28: paper.row: no row has paper = \"ETH\"");
  EXPECT_EQ(errors_of("max = 5.0", ""), "33: bounds: needs min, max, or share and of");
  EXPECT_EQ(errors_of("plant.torsional_friction = 0.02", "plant.torsional_friction = 0.03"),
            "24: trace.plant.torsional_friction: given 0.03; allowed: a value of an axis");
}

TEST_F(ExperimentFiles, RefuseMoreTrialsThanAnyoneCanRun) {
  std::string axes;
  for (const char* key : {"run.rate", "plant.friction", "gait.duty", "gait.swing_height"}) {
    axes += "[[axes]]\nkey = \"" + std::string(key) + "\"\nvalues = [0.5";
    for (int i = 0; i < 99; ++i) axes += ", 0.5";
    axes += "]\n";
  }
  const Result<Experiment> many = load(kGood + axes);
  ASSERT_FALSE(many);
  EXPECT_EQ(many.errors().front().to_string(),
            file().string() + ": makes 1.6e+09 trials; allowed: at most 1000000");
  const Result<Experiment> sixteen = load(kGood, {.max_trials = 15});
  ASSERT_FALSE(sixteen);
  EXPECT_EQ(sixteen.errors().front().to_string(),
            file().string() + ": makes 16 trials; allowed: at most 15");
  EXPECT_TRUE(load(kGood, {.max_trials = 16}));
}

TEST_F(ExperimentFiles, NameTheLineThatIsNoToml) {
  EXPECT_EQ(errors_of("[common]", "[*common]").substr(0, 3), "4: ");
  EXPECT_EQ(errors_of("run.turns = 1", "run.turns = 1 \u00e9").substr(0, 3), "5: ");
  EXPECT_EQ(errors_of("run.turns = 1", "run.turns\u01d2 = 1").substr(0, 3), "5: ");
}

TEST(Experiments, OfTheProjectAreValid) {
  const std::vector<std::string> names = known_experiments();
  EXPECT_GE(names.size(), 4u);
  std::vector<fs::path> files;
  for (const std::string& name : names) files.push_back(experiment_path(name));
  for (const char* name : {"flat", "uneven"}) {
    files.push_back(experiment_path(std::string("acceptance/") + name));
  }
  for (const fs::path& file : files) {
    const Result<Experiment> experiment = load_experiment(file);
    EXPECT_TRUE(experiment) << experiment.errors().front().to_string();
  }
}

}  // namespace
}  // namespace pirouette
