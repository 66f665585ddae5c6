// Sweeps: parallel, interrupted, resumed, and always the same table.
#include "pirouette/study/sweep.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "pirouette/config/toml.hpp"
#include "pirouette/report/report.hpp"
#include "pirouette/report/trial_table.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTiny = R"(seeds = [1, 2]
ladder = ["asc", "ours"]
[common]
run.turns = 0.02
run.settle_time = 0.1
gait.stand_time = 0.2
[[rows]]
label = "asc"
controller = "asc"
paper = "ASC"
[[rows]]
label = "ours"
controller = "pirouette"
[[axes]]
key = "plant.friction"
values = [0.6, 0.8]
[trace]
plant.friction = 0.8
[[columns]]
metric = "com.radius_mean_mm"
title = "radius, mm"
[[paper]]
row = "ASC"
profile = "nominal"
[paper.metrics]
com.radius_mean_mm = 11.2
)";

/// The tiny experiment with `from` replaced by `to`.
std::string tiny_but(const std::string& from, const std::string& to) {
  std::string text = kTiny;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class Sweeps : public test::TempFolderTest {
 protected:
  Experiment load(const std::string& text = kTiny) {
    const fs::path file = folder_ / "tiny.toml";
    std::ofstream(file) << text;
    Result<Experiment> experiment = load_experiment(file);
    if (experiment) return std::move(experiment).value();
    ADD_FAILURE() << experiment.errors().front().to_string();
    return {};
  }

  SweepOptions options(const std::string& name, unsigned jobs) {
    SweepOptions options;
    options.folder = folder_ / name;
    options.jobs = jobs;
    return options;
  }

  /// All that the sweep says.
  static std::string tables(const Experiment& experiment, const SweepOptions& options) {
    const Result<SweepResult> result = run_sweep(experiment, options);
    if (!result) {
      ADD_FAILURE() << result.errors().front().to_string();
      return "";
    }
    return all_text(experiment, result.value());
  }

  static std::string all_text(const Experiment& experiment, const SweepResult& result) {
    const Report report(experiment, result);
    return trial_table(experiment, result) + report.csv() + report.markdown() + report.json();
  }
};

TEST_F(Sweeps, GiveTheSameTableForAnyNumberOfJobs) {
  const Experiment experiment = load();
  const std::string one = tables(experiment, options("one", 1));
  EXPECT_EQ(one, tables(experiment, options("two", 2)));
  EXPECT_NE(one.find("ours"), one.npos);
}

TEST_F(Sweeps, GoOnAfterAnInterruptionInTheMiddleOfALine) {
  const Experiment experiment = load();
  const std::string whole = tables(experiment, options("whole", 2));
  const std::string log = read(folder_ / "whole" / results_file({}));
  fs::create_directories(folder_ / "part");
  std::ofstream(folder_ / "part" / results_file({})) << log.substr(0, log.size() / 2);

  SweepOptions resumed = options("part", 2);
  SweepProgress first, last;
  resumed.progress = [&](const SweepProgress& progress) {
    if (first.total == 0) first = progress;
    last = progress;
  };
  fs::copy(folder_ / "whole" / kTracesFolder, folder_ / "part" / kTracesFolder);
  EXPECT_EQ(whole, tables(experiment, resumed));
  EXPECT_GT(first.resumed, 0u);
  EXPECT_LT(first.resumed, first.total);
  EXPECT_EQ(last.done, last.total);
  EXPECT_EQ(whole, tables(experiment, resumed));
  EXPECT_EQ(last.resumed, last.total);
}

TEST_F(Sweeps, RunATrialAgainWhoseTraceIsLost) {
  const Experiment experiment = load();
  const std::string whole = tables(experiment, options("run", 2));
  const std::string key = trial_key(*experiment.trials[2].config);
  ASSERT_TRUE(experiment.trials[2].keep_trace);
  const std::string trace = read(trace_path(folder_ / "run", key));
  ASSERT_FALSE(trace.empty());
  fs::remove(trace_path(folder_ / "run", key));
  EXPECT_EQ(whole, tables(experiment, options("run", 2)));
  EXPECT_EQ(trace, read(trace_path(folder_ / "run", key)));
}

TEST_F(Sweeps, KeepWhatIsFinishedWhenStopped) {
  const Experiment experiment = load();
  SweepOptions stopped = options("run", 1);
  std::atomic<std::size_t> done = 0;
  stopped.progress = [&](const SweepProgress& progress) { done = progress.done; };
  stopped.stop = [&] { return done >= 3; };
  const Result<SweepResult> result = run_sweep(experiment, stopped);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result.value().interrupted);
  EXPECT_EQ(tables(experiment, options("run", 2)), tables(experiment, options("whole", 2)));
}

TEST_F(Sweeps, GiveTheSameTableFromShardsThatRunAtTheSameTime) {
  const Experiment experiment = load();
  const std::string whole = tables(experiment, options("whole", 2));
  {
    std::vector<std::jthread> shards;
    for (unsigned index = 1; index <= 3; ++index) {
      shards.emplace_back([&, index] {
        SweepOptions part = options("sharded", 1);
        part.shard = Shard{index, 3};
        const Result<SweepResult> result = run_sweep(experiment, part);
        EXPECT_TRUE(result && !result.value().interrupted);
      });
    }
  }
  const Result<SweepResult> merged = merge_sweep(experiment, options("sharded", 1));
  ASSERT_TRUE(merged) << merged.errors().front().to_string();
  EXPECT_EQ(whole, all_text(experiment, merged.value()));
  for (const auto& entry : fs::directory_iterator(folder_ / "whole" / kTracesFolder)) {
    EXPECT_EQ(read(entry.path()),
              read(folder_ / "sharded" / kTracesFolder / entry.path().filename()));
  }

  SweepOptions rest = options("sharded", 1);
  rest.progress = [](const SweepProgress& progress) { EXPECT_EQ(progress.resumed, 8u); };
  EXPECT_EQ(whole, tables(experiment, rest));
}

TEST_F(Sweeps, RunEveryRobot) {
  const fs::path copy = folder_ / "copy.xml";
  fs::copy(fs::path(PIROUETTE_SOURCE_DIR) / "robots/mini_cheetah/mini_cheetah.xml", copy);
  const Experiment experiment = load("robots = [\"mini_cheetah\", \"" + copy.string() + "\"]\n" +
                                     tiny_but("seeds = [1, 2]", "seeds = [1]"));
  const Result<SweepResult> result = run_sweep(experiment, options("run", 2));
  ASSERT_TRUE(result) << result.errors().front().to_string();
  ASSERT_EQ(result.value().values.size(), 8u);
  // Rows, robots, frictions: the copy is another trial with the same numbers.
  EXPECT_NE(result.value().keys[0], result.value().keys[2]);
  EXPECT_EQ(result.value().values[0], result.value().values[2]);
  const std::string table = trial_table(experiment, result.value());
  EXPECT_TRUE(table.starts_with("trial,key,row,robot,plant.friction,seed,")) << table;
}

TEST_F(Sweeps, TellHowMuchIsFinished) {
  const Experiment experiment = load();
  SweepOptions part = options("run", 2);
  part.shard = Shard{1, 3};
  EXPECT_EQ(survey_sweep(experiment, options("run", 1)).value().done, 0u);
  ASSERT_TRUE(run_sweep(experiment, part));
  const SweepProgress progress = survey_sweep(experiment, options("run", 1)).value();
  EXPECT_EQ(progress.done, 3u);
  EXPECT_EQ(progress.total, 8u);
}

TEST_F(Sweeps, TellWhichShardsAreMissingFromAMerge) {
  const Experiment experiment = load();
  SweepOptions first = options("run", 2);
  first.shard = Shard{1, 3};
  ASSERT_TRUE(run_sweep(experiment, first));
  const Result<SweepResult> merged = merge_sweep(experiment, options("run", 1));
  ASSERT_FALSE(merged);
  EXPECT_EQ(
      merged.errors().front().to_string(),
      (folder_ / "run").string() + ": no results of 5 of 8 trials; shards not finished: 2/3, 3/3");
}

TEST_F(Sweeps, RefuseToWriteBesideAnotherProcessOfTheSameShard) {
  const Experiment experiment = load();
  fs::create_directories(folder_ / "run");
  const Result<ResultsLog> other = ResultsLog::open(folder_ / "run", Shard{1, 2}, false);
  ASSERT_TRUE(other);
  SweepOptions same = options("run", 1);
  same.shard = Shard{1, 2};
  const Result<SweepResult> refused = run_sweep(experiment, same);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.errors().front().to_string().find("results-1of2.jsonl: is in use"),
            std::string::npos);
  SweepOptions fresh = options("run", 1);
  fresh.fresh = true;
  EXPECT_FALSE(run_sweep(experiment, fresh));
}

TEST_F(Sweeps, ForgetTheShardsToo) {
  const Experiment experiment = load();
  SweepOptions part = options("run", 2);
  part.shard = Shard{1, 2};
  ASSERT_TRUE(run_sweep(experiment, part));
  SweepOptions fresh = options("run", 2);
  fresh.fresh = true;
  SweepProgress last;
  fresh.progress = [&](const SweepProgress& progress) { last = progress; };
  ASSERT_TRUE(run_sweep(experiment, fresh));
  EXPECT_EQ(last.resumed, 0u);
  EXPECT_FALSE(fs::exists(folder_ / "run" / results_file(Shard{1, 2})));
}

TEST_F(Sweeps, TellAnEditedLineAndRunItsTrialAgain) {
  const Experiment experiment = load();
  const std::string whole = tables(experiment, options("run", 2));
  const fs::path file = folder_ / "run" / results_file({});
  std::string log = read(file);
  const std::string radius = "\"com.radius_mean_mm\":";
  const std::size_t second_line = log.find('\n') + 1;
  log.insert(log.find(radius, second_line) + radius.size(), "-");
  std::ofstream(file) << log;

  std::vector<std::string> told;
  std::size_t resumed = 0;
  SweepOptions again = options("run", 2);
  again.unused_lines = [&](const Errors& lines) {
    for (const Error& line : lines) told.push_back(line.to_string());
  };
  again.progress = [&](const SweepProgress& progress) { resumed = progress.resumed; };
  EXPECT_EQ(whole, tables(experiment, again));
  EXPECT_EQ(told,
            std::vector{file.string() + ":2: is damaged or edited: its checksum does not fit"});
  EXPECT_EQ(resumed, 7u);
  told.clear();
  EXPECT_EQ(whole, tables(experiment, again));
  EXPECT_TRUE(told.empty());
  EXPECT_EQ(resumed, 8u);
}

TEST_F(Sweeps, TellTheResultsThatAreOfNoTrial) {
  ASSERT_TRUE(run_sweep(load(), options("run", 2)));
  const Experiment fewer = load(tiny_but("seeds = [1, 2]", "seeds = [1]"));
  Errors told;
  SweepOptions again = options("run", 2);
  again.unused_lines = [&](const Errors& lines) { told = lines; };
  ASSERT_TRUE(run_sweep(fewer, again));
  ASSERT_EQ(told.size(), 4u);
  EXPECT_NE(told.front().to_string().find("is of no trial of this experiment"), std::string::npos);
  again.beside = {"other"};  // whose trials they may be
  told.clear();
  ASSERT_TRUE(run_sweep(fewer, again));
  EXPECT_TRUE(told.empty());
}

TEST_F(Sweeps, RefuseTheFolderOfAnotherExperiment) {
  const Experiment tiny = load(tiny_but("seeds = [1, 2]", "seeds = [1]"));
  ASSERT_TRUE(run_sweep(tiny, options("run", 2)));
  const std::string before = read(folder_ / "run" / results_file({}));
  Experiment other = tiny;
  other.name = "other";
  const std::string expected = (folder_ / "run").string() +
                               ": holds results of the experiment \"tiny\"; allowed for "
                               "\"other\": a folder of its own, by --out";
  SweepOptions fresh = options("run", 1);
  fresh.fresh = true;
  const auto refusal = [](const auto& result) {
    return result ? std::string("runs") : result.errors().front().to_string();
  };
  EXPECT_EQ(refusal(run_sweep(other, options("run", 1))), expected);
  EXPECT_EQ(refusal(run_sweep(other, fresh)), expected);
  EXPECT_EQ(refusal(merge_sweep(other, options("run", 1))), expected);
  EXPECT_EQ(refusal(survey_sweep(other, options("run", 1))), expected);
  EXPECT_EQ(read(folder_ / "run" / results_file({})), before);

  SweepOptions shared = options("run", 1);
  shared.beside = {"tiny"};
  shared.progress = [](const SweepProgress& progress) { EXPECT_EQ(progress.resumed, 4u); };
  EXPECT_TRUE(run_sweep(other, shared));
}

TEST_F(Sweeps, RefuseTheFolderOfADifferentExperimentOfTheSameName) {
  ASSERT_TRUE(run_sweep(load(tiny_but("seeds = [1, 2]", "seeds = [1]")), options("run", 2)));
  std::string text = tiny_but("[\"asc\", \"ours\"]", "[\"first\", \"second\"]");
  text.replace(text.find("label = \"asc\""), 13, "label = \"first\"");
  text.replace(text.find("label = \"ours\""), 14, "label = \"second\"");
  const Experiment relabelled = load(text);
  EXPECT_TRUE(survey_sweep(relabelled, options("run", 1)));  // the same trials
  text.replace(text.find("run.turns = 0.02"), 16, "run.turns = 0.03");
  const Result<SweepResult> refused = run_sweep(load(text), options("run", 1));
  ASSERT_FALSE(refused);
  EXPECT_NE(
      refused.errors().front().to_string().find("holds results of a different experiment \"tiny\""),
      std::string::npos);
}

TEST_F(Sweeps, RefuseARobotThatCannotStandBeforeAnythingRuns) {
  const Experiment experiment =
      load(tiny_but("gait.stand_time = 0.2", "gait.stand_time = 0.2\nbody.height = 1.0"));
  const Result<SweepResult> result = run_sweep(experiment, options("run", 1));
  ASSERT_FALSE(result);
  ASSERT_EQ(result.errors().size(), 1u);
  EXPECT_NE(
      result.errors().front().to_string().find("tiny.toml: body.height: the robot cannot stand"),
      std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "run"));
}

TEST_F(Sweeps, RefuseAMetricThatThereIsNot) {
  const Errors errors = check_sweep(
      load(tiny_but("metric = \"com.radius_mean_mm\"", "metric = \"com.radius_men_mm\"")));
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NE(errors.front().to_string().find("did you mean com.radius_mean_mm?"), std::string::npos);
}

TEST_F(Sweeps, TellWhichBoundsAreMissed) {
  const Experiment experiment = load(std::string(kTiny) + R"([[bounds]]
row = "ours"
metric = "com.radius_mean_mm"
max = 1e-6
[[bounds]]
metric = "fell"
max = 0
)");
  const Result<SweepResult> result = run_sweep(experiment, options("run", 2));
  ASSERT_TRUE(result);
  const std::vector<std::string> missed = Report(experiment, result.value()).missed_bounds();
  ASSERT_EQ(missed.size(), 2u);  // one for each friction
  EXPECT_TRUE(missed.front().starts_with("ours, plant.friction 0.6 (nominal): com.radius_mean_mm"))
      << missed.front();
}

/// A result as if the tiny experiment had been run: `radius(row, level)` mm, or a fall.
template <class Radius>
SweepResult made_up(const Experiment& experiment, Radius&& radius) {
  SweepResult result;
  for (const ExperimentTrial& trial : experiment.trials) {
    const std::optional<double> mm = radius(trial.row, trial.levels.front());
    result.keys.emplace_back("key");
    result.values.push_back({{"fell", mm ? 0.0 : 1.0}, {"com.radius_mean_mm", mm}});
  }
  return result;
}

TEST_F(Sweeps, JudgeABoundByAnotherRowAtTheSameLevel) {
  const Experiment experiment = load(std::string(kTiny) + R"([[bounds]]
row = "ours"
metric = "com.radius_mean_mm"
max = 1.0
share = 0.5
of = "asc"
)");
  // asc: 10 and 20 mm, so that 6 and 11 mm are allowed.
  const SweepResult good = made_up(experiment, [](std::size_t row, std::size_t level) {
    return row == 0 ? (level == 0 ? 10.0 : 20.0) : (level == 0 ? 5.9 : 10.9);
  });
  const Report held(experiment, good);
  EXPECT_TRUE(held.missed_bounds().empty());
  EXPECT_EQ(held.check_bounds().front().max, 6.0);
  EXPECT_NE(held.markdown().find("Acceptance: 2 of 2 bounds hold"), std::string::npos);

  const SweepResult bad = made_up(experiment, [](std::size_t row, std::size_t level) {
    if (row == 0 && level == 1) return std::optional<double>();
    return std::optional(row == 0 ? 10.0 : 6.1);
  });
  const std::vector<std::string> missed = Report(experiment, bad).missed_bounds();
  ASSERT_EQ(missed.size(), 2u);
  EXPECT_NE(missed[0].find("6.1, above 6"), std::string::npos) << missed[0];
  EXPECT_NE(missed[1].find("cannot be judged: it is absent in asc"), std::string::npos);
}

TEST_F(Sweeps, TellWhichUnnamedValueIsNearestToThePrintedFigures) {
  const Experiment experiment = load(tiny_but(
      "profile = \"nominal\"\n[paper.metrics]",
      "profile = \"nominal\"\naxis = \"plant.friction\"\namong = [0.6, 0.8]\n[paper.metrics]"));
  // Printed are 11.2 mm: a factor of 2 below one and of 4 above the other.
  const SweepResult result =
      made_up(experiment, [](std::size_t, std::size_t level) { return level == 0 ? 22.4 : 2.8; });
  const std::string text = Report(experiment, result).markdown();
  EXPECT_NE(text.find("- ASC: nearest is 0.6 (0.6 2, 0.8 4)."), std::string::npos) << text;
}

TEST_F(Sweeps, SayOnceWhatAllRowsHaveInCommon) {
  const Experiment experiment = load();
  const std::string text =
      Report(experiment, made_up(experiment, [](auto, auto) { return 1.0; })).markdown();
  EXPECT_NE(text.find("Everywhere: terrain flat; torsional friction 0.005 m;"), std::string::npos)
      << text;
  EXPECT_NE(text.find("| row | duty | tracker | plant.friction | falls |"), std::string::npos)
      << text;
}

TEST_F(Sweeps, EscapeLabelsInEveryTable) {
  const std::string label = "a|b `c` *d* <script>e</script> \\\\ [f](g) _h_";
  std::string text = tiny_but("label = \"asc\"", "label = \"" + label + "\"");
  text.replace(text.find("ladder = [\"asc\""), 15, "ladder = [\"" + label + "\"");
  text.replace(text.find("radius, mm"), 10, "r|s, <b>");
  text.insert(0, "title = \"t <i>\"\nnote = \"*n* <i>\"\n");
  const Experiment experiment = load(text);
  const SweepResult result =
      made_up(experiment, [](std::size_t row, auto) { return row == 0 ? Number() : Number(1.0); });
  const Report report(experiment, result);
  const std::string page = report.markdown();
  const std::string shown = "a\\|b \\`c\\` \\*d\\* &lt;script>e&lt;/script> \\\\ [f\\](g) \\_h\\_";
  EXPECT_NE(page.find("\n| " + shown + " |"), page.npos) << page;
  EXPECT_NE(page.find("\n- " + shown + ", plant.friction 0.6: 2 of 2\n"), page.npos) << page;
  EXPECT_NE(page.find(": " + shown + " fell -> ours"), page.npos) << page;
  EXPECT_NE(page.find("| r\\|s, &lt;b> |"), page.npos) << page;
  EXPECT_NE(page.find("# t &lt;i>\n"), page.npos) << page;
  EXPECT_NE(page.find("\n*n* &lt;i>\n"), page.npos) << page;
  EXPECT_EQ(page.find('<'), page.npos) << page;
  EXPECT_EQ(page.find('{'), page.npos) << page;  // every text is filled
  EXPECT_NE(report.csv().find("\na|b `c` *d* <script>e</script> \\ [f](g) _h_,nominal,"), page.npos)
      << report.csv();
}

TEST(TrialKey, StandsForTheConfiguration) {
  Config config = load_config().value();
  const std::string key = trial_key(config);
  EXPECT_EQ(key.size(), 16u);
  EXPECT_EQ(key, trial_key(load_config().value()));
  config.run.seed += 1;
  EXPECT_NE(key, trial_key(config));
}

}  // namespace
}  // namespace pirouette
