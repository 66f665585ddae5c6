// The loader against right and wrong configurations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/toml.hpp"
#include "support/robot_text.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

std::string read(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// A folder of its own for each test, removed afterwards.
class ConfigFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / ("pirouette_config_" + std::string(info->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    unsetenv("PIROUETTE_DATA_DIR");
    fs::remove_all(folder_);
  }

  Result<Config> load(const std::string& toml, std::vector<std::string> overrides = {}) {
    const fs::path file = folder_ / "my.toml";
    write(file, toml);
    return load_config({.file = file, .overrides = std::move(overrides)});
  }

  /// The one error of `toml`, without the folder's name; what else came is a failure.
  std::string error_of(const std::string& toml, std::vector<std::string> overrides = {}) {
    const Result<Config> config = load(toml, std::move(overrides));
    if (config) return "no error";
    EXPECT_EQ(config.errors().size(), 1u) << text_of(config.errors());
    std::string text = config.errors().front().to_string();
    const std::string prefix = folder_.string() + "/";
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
    return text;
  }

  static std::string text_of(const Errors& errors) {
    std::string text;
    for (const Error& error : errors) text += error.to_string() + "\n";
    return text;
  }

  /// A data folder with robots `ant` (no overlay) and `bee` (with one), and the bundles.
  void use_own_data_folder(const std::string& bee_overlay) {
    const fs::path data = folder_ / "data";
    write(data / "robots" / "ant" / "ant.xml", test::text_of_robot());
    write(data / "robots" / "bee" / "bee.xml", test::text_of_robot());
    write(data / "config" / "robots" / "bee.toml", bee_overlay);
    write(data / "config" / "controllers" / "mit.toml", "[gait]\nduty = 0.5\n");
    write(data / "config" / "controllers" / "pirouette.toml", "[gait]\nduty = 0.6\n");
    write(data / "config" / "plants" / "nominal.toml", "");
    write(data / "config" / "plants" / "rough.toml", "[plant]\nfriction = 0.4\nimpratio = 5\n");
    setenv("PIROUETTE_DATA_DIR", data.c_str(), 1);
  }

  fs::path folder_;
};

std::string error_of_override(const std::string& text) {
  const Result<Config> config = load_config({.overrides = {text}});
  if (config) return "no error";
  EXPECT_EQ(config.errors().size(), 1u);
  return config.errors().front().to_string();
}

// Doubles print as their shortest exact decimals, so equal dumps are equal configurations.
void expect_same(const Config& a, const Config& b) { EXPECT_EQ(dump_toml(a), dump_toml(b)); }

TEST_F(ConfigFiles, WithoutAnyChoiceTheDefaultsHold) {
  const Result<Config> config = load_config();
  ASSERT_TRUE(config) << text_of(config.errors());
  expect_same(config.value(), Config{});
}

TEST_F(ConfigFiles, DefaultTomlIsTheDumpOfTheDefaults) {
  const fs::path file = fs::path(PIROUETTE_SOURCE_DIR) / "config" / "default.toml";
  EXPECT_EQ(read(file), dump_toml(Config{})) << "refresh it: make config";
}

TEST_F(ConfigFiles, DumpReadsBackToTheLastBit) {
  Config config;
  config.robot = "mini_cheetah";
  config.controller = "asc";
  config.gait.period = 1.0 / 3.0;
  config.com.width = 0.1 + 0.2;
  config.estimation.process_foot = 1.2345678901234567e-9;
  config.path.state_weight = {1e6, 0.0, 2.0 / 3.0};
  config.mpc.horizon = 17;
  config.run.seed = 8999999999999999;
  config.run.rate = -0.7;
  config.foot.model = FootModel::kCentre;
  config.com.weight = PspWeight::kPolynomial;
  config.plant.sensors.ideal = true;
  config.plant.terrain = "odd \"name\" with \\ and \t and é";
  const Result<Config> back = load(dump_toml(config));
  ASSERT_TRUE(back) << text_of(back.errors());
  expect_same(back.value(), config);
  EXPECT_EQ(back.value().gait.period, config.gait.period);
  EXPECT_EQ(back.value().estimation.process_foot, config.estimation.process_foot);
  EXPECT_EQ(back.value().plant.terrain, config.plant.terrain);
}

TEST_F(ConfigFiles, EveryDefaultLiesInItsOwnRange) {
  // Loading checks each value of the dump against the range of its line.
  EXPECT_TRUE(load(dump_toml(Config{})));
}

TEST_F(ConfigFiles, LaterLayersWin) {
  use_own_data_folder("[gait]\nduty = 0.7\nperiod = 0.4\nswing_height = 0.09\nstand_time = 2.0\n");
  const Result<Config> config = load("robot = 'bee'\n[gait]\nperiod = 0.3\nstand_time = 3.0\n",
                                     {"gait.stand_time=4", "gait.stand_time=5"});
  ASSERT_TRUE(config) << text_of(config.errors());
  const GaitConfig& gait = config.value().gait;
  EXPECT_EQ(gait.early_contact_progress, GaitConfig{}.early_contact_progress);  // struct default
  EXPECT_EQ(gait.swing_height, 0.09);                                           // robot overlay
  EXPECT_EQ(gait.duty, 0.6);                                                    // controller bundle
  EXPECT_EQ(gait.period, 0.3);                                                  // user's file
  EXPECT_EQ(gait.stand_time, 5.0);                                              // last override
}

TEST_F(ConfigFiles, RobotAndControllerComeFromTheHighestLayerThatNamesThem) {
  use_own_data_folder("[gait]\nswing_height = 0.09\n");
  write(folder_ / "my.toml", "robot = 'bee'\ncontroller = 'mit'\n");
  const fs::path file = folder_ / "my.toml";

  const Config from_file = load_config({.file = file}).value();
  EXPECT_EQ(from_file.robot, "bee");
  EXPECT_EQ(from_file.gait.swing_height, 0.09);
  EXPECT_EQ(from_file.gait.duty, 0.5);

  const Config overridden =
      load_config({.file = file, .overrides = {"robot=ant", "controller=pirouette"}}).value();
  EXPECT_EQ(overridden.robot, "ant");
  EXPECT_EQ(overridden.gait.swing_height, GaitConfig{}.swing_height);
  EXPECT_EQ(overridden.gait.duty, 0.6);

  const Config flagged = load_config({.robot = "bee",
                                      .controller = "mit",
                                      .file = file,
                                      .overrides = {"robot=ant", "controller=pirouette"}})
                             .value();
  EXPECT_EQ(flagged.robot, "bee");
  EXPECT_EQ(flagged.controller, "mit");
  EXPECT_EQ(flagged.gait.duty, 0.5);
}

TEST_F(ConfigFiles, AProfileLiesBetweenTheControllerAndTheUsersFile) {
  use_own_data_folder("[plant]\nfriction = 0.6\ntimestep = 5e-4\n");
  const Result<Config> config = load("robot = 'bee'\nprofile = 'rough'\n[plant]\nimpratio = 20\n");
  ASSERT_TRUE(config) << text_of(config.errors());
  EXPECT_EQ(config.value().profile, "rough");
  EXPECT_EQ(config.value().plant.timestep, 5e-4);
  EXPECT_EQ(config.value().plant.friction, 0.4);
  EXPECT_EQ(config.value().plant.impratio, 20.0);
  EXPECT_EQ(error_of("robot = 'bee'\nprofile = 'rogh'\n"),
            "my.toml:2: profile: given \"rogh\"; allowed: nominal, rough; did you mean rough?");
}

TEST_F(ConfigFiles, AnOverlayMayNotChooseTheRobot) {
  use_own_data_folder("robot = 'ant'\n");
  const Result<Config> config = load_config({.robot = "bee"});
  ASSERT_FALSE(config);
  EXPECT_NE(config.errors()[0].to_string().find("bee.toml:1: robot: not allowed here"),
            std::string::npos)
      << text_of(config.errors());
}

TEST_F(ConfigFiles, TheBundlesAreThePapersSteps) {
  const auto bundle = [](const char* name) { return load_config({.controller = name}).value(); };
  EXPECT_EQ(bundle("mit").foot.model, FootModel::kCentre);
  EXPECT_EQ(bundle("mit").path.reference, PathReferenceMode::kIntegrated);
  EXPECT_EQ(bundle("fkm").foot.model, FootModel::kRolling);
  EXPECT_EQ(bundle("fkm").path.tracker, PathTracker::kNone);
  EXPECT_EQ(bundle("asc").path.reference, PathReferenceMode::kAnchored);
  EXPECT_EQ(bundle("asc").path.tracker, PathTracker::kLqr);
  EXPECT_EQ(bundle("pirouette").path.tracker, PathTracker::kLqi);
  for (const char* name : {"mit", "fkm", "asc"}) {
    EXPECT_EQ(bundle(name).gait.duty, 0.5) << name;
    EXPECT_EQ(bundle(name).com.planner, ComPlanner::kPsp) << name;
  }
}

TEST_F(ConfigFiles, OverridesAreTomlOrBareWords) {
  const Result<Config> config =
      load_config({.overrides = {"foot.model=centre", "path.tracker = \"lqr\"",
                                 "plant.terrain=stairs:0.03x0.20", "gait.period=1",
                                 "path.state_weight=[1, 2.5, 3e0]", "plant.sensors.ideal=true",
                                 "mpc={horizon = 12}", "run.seed=42"}});
  ASSERT_TRUE(config) << text_of(config.errors());
  EXPECT_EQ(config.value().foot.model, FootModel::kCentre);
  EXPECT_EQ(config.value().path.tracker, PathTracker::kLqr);
  EXPECT_EQ(config.value().plant.terrain, "stairs:0.03x0.20");
  EXPECT_EQ(config.value().gait.period, 1.0);
  EXPECT_EQ(config.value().path.state_weight, (std::array<double, 3>{1.0, 2.5, 3.0}));
  EXPECT_TRUE(config.value().plant.sensors.ideal);
  EXPECT_EQ(config.value().mpc.horizon, 12);
  EXPECT_EQ(config.value().run.seed, 42);
}

TEST_F(ConfigFiles, OutOfRangeNamesFileLineKeyValueAndRange) {
  EXPECT_EQ(error_of("# mine\n[gait]\nperiod = 5.0\n"),
            "my.toml:3: gait.period: given 5.0; allowed: 0.15 to 2 s");
  EXPECT_EQ(error_of("[mpc]\nhorizon = 1\n"),
            "my.toml:2: mpc.horizon: given 1; allowed: whole number, 2 to 24 steps");
  EXPECT_EQ(error_of("run.seed = -1\n"),
            "my.toml:1: run.seed: given -1; allowed: whole number, 0 to 9e15");
  EXPECT_EQ(error_of_override("plant.friction=-0.1"),
            "--set: plant.friction: given -0.1; allowed: 0 to 5");
}

TEST_F(ConfigFiles, BoundsThemselvesAreAllowed) {
  EXPECT_TRUE(load_config({.overrides = {"gait.period=0.15", "gait.duty=0.4"}}));
  EXPECT_TRUE(load_config({.overrides = {"gait.period=2"}}));
}

TEST_F(ConfigFiles, NonFiniteNumbersAreErrors) {
  for (const char* value : {"nan", "+nan", "inf", "-inf"}) {
    EXPECT_NE(error_of("gait.period = " + std::string(value) + "\n").find("allowed: 0.15 to 2 s"),
              std::string::npos)
        << value;
  }
}

TEST_F(ConfigFiles, WrongTypesAreErrors) {
  EXPECT_EQ(error_of("[gait]\nperiod = true\n"),
            "my.toml:2: gait.period: given true; allowed: 0.15 to 2 s");
  EXPECT_EQ(error_of("[gait]\nperiod = '0.5'\n"),
            "my.toml:2: gait.period: given \"0.5\"; allowed: 0.15 to 2 s");
  EXPECT_EQ(error_of("[mpc]\nhorizon = 10.0\n"),
            "my.toml:2: mpc.horizon: given 10.0; allowed: whole number, 2 to 24 steps");
  EXPECT_EQ(error_of("[foothold]\nfeedback = 1\n"),
            "my.toml:2: foothold.feedback: given 1; allowed: true, false");
  EXPECT_EQ(error_of("[foot]\nmodel = 1\n"),
            "my.toml:2: foot.model: given 1; allowed: centre, rolling");
  EXPECT_EQ(error_of("[plant]\nterrain = 3\n"),
            "my.toml:2: plant.terrain: given 3; allowed: a text in quotes");
  EXPECT_EQ(error_of("gait = 3\n"), "my.toml:1: gait: given 3; allowed: a table of parameters");
  EXPECT_EQ(error_of("[gait.period]\n"),
            "my.toml:1: gait.period: given a table; allowed: 0.15 to 2 s");
}

TEST_F(ConfigFiles, UnknownEnumValuesListTheKnownOnes) {
  EXPECT_EQ(error_of("[path]\n\ntracker = 'lqg'\n"),
            "my.toml:3: path.tracker: given \"lqg\"; allowed: none, lqr, lqi");
  EXPECT_EQ(error_of_override("foot.model=roling"),
            "--set: foot.model: given \"roling\"; allowed: centre, rolling");
}

TEST_F(ConfigFiles, ListsOfWrongLengthOrContentAreErrors) {
  const std::string allowed = "allowed: 3 numbers, each 0 to 1e6 (1/m^2, 1/m^2, 1/rad^2)";
  for (const char* value : {"[1.0, 2.0]", "[1, 2, 3, 4]", "[]", "1.0", "[1, true, 3]",
                            "[1.0, -1.0, 1.0]", "[1.0, nan, 1.0]"}) {
    EXPECT_NE(error_of("path.state_weight = " + std::string(value) + "\n").find(allowed),
              std::string::npos)
        << value;
  }
}

TEST_F(ConfigFiles, TyposAreAnsweredWithTheNearestKey) {
  EXPECT_EQ(error_of("[gait]\nperod = 0.5\n"),
            "my.toml:2: gait.perod: unknown key; did you mean gait.period?");
  EXPECT_EQ(error_of("[gaitt]\nperiod = 0.5\n"),
            "my.toml:1: gaitt: unknown key; did you mean gait?");
  EXPECT_EQ(error_of_override("plant.sensor.ideal=true"),
            "--set: plant.sensor: unknown key; did you mean plant.sensors?");
  EXPECT_EQ(error_of("torsional_friction = 0.01\n"),
            "my.toml:1: torsional_friction: unknown key; did you mean plant.torsional_friction?");
}

TEST_F(ConfigFiles, AKeyThatCountedTicksIsAnsweredWithTheTimeThatStandsForIt) {
  EXPECT_EQ(error_of("[mpc]\nticks_per_solve = 12\n"),
            "my.toml:2: mpc.ticks_per_solve: unknown key; it is mpc.solve_period now, in s");
  EXPECT_EQ(error_of_override("safety.max_repeated_samples=50"),
            "--set: safety.max_repeated_samples: unknown key; it is safety.max_repeat_time now, "
            "in s");
}

TEST_F(ConfigFiles, AnUnknownKeyWithoutANearOneListsWhatIsAllowedThere) {
  EXPECT_EQ(error_of("[control]\nwhatever_this_is = 0.5\n"),
            "my.toml:2: control.whatever_this_is: unknown key; allowed here: rate");
}

TEST_F(ConfigFiles, AllErrorsComeAtOnceInTheOrderOfTheFile) {
  const Result<Config> config =
      load("[run]\nturns = -1\nsed = 3\n[gait]\nduty = 2\nperiod = 'x'\n", {"foo=1", "nonsense"});
  ASSERT_FALSE(config);
  std::vector<std::string> places;
  for (const Error& e : config.errors()) {
    places.push_back(fs::path(e.file).filename().string() + ":" + std::to_string(e.line) + " " +
                     e.key);
  }
  EXPECT_EQ(places, (std::vector<std::string>{"--set:0 ", "my.toml:2 run.turns",
                                              "my.toml:3 run.sed", "my.toml:5 gait.duty",
                                              "my.toml:6 gait.period", "--set:0 foo"}));
}

TEST_F(ConfigFiles, SyntaxErrorsAndDuplicatesNameTheirLine) {
  EXPECT_TRUE(error_of("[gait]\nperiod = 0.5 0.6\n").starts_with("my.toml:2: "));
  EXPECT_TRUE(error_of("[gait]\nperiod = 0.5\nperiod = 0.6\n").starts_with("my.toml:3: "));
}

TEST_F(ConfigFiles, AMissingFileIsAnError) {
  const Result<Config> config = load_config({.file = "/nowhere/my.toml"});
  ASSERT_FALSE(config);
  EXPECT_EQ(config.errors()[0].to_string(), "/nowhere/my.toml: no such file");
  EXPECT_FALSE(load_config({.file = folder_}));
}

TEST_F(ConfigFiles, AMissingDataFolderIsNamed) {
  setenv("PIROUETTE_DATA_DIR", "/nowhere", 1);
  const Result<Config> config = load_config();
  ASSERT_FALSE(config);
  EXPECT_EQ(config.errors()[0].to_string(),
            "/nowhere: no folder config/ here; set PIROUETTE_DATA_DIR to where config/ and robots/ "
            "are");
}

TEST_F(ConfigFiles, MalformedOverridesShowTheForm) {
  for (const char* text :
       {"", "=", "gait.period", "gait.period=", "=0.5", "gait..period=0.5", "gait period=0.5",
        "gait.period=[0.5", "foot.model=\"rolling", "gait.period=0.5\nfoo=1"}) {
    EXPECT_NE(error_of_override(text).find("allowed: key=value, such as gait.period=0.3"),
              std::string::npos)
        << text;
  }
}

TEST_F(ConfigFiles, AnUnknownRobotListsTheKnownOnes) {
  use_own_data_folder("");
  EXPECT_EQ(error_of("robot = 'bea'\n"),
            "my.toml:1: robot: given \"bea\"; allowed: ant, bee; did you mean bee?; or the path of "
            "an MJCF (.xml), URDF (.urdf) or robot.toml file");
  const Result<Config> flagged = load_config({.robot = "nowhere.xml"});
  ASSERT_FALSE(flagged);
  EXPECT_EQ(flagged.errors()[0].to_string(), "--robot: robot: given \"nowhere.xml\": no such file");
}

TEST_F(ConfigFiles, AnUnknownControllerListsTheKnownOnes) {
  const Result<Config> config = load_config({.controller = "mitt"});
  ASSERT_FALSE(config);
  EXPECT_EQ(config.errors()[0].to_string(),
            "--controller: controller: given \"mitt\"; allowed: asc, fkm, mit, pirouette; did you "
            "mean mit?");
}

TEST_F(ConfigFiles, ARobotIsAFolderNameOrAFile) {
  use_own_data_folder("");
  Config config;
  config.robot = "ant";
  EXPECT_EQ(resolve_robot(config).value().file, (data_dir() / "robots/ant/ant.xml").string());
  write(folder_ / "mine.xml", "<mujoco/>");
  config.robot = (folder_ / "mine.xml").string();
  EXPECT_EQ(resolve_robot(config).value().file, config.robot);
  config.robot = "../robots/ant";
  EXPECT_FALSE(resolve_robot(config));
}

TEST_F(ConfigFiles, RelationsBetweenParametersAreChecked) {
  EXPECT_EQ(error_of("[plant]\ntimestep = 0.0015\n"),
            "my.toml:2: plant.timestep: given 0.0015 s; allowed: a whole fraction of the control "
            "period, 1/control.rate = 0.002 s");
  EXPECT_NE(error_of_override("control.rate=1500").find("plant.timestep"), std::string::npos);
  EXPECT_NE(error_of_override("run.trace_rate=501").find("control.rate = 500"), std::string::npos);
  EXPECT_NE(error_of("[mpc]\nmin_normal_force = 20\nmax_normal_force = 20\n")
                .find("my.toml:2: mpc.min_normal_force"),
            std::string::npos);
  EXPECT_NE(error_of("[gait]\nperiod = 0.2\nduty = 0.9\n").find("my.toml:3: gait.duty"),
            std::string::npos);
  EXPECT_NE(error_of("[mpc]\nhorizon = 2\nsolve_period = 0.2\n").find("within the horizon"),
            std::string::npos);
  EXPECT_NE(error_of("[terrain]\nstep_residual = 0.001\nstep_residual_release = 0.002\n")
                .find("my.toml:3: terrain.step_residual_release"),
            std::string::npos);
  EXPECT_NE(error_of("[plant.sensors]\naid_rate = 10\naid_delay = 1.1\n")
                .find("my.toml:3: plant.sensors.aid_delay"),
            std::string::npos);
}

TEST(GaitConfig, NeverShortensAStrideBelowTheShortestSwing) {
  GaitConfig gait;
  gait.duty = 0.8;
  for (const double rate : {0.0, 0.7, 3.0, -6.0, 10.0}) {
    const double stride = gait.period_at(rate);
    EXPECT_GE(stride * (1.0 - gait.duty), GaitConfig::kMinSwingTime - 1e-12) << rate;
    EXPECT_GE(stride * (1.0 - gait.step_duty_at(stride)), GaitConfig::kMinSwingTime - 1e-12)
        << rate;
  }
}

TEST_F(ConfigFiles, AControlRateThatTheTimestepDividesIsAccepted) {
  for (const char* rate : {"100", "200", "250", "500", "1000"}) {
    EXPECT_TRUE(load_config({.overrides = {"control.rate=" + std::string(rate)}})) << rate;
  }
  EXPECT_TRUE(load_config({.overrides = {"plant.timestep=0.0004", "control.rate=500"}}));
}

TEST(ConfigDoc, EveryKeyIsDocumentedOnceWithAMeaning) {
  std::vector<std::string> keys = list_keys();
  const std::string markdown = config_markdown();
  for (const ParameterGroup& group : describe(Config{})) {
    EXPECT_FALSE(group.meaning.empty()) << group.key;
    for (const ParameterInfo& parameter : group.parameters) {
      EXPECT_FALSE(parameter.meaning.empty()) << parameter.key;
      EXPECT_NE(markdown.find("| `" + parameter.key + "` |"), std::string::npos) << parameter.key;
    }
  }
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
  EXPECT_TRUE(std::binary_search(keys.begin(), keys.end(), "plant.sensors.gyro_bias"));
}

}  // namespace
}  // namespace pirouette
