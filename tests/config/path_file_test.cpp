// The loader of path files against right and wrong ones.
#include "pirouette/config/path_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace pirouette {
namespace {

namespace fs = std::filesystem;

class PathFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    file_ =
        fs::path(::testing::TempDir()) / ("pirouette_path_" + std::string(info->name()) + ".toml");
  }
  void TearDown() override { fs::remove(file_); }

  Result<PathFile> load(const std::string& toml) {
    std::ofstream(file_) << toml;
    return load_path_file(file_);
  }

  /// All errors of `toml`, one a line, without the file's folder.
  std::string errors_of(const std::string& toml) {
    const Result<PathFile> path = load(toml);
    if (path) return "no error";
    std::string text;
    for (const Error& error : path.errors()) {
      EXPECT_EQ(error.file, file_.string());
      text += std::to_string(error.line) + ": " + error.key + ": " + error.message + "\n";
    }
    return text;
  }

  fs::path file_;
};

TEST_F(PathFiles, OnlyPointsAreNeeded) {
  const Result<PathFile> path = load("points = [[0, 0], [1, 0.5]]");
  ASSERT_TRUE(path);
  ASSERT_EQ(path.value().points.size(), 2u);
  EXPECT_EQ(path.value().points[1], Vec2(1.0, 0.5));
  EXPECT_FALSE(path.value().closed);
  EXPECT_FALSE(path.value().hold_heading);
  EXPECT_EQ(path.value().travel_direction, 0.0);
  EXPECT_EQ(path.value().speed, 0.2);
}

TEST_F(PathFiles, HeadingIsAWordOrAnAngle) {
  const std::string points = "points = [[0, 0], [1, 0]]\n";
  EXPECT_TRUE(load(points + "heading = \"fixed\"").value().hold_heading);
  EXPECT_FALSE(load(points + "heading = \"tangent\"").value().hold_heading);
  EXPECT_NEAR(load(points + "heading = 90").value().travel_direction, kPi / 2.0, 1e-15);
  EXPECT_NEAR(load(points + "heading = -45.0").value().travel_direction, -kPi / 4.0, 1e-15);
}

TEST_F(PathFiles, EachWrongValueIsNamedWithItsLineAndWhatIsAllowed) {
  EXPECT_EQ(errors_of("points = [[0, 0], [1, 0]]\nspeed = 5"),
            "2: speed: given 5; allowed: 0.01 to 2 m/s\n");
  EXPECT_EQ(errors_of("points = [[0, 0], [1, 0]]\nclosed = 1"),
            "2: closed: given 1; allowed: true, false\n");
  EXPECT_EQ(
      errors_of("points = [[0, 0], [1, 0]]\nheading = \"north\""),
      "2: heading: given \"north\"; allowed: \"tangent\", \"fixed\", or the angle of the path "
      "from the front, -180 to 180 deg\n");
  EXPECT_EQ(errors_of("points = [[0, 0], [1, 0]]\nspede = 0.2"),
            "2: spede: unknown key; did you mean speed?\n");
  EXPECT_EQ(errors_of("points = [\n[0, 0],\n[1, nan],\n[2]]"),
            "3: points: given [1, nan]; allowed: [x, y] in m, each -1000 to 1000\n"
            "4: points: given [2]; allowed: [x, y] in m, each -1000 to 1000\n");
  EXPECT_EQ(errors_of("points = 3"),
            "1: points: allowed: a list of up to 10000 points [x, y] in m\n");
}

TEST_F(PathFiles, AllErrorsComeAtOnce) {
  EXPECT_EQ(errors_of("speed = 0\nclosed = \"no\""),
            "0: points: missing; a path needs points\n"
            "1: speed: given 0; allowed: 0.01 to 2 m/s\n"
            "2: closed: given \"no\"; allowed: true, false\n");
}

TEST_F(PathFiles, PointsMustMakeAPath) {
  EXPECT_EQ(errors_of("points = [[0, 0]]"), "1: points: given 1; allowed: 2 or more\n");
  EXPECT_EQ(errors_of("closed = true\npoints = [[0, 0], [1, 0]]"),
            "2: points: given 2; allowed: 3 or more of a closed path\n");
  EXPECT_EQ(errors_of("points = [[0, 0],\n[0.001, 0], [1, 0]]"),
            "2: points: given [0.001, 0] beside [0, 0]; allowed: 0.01 m apart and more\n");
  EXPECT_EQ(errors_of("closed = true\npoints = [[0, 0], [1, 0], [1, 1],\n[0, 0]]"),
            "3: points: the last is the first again, which closed adds\n");
}

TEST_F(PathFiles, ACurveThatTurnsBackOnItselfIsNamedWithItsPoints) {
  EXPECT_EQ(errors_of("points = [[0, 0],\n[1, 0],\n[0, 0]]"),
            "2: points: the curve turns back on itself between [0, 0] and [1, 0]; allowed: points "
            "through which a smooth curve runs forwards\n");
}

TEST_F(PathFiles, AFileThatIsNotThereOrNotTomlIsNamed) {
  EXPECT_NE(errors_of("points = [").find("1: : "), std::string::npos);
  EXPECT_EQ(load_path_file("nowhere.toml").errors().front().to_string(),
            "nowhere.toml: no such file");
}

TEST_F(PathFiles, RunPathIsAShippedNameOrAFile) {
  TrialConfig run;
  for (const std::string& name : known_paths()) {
    run.path = name;
    ASSERT_TRUE(resolve_path(run)) << name;
    EXPECT_TRUE(load_path_file(resolve_path(run).value())) << name;
  }
  run.path = "figure9";
  EXPECT_EQ(resolve_path(run).errors().front().to_string(),
            "run.path: given \"figure9\"; allowed: figure8, square; did you mean figure8?; or the "
            "path of a file ending in .toml");
  run.path = file_.string();
  EXPECT_FALSE(resolve_path(run));
  std::ofstream(file_) << "points = [[0, 0], [1, 0]]";
  EXPECT_EQ(resolve_path(run).value(), file_);
}

}  // namespace
}  // namespace pirouette
