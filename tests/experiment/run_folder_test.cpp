#include "pirouette/experiment/run_folder.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <sstream>

namespace pirouette {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class RunFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "pirouette-XXXXXX";
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    root_ = fs::canonical(pattern);
  }
  void TearDown() override { fs::remove_all(root_); }

  /// A complete run whose metrics.json says `metrics`.
  static void leave_run(const fs::path& path, const std::string& metrics) {
    Result<RunFolder> folder = RunFolder::open(path);
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

  fs::path root_;
};

TEST_F(RunFolderTest, AppearsOnlyWhenItIsComplete) {
  const fs::path path = root_ / "runs" / "a";
  {
    Result<RunFolder> folder = RunFolder::open(path);
    ASSERT_TRUE(folder.ok());
    ASSERT_FALSE(folder.value().write(kRunFile, "x = 1\n"));
    EXPECT_FALSE(fs::exists(path));
    ASSERT_FALSE(folder.value().commit());
    EXPECT_EQ(content(path / kRunFile), "x = 1\n");
  }
  EXPECT_TRUE(fs::exists(path / kRunFile)) << "still there after the object is gone";
  EXPECT_EQ(entries(root_ / "runs"), 1u);
}

TEST_F(RunFolderTest, LeavesNothingWithoutACommit) {
  {
    Result<RunFolder> folder = RunFolder::open(root_ / "deep" / "er" / "a");
    ASSERT_TRUE(folder.ok());
    ASSERT_FALSE(folder.value().write(kRunFile, "x = 1\n"));
    const RunFolder moved = std::move(folder).value();
    EXPECT_TRUE(fs::exists(moved.file(kRunFile)));
  }
  EXPECT_EQ(entries(root_), 0u);
}

TEST_F(RunFolderTest, KeepsParentsThatSomebodyElseUsesMeanwhile) {
  {
    const Result<RunFolder> folder = RunFolder::open(root_ / "runs" / "a");
    ASSERT_TRUE(folder.ok());
    std::ofstream(root_ / "runs" / "note") << "mine";
  }
  EXPECT_EQ(content(root_ / "runs" / "note"), "mine");
}

TEST_F(RunFolderTest, ReplacesAnEarlierRunWhole) {
  leave_run(root_ / "a", "1");
  std::ofstream(root_ / "a" / "trace.npy") << "of the first run";
  leave_run(root_ / "a", "2");
  EXPECT_EQ(content(root_ / "a" / kMetricsFile), "2");
  EXPECT_FALSE(fs::exists(root_ / "a" / "trace.npy"));
  EXPECT_EQ(entries(root_), 1u);
}

TEST_F(RunFolderTest, KeepsTheEarlierRunWhenTheNewOneFails) {
  leave_run(root_ / "a", "1");
  { ASSERT_TRUE(RunFolder::open(root_ / "a").ok()); }
  EXPECT_EQ(content(root_ / "a" / kMetricsFile), "1");
  EXPECT_EQ(entries(root_), 1u);
}

TEST_F(RunFolderTest, TakesAnEmptyFolderAndATrailingSlash) {
  fs::create_directory(root_ / "a");
  leave_run((root_ / "a").string() + "/", "1");
  EXPECT_TRUE(fs::exists(root_ / "a" / kMetricsFile));
  EXPECT_EQ(entries(root_), 1u);
}

TEST_F(RunFolderTest, FollowsALinkToTheRunItReplaces) {
  leave_run(root_ / "a", "1");
  fs::create_directory_symlink(root_ / "a", root_ / "latest");
  leave_run(root_ / "latest", "2");
  EXPECT_TRUE(fs::is_symlink(root_ / "latest"));
  EXPECT_EQ(content(root_ / "a" / kMetricsFile), "2");
}

TEST_F(RunFolderTest, NeverTouchesAFolderThatIsNoRun) {
  fs::create_directory(root_ / "a");
  std::ofstream(root_ / "a" / "thesis.tex") << "years";
  EXPECT_FALSE(RunFolder::open(root_ / "a").ok());
  EXPECT_EQ(content(root_ / "a" / "thesis.tex"), "years");
  EXPECT_EQ(entries(root_), 1u);
}

TEST_F(RunFolderTest, NeverReplacesAFolderThatFilledMeanwhile) {
  Result<RunFolder> folder = RunFolder::open(root_ / "a");
  ASSERT_TRUE(folder.ok());
  fs::create_directory(root_ / "a");
  std::ofstream(root_ / "a" / "thesis.tex") << "years";
  EXPECT_TRUE(folder.value().commit());
  EXPECT_EQ(content(root_ / "a" / "thesis.tex"), "years");
}

TEST_F(RunFolderTest, RefusesAFileAnEmptyNameAndAPlaceBelowAFile) {
  std::ofstream(root_ / "file") << "x";
  EXPECT_FALSE(RunFolder::open(root_ / "file").ok());
  EXPECT_FALSE(RunFolder::open(root_ / "file" / "a").ok());
  EXPECT_FALSE(RunFolder::open("").ok());
  EXPECT_EQ(content(root_ / "file"), "x");
}

TEST_F(RunFolderTest, ReportsAPlaceWhereNothingCanBeWritten) {
  const Result<RunFolder> folder = RunFolder::open("/proc/pirouette/a");
  ASSERT_FALSE(folder.ok());
  EXPECT_EQ(folder.errors().front().file, "/proc/pirouette/a");
}

}  // namespace
}  // namespace pirouette
