// Same configuration, same seed, same version: the same trace, bit for bit.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "support/trial.hpp"

namespace pirouette {
namespace {

std::filesystem::path trace_path(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("pirouette-determinism-" + name + ".npy");
}

/// Bytes of the trace of a short spin.
std::string trace_of(const std::string& name, const std::string& seed) {
  const std::filesystem::path path = trace_path(name);
  Result<NpyRowsFile> file = create_trace_file(path);
  if (!file.ok()) return "";
  TrialOptions options;
  options.trace = &file.value();
  const Config config = test::spin_config({"run.turns=1", "run.settle_time=1", "run.seed=" + seed});
  EXPECT_TRUE(run_trial(config, options).ok());
  EXPECT_FALSE(file.value().finish().has_value());
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  std::filesystem::remove(path);
  return bytes;
}

TEST(Trace, IsTheSameBitForBitForTheSameSeed) {
  const std::string first = trace_of("first", "3");
  ASSERT_GT(first.size(), 100000u);
  EXPECT_TRUE(first == trace_of("second", "3"));
}

TEST(Trace, DiffersForAnotherSeed) { EXPECT_FALSE(trace_of("a", "3") == trace_of("b", "4")); }

TEST(Trace, IsTheSameWhenTrialsRunBesideEachOther) {
  const std::string alone = trace_of("alone", "5");
  std::string left, right;
  std::thread left_thread([&] { left = trace_of("left", "5"); });
  std::thread right_thread([&] { right = trace_of("right", "6"); });
  left_thread.join();
  right_thread.join();
  EXPECT_TRUE(alone == left);
  EXPECT_FALSE(alone == right);
}

}  // namespace
}  // namespace pirouette
