#include "pirouette/trial/run_folder.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

#include "pirouette/plant/terrain.hpp"
#include "support/temp_folder.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class RunFolderTest : public test::TempFolderTest {
 protected:
  /// A complete run whose metrics.json says `metrics`.
  static void leave_run(const fs::path& path, const std::string& metrics, bool replace = false) {
    Result<RunFolder> folder = RunFolder::open(path, {replace, 0});
    ASSERT_TRUE(folder.ok()) << folder.errors().front().to_string();
    ASSERT_FALSE(folder.value().write(kRunFile, "x = 1\n"));
    ASSERT_FALSE(folder.value().write(kMetricsFile, metrics));
    const auto error = folder.value().commit();
    ASSERT_FALSE(error) << error->to_string();
  }

  static std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};

TEST_F(RunFolderTest, AppearsOnlyWhenItIsComplete) {
  const fs::path path = folder_ / "runs" / "a";
  {
    Result<RunFolder> folder = RunFolder::open(path);
    ASSERT_TRUE(folder.ok());
    ASSERT_FALSE(folder.value().write(kRunFile, "x = 1\n"));
    EXPECT_FALSE(fs::exists(path));
    ASSERT_FALSE(folder.value().commit());
    EXPECT_EQ(content(path / kRunFile), "x = 1\n");
  }
  EXPECT_TRUE(fs::exists(path / kRunFile)) << "still there after the object is gone";
  EXPECT_EQ(entries(folder_ / "runs"), 1u);
}

TEST_F(RunFolderTest, LeavesNothingWithoutACommit) {
  {
    Result<RunFolder> folder = RunFolder::open(folder_ / "deep" / "er" / "a");
    ASSERT_TRUE(folder.ok());
    ASSERT_FALSE(folder.value().write(kRunFile, "x = 1\n"));
    const RunFolder moved = std::move(folder).value();
    EXPECT_TRUE(fs::exists(moved.file(kRunFile)));
  }
  EXPECT_EQ(entries(folder_), 0u);
}

TEST_F(RunFolderTest, KeepsParentsThatSomebodyElseUsesMeanwhile) {
  {
    const Result<RunFolder> folder = RunFolder::open(folder_ / "runs" / "a");
    ASSERT_TRUE(folder.ok());
    std::ofstream(folder_ / "runs" / "note") << "mine";
  }
  EXPECT_EQ(content(folder_ / "runs" / "note"), "mine");
}

TEST_F(RunFolderTest, ReplacesTheFilesOfAnEarlierRunAndNothingElse) {
  {
    Result<RunFolder> folder = RunFolder::open(folder_ / "a");
    ASSERT_TRUE(folder.ok());
    for (const char* name : {kRunFile, kMetricsFile, kTraceFile}) {
      ASSERT_FALSE(folder.value().write(name, "1"));
    }
    ASSERT_FALSE(folder.value().commit());
  }
  fs::create_directory(folder_ / "a" / "notes");
  std::ofstream(folder_ / "a" / "notes" / "n") << "mine";
  leave_run(folder_ / "a", "2", true);
  EXPECT_EQ(content(folder_ / "a" / kMetricsFile), "2");
  EXPECT_FALSE(fs::exists(folder_ / "a" / kTraceFile)) << "of the earlier run";
  EXPECT_EQ(content(folder_ / "a" / "notes" / "n"), "mine");
  EXPECT_EQ(entries(folder_), 1u);
}

TEST_F(RunFolderTest, ReplacesNothingUnasked) {
  leave_run(folder_ / "a", "1");
  EXPECT_FALSE(RunFolder::open(folder_ / "a").ok());
  EXPECT_EQ(content(folder_ / "a" / kMetricsFile), "1");
}

TEST_F(RunFolderTest, NeverReplacesAFileThatTheRecordDoesNotList) {
  leave_run(folder_ / "a", "1");
  std::ofstream(folder_ / "a" / kTraceFile) << "mine";
  EXPECT_FALSE(RunFolder::open(folder_ / "a", {true, 0}).ok());
  EXPECT_EQ(content(folder_ / "a" / kTraceFile), "mine");
}

TEST_F(RunFolderTest, DoesNotBelieveARecordThatListsOtherFiles) {
  leave_run(folder_ / "a", "1");
  std::ofstream(folder_ / "thesis.tex") << "years";
  std::ofstream(folder_ / "a" / "data.csv") << "mine";
  std::ofstream(folder_ / "a" / kRecordFile, std::ios::app) << "../thesis.tex\ndata.csv\n";
  leave_run(folder_ / "a", "2", true);
  EXPECT_EQ(content(folder_ / "thesis.tex"), "years");
  EXPECT_EQ(content(folder_ / "a" / "data.csv"), "mine");
}

TEST_F(RunFolderTest, TakesTheNextNameThatIsFree) {
  leave_run(folder_ / "a", "1");
  const Result<RunFolder> second = RunFolder::open_next(folder_ / "a");
  ASSERT_TRUE(second.ok());
  EXPECT_EQ(second.value().path(), folder_ / "a-2");
  const Result<RunFolder> third = RunFolder::open_next(folder_ / "a");
  ASSERT_TRUE(third.ok()) << "while the second is being written";
  EXPECT_EQ(third.value().path(), folder_ / "a-3");
}

TEST_F(RunFolderTest, IsForOneProcessAtATime) {
  const Result<RunFolder> first = RunFolder::open(folder_ / "a");
  ASSERT_TRUE(first.ok());
  EXPECT_FALSE(RunFolder::open(folder_ / "a").ok());
}

TEST_F(RunFolderTest, CleansUpAfterAKilledProcess) {
  const fs::path part = folder_ / ".b.pirouette-part";
  fs::create_directory(part);
  std::ofstream(part / kTraceFile) << "half";
  std::ofstream(part / "lock") << "part of a run that pirouette writes\n";
  const fs::path with_notes = folder_ / ".c.pirouette-part";
  fs::create_directory(with_notes);
  std::ofstream(with_notes / "note") << "mine";
  leave_run(folder_ / "a", "1");
  EXPECT_FALSE(fs::exists(part));
  EXPECT_EQ(content(with_notes / "note"), "mine");
}

TEST_F(RunFolderTest, LeavesWhatOnlyLooksLikeAPartOfARunAlone) {
  const auto fill = [](const fs::path& folder) {
    fs::create_directory(folder);
    for (const char* name : {kRunFile, kMetricsFile, kTraceFile, "lock"}) {
      std::ofstream(folder / name) << "mine";
    }
  };
  const auto is_whole = [](const fs::path& folder) {
    return content(folder / kRunFile) == "mine" && content(folder / kMetricsFile) == "mine" &&
           content(folder / kTraceFile) == "mine" && content(folder / "lock") == "mine";
  };
  const fs::path linked = folder_ / "precious", named = folder_ / ".b.pirouette-part";
  fill(linked);
  fill(named);
  fs::create_directory_symlink(linked, folder_ / ".x.pirouette-part");
  leave_run(folder_ / "a", "1");
  EXPECT_TRUE(is_whole(linked));
  EXPECT_TRUE(is_whole(named));
  // In the way of a run's own part.
  EXPECT_FALSE(RunFolder::open(folder_ / "x").ok());
  EXPECT_FALSE(RunFolder::open(folder_ / "b").ok());
  EXPECT_TRUE(is_whole(linked));
  EXPECT_TRUE(is_whole(named));
}

TEST_F(RunFolderTest, IsNotNamedLikeAPart) {
  EXPECT_FALSE(RunFolder::open(folder_ / ".x.pirouette-part").ok());
}

TEST_F(RunFolderTest, AnEmptyFolderThatIsThereStaysTheSameFolder) {
  const fs::path path = folder_ / "a";
  fs::create_directory(path);
  fs::permissions(path, fs::perms::owner_all);
  const fs::path before = fs::current_path();
  fs::current_path(path);
  leave_run(".", "1");
  EXPECT_EQ(fs::current_path(), path);  // a moved folder would be gone
  fs::current_path(before);
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
  EXPECT_EQ(content(path / kMetricsFile), "1");
}

TEST_F(RunFolderTest, ReplacesWhatWasMadeOfAnEarlierRunAndRecorded) {
  const fs::path path = folder_ / "a";
  leave_run(path, "1");
  for (const char* name : {"trace.csv", "trace.mcap"}) std::ofstream(path / name) << "old";
  std::ofstream(path / kRecordFile, std::ios::app) << "trace.csv\n";
  leave_run(path, "2", true);
  EXPECT_FALSE(fs::exists(path / "trace.csv"));
  EXPECT_EQ(content(path / "trace.mcap"), "old");  // not in the record
}

TEST_F(RunFolderTest, RefusesALinkToNothingAndADiskThatIsTooSmall) {
  fs::create_symlink(folder_ / "nowhere", folder_ / "link");
  EXPECT_FALSE(RunFolder::open(folder_ / "link").ok());
  EXPECT_FALSE(RunFolder::open(folder_ / "link" / "a").ok());
  constexpr std::uintmax_t kExabyte = 1'000'000'000'000'000'000U;
  EXPECT_FALSE(RunFolder::open(folder_ / "a", {false, kExabyte}).ok());
  EXPECT_FALSE(fs::exists(folder_ / "a"));
}

TEST_F(RunFolderTest, KeepsTheEarlierRunWhenTheNewOneFails) {
  leave_run(folder_ / "a", "1");
  { ASSERT_TRUE(RunFolder::open(folder_ / "a", {true, 0}).ok()); }
  EXPECT_EQ(content(folder_ / "a" / kMetricsFile), "1");
  EXPECT_EQ(entries(folder_), 1u);
}

TEST_F(RunFolderTest, TakesAnEmptyFolderAndATrailingSlash) {
  fs::create_directory(folder_ / "a");
  leave_run((folder_ / "a").string() + "/", "1");
  EXPECT_TRUE(fs::exists(folder_ / "a" / kMetricsFile));
  EXPECT_EQ(entries(folder_), 1u);
}

TEST_F(RunFolderTest, FollowsALinkToTheRunItReplaces) {
  leave_run(folder_ / "a", "1");
  fs::create_directory_symlink(folder_ / "a", folder_ / "latest");
  leave_run(folder_ / "latest", "2", true);
  EXPECT_TRUE(fs::is_symlink(folder_ / "latest"));
  EXPECT_EQ(content(folder_ / "a" / kMetricsFile), "2");
}

TEST_F(RunFolderTest, NeverTouchesAFolderThatIsNoRun) {
  fs::create_directory(folder_ / "a");
  std::ofstream(folder_ / "a" / "thesis.tex") << "years";
  EXPECT_FALSE(RunFolder::open(folder_ / "a").ok());
  EXPECT_EQ(content(folder_ / "a" / "thesis.tex"), "years");
  EXPECT_EQ(entries(folder_), 1u);
}

TEST_F(RunFolderTest, NeverReplacesAFolderThatFilledMeanwhile) {
  Result<RunFolder> folder = RunFolder::open(folder_ / "a");
  ASSERT_TRUE(folder.ok());
  fs::create_directory(folder_ / "a");
  std::ofstream(folder_ / "a" / "thesis.tex") << "years";
  EXPECT_TRUE(folder.value().commit());
  EXPECT_EQ(content(folder_ / "a" / "thesis.tex"), "years");
}

TEST_F(RunFolderTest, RefusesAFileAnEmptyNameAndAPlaceBelowAFile) {
  std::ofstream(folder_ / "file") << "x";
  EXPECT_FALSE(RunFolder::open(folder_ / "file").ok());
  EXPECT_FALSE(RunFolder::open(folder_ / "file" / "a").ok());
  EXPECT_FALSE(RunFolder::open("").ok());
  EXPECT_EQ(content(folder_ / "file"), "x");
}

TEST_F(RunFolderTest, ReportsAPlaceWhereNothingCanBeWritten) {
  const Result<RunFolder> folder = RunFolder::open("/proc/pirouette/a");
  ASSERT_FALSE(folder.ok());
  EXPECT_EQ(folder.errors().front().file, "/proc/pirouette/a");
}

TEST_F(RunFolderTest, HoldsTheHeightsOfTheGroundForNumPy) {
  const Result<RunFolder> folder = RunFolder::open(folder_ / "a");
  ASSERT_TRUE(folder.ok());
  const std::string text = "slope:10+rough:0.04";
  ASSERT_FALSE(write_terrain(folder.value(), text, 7));

  const std::string bytes = content(folder.value().file(kTerrainFile));
  const std::size_t data = bytes.find('\n') + 1;
  EXPECT_EQ(data % 64, 0U);
  EXPECT_NE(bytes.find("{'descr': '<f4', 'fortran_order': False, 'shape': (301, 301), }"),
            bytes.npos);
  constexpr std::size_t kSide = 301;
  std::vector<float> heights(kSide * kSide);
  ASSERT_EQ(bytes.size(), data + heights.size() * sizeof(float));
  std::memcpy(heights.data(), bytes.data() + data, heights.size() * sizeof(float));

  const Terrain terrain(parse_terrain(text).value(), 7);
  const auto at = [&](std::size_t row, std::size_t column) {
    return heights[row * kSide + column];
  };
  EXPECT_FLOAT_EQ(at(0, 0), static_cast<float>(terrain.height({-1.5, -1.5})));
  EXPECT_FLOAT_EQ(at(0, 300), static_cast<float>(terrain.height({1.5, -1.5})));
  EXPECT_FLOAT_EQ(at(150, 170), static_cast<float>(terrain.height({0.2, 0.0})));
}

TEST_F(RunFolderTest, NamesATerrainThatThereIsNot) {
  const Result<RunFolder> folder = RunFolder::open(folder_ / "a");
  ASSERT_TRUE(folder.ok());
  EXPECT_EQ(write_terrain(folder.value(), "moon", 7)->key, "plant.terrain");
}

}  // namespace
}  // namespace pirouette
