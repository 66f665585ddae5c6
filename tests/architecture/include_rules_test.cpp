// The house rules: who may include whom, and where a library may appear (CONTRIBUTING.md).
#include <fnmatch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// Headers below src/pirouette, or folders of the tree; `*` stands for any text.
using Patterns = std::vector<std::string>;

Patterns operator+(Patterns a, const Patterns& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Patterns kBelowStages = {"base/*", "types/*", "model/*"};
const Patterns kStages = {"gait/*", "foot/*",       "terrain/*", "com/*",
                          "path/*", "estimation/*", "lowlevel/*"};
/// Parameters of the parts that a file of TOML describes.
const Patterns kConfigs = {"*/*_config.hpp"};
const Patterns kWorld = {"controller/*", "runtime/*", "plant/*", "metrics/*", "trial/*"};
/// path.hpp is the curve against which the walked way is measured.
const Patterns kBelowTrial = {"base/*", "types/*", "path/path.hpp"};

/// Folder -> which of our headers its files may include, besides the folder's own.
const std::map<std::string, Patterns> kMayInclude = {
    {"src/pirouette/base", {"version.hpp"}},
    {"src/pirouette/types", {"base/*"}},
    {"src/pirouette/model", {"base/*", "types/*"}},
    {"src/pirouette/gait", kBelowStages},
    {"src/pirouette/foot", kBelowStages},
    {"src/pirouette/terrain", kBelowStages},
    {"src/pirouette/com", kBelowStages},
    {"src/pirouette/path", kBelowStages},
    {"src/pirouette/estimation", kBelowStages},
    {"src/pirouette/lowlevel", kBelowStages},
    {"src/pirouette/controller", kBelowStages + kStages},
    // Defaults follow the robot: its file is read for them.
    {"src/pirouette/config",
     Patterns{"base/*", "path/path.hpp", "types/robot_scale.hpp", "model/robot_description.hpp",
              "model/robot_model.hpp", "controller/robot_defaults.hpp"} +
         kConfigs},
    {"src/pirouette/runtime", {"base/*", "types/*", "controller/controller.hpp"}},
    // Of the model only what reads the robot's file, which both sides must read alike.
    {"src/pirouette/plant",
     {"base/*", "types/*", "model/mujoco.hpp", "model/robot_description.hpp", "model/robot_map.hpp",
      "model/robot_reader.hpp", "runtime/world.hpp"}},
    {"src/pirouette/metrics", kBelowTrial},
    {"src/pirouette/trial",
     kBelowTrial + Patterns{"controller/*", "runtime/*", "plant/*", "metrics/*"}},
    {"src/pirouette/study",
     kBelowTrial + kWorld +
         Patterns{"config/*", "foot/leg_kinematics.hpp", "model/robot_description.hpp",
                  "model/robot_model.hpp", "model/robot_text.hpp"}},
    {"src/pirouette/report", {"base/*", "config/*", "metrics/*", "plant/*", "trial/*", "study/*"}},

    {"apps/pirouette",
     {"base/*", "config/*", "controller/spin_controller.hpp", "runtime/*", "metrics/*", "trial/*",
      "study/*", "report/*"}},
    {"python/bindings",
     {"base/*", "types/*", "config/*", "controller/spin_controller.hpp", "path/path.hpp",
      "plant/plant.hpp", "plant/simulated_world.hpp", "plant/terrain.hpp", "runtime/*", "metrics/*",
      "trial/*", "study/*"}},
    {"bench",
     {"base/*", "config/*", "controller/spin_controller.hpp", "path/path.hpp", "plant/plant.hpp",
      "runtime/*", "study/*"}},
    {"fuzz", {"base/*", "config/*", "study/*", "model/robot_model.hpp", "path/path.hpp"}},
};

/// A library, as its includes begin -> the folders that may include it.
const std::map<std::string, Patterns> kLibraries = {
    {"mujoco/", {"src/pirouette/model", "src/pirouette/plant"}},
    {"toml++/", {"src/pirouette/config", "src/pirouette/study"}},
    {"eiquadprog/", {"src/pirouette/lowlevel"}},
    {"nlohmann/",
     {"src/pirouette/metrics", "src/pirouette/trial", "src/pirouette/study",
      "src/pirouette/report"}},
    {"CLI/", {"apps/pirouette"}},
    {"nanobind/", {"python/bindings"}},
    {"benchmark/", {"bench"}},
    {"tinyxml2.h", {"src/pirouette/config"}},
};

bool matches(const std::string& text, const std::string& pattern) {
  return fnmatch(pattern.c_str(), text.c_str(), 0) == 0;
}

bool matches_any(const std::string& text, const Patterns& patterns) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return matches(text, pattern); });
}

struct Include {
  std::string file;    ///< relative to the source tree
  std::string folder;  ///< of that file, relative to the source tree
  std::string target;  ///< what it includes
};

/// Every include of every C++ file below src/, apps/, python/, bench/ and fuzz/.
std::vector<Include> find_includes() {
  const fs::path root = PIROUETTE_SOURCE_DIR;
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const char* tree : {"src", "apps", "python", "bench", "fuzz"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / tree)) {
      const fs::path extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const fs::path path = fs::relative(entry.path(), root);
      std::ifstream file(entry.path());
      std::smatch match;
      for (std::string line; std::getline(file, line);) {
        if (!std::regex_search(line, match, pattern)) continue;
        includes.push_back({path.string(), path.parent_path().string(), match[1].str()});
      }
    }
  }
  return includes;
}

const std::vector<Include>& all_includes() {
  static const std::vector<Include> includes = find_includes();
  return includes;
}

TEST(Architecture, EveryFolderHasARuleAndEveryRuleAFolder) {
  std::set<std::string> folders, ruled;
  for (const Include& include : all_includes()) folders.insert(include.folder);
  for (const auto& [folder, patterns] : kMayInclude) ruled.insert(folder);
  EXPECT_EQ(folders, ruled);
}

TEST(Architecture, IncludesPointOnlyTheAllowedWay) {
  const std::string ours = "pirouette/";
  for (const Include& include : all_includes()) {
    if (!include.target.starts_with(ours)) continue;
    const std::string header = include.target.substr(ours.size());
    if (matches("src/pirouette/" + header, include.folder + "/*")) continue;
    const auto rule = kMayInclude.find(include.folder);
    if (rule == kMayInclude.end()) continue;  // EveryFolderHasARuleAndEveryRuleAFolder says it
    EXPECT_TRUE(matches_any(header, rule->second))
        << include.file << " includes " << include.target;
  }
}

// The trace holds two ticks' values in turn. A step that cannot see it reads only what its input
// struct lists, where `last_` names the instant (docs/architecture.md, "One tick").
TEST(Architecture, NoStepOfATickSeesTheTrace) {
  const Patterns controller = kStages + Patterns{"controller/*"};
  for (const Include& include : all_includes()) {
    if (include.target != "pirouette/types/tick_trace.hpp") continue;
    if (include.file == "src/pirouette/controller/spin_controller.hpp") continue;
    EXPECT_FALSE(include.folder.starts_with("src/") &&
                 matches_any(include.file.substr(std::string("src/pirouette/").size()), controller))
        << include.file;
  }
}

TEST(Architecture, OwnHeadersAreIncludedByTheirFullPath) {
  for (const Include& include : all_includes()) {
    if (!include.folder.starts_with("src/") || !include.target.ends_with(".hpp")) continue;
    if (include.target.starts_with("pirouette/")) continue;
    EXPECT_TRUE(
        std::any_of(kLibraries.begin(), kLibraries.end(),
                    [&](const auto& library) { return include.target.starts_with(library.first); }))
        << include.file << " includes " << include.target;
  }
}

TEST(Architecture, ALibraryStaysWhereItBelongs) {
  for (const Include& include : all_includes()) {
    for (const auto& [library, folders] : kLibraries) {
      if (!include.target.starts_with(library)) continue;
      EXPECT_TRUE(matches_any(include.folder, folders))
          << include.file << " includes " << include.target;
    }
  }
}

}  // namespace
