// The house rules: who may include whom, and where a library may appear (CONTRIBUTING.md).
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

using Folders = std::set<std::string>;

/// Folder -> the folders that it may include, besides itself.
std::map<std::string, Folders> allowed_folders() {
  const Folders below_stages = {"base", "types", "config", "model"};
  const Folders stages = {"gait", "foot", "terrain", "com", "path", "estimation", "lowlevel"};
  std::map<std::string, Folders> allowed = {
      {"base", {}},
      {"types", {"base"}},
      {"config", {"base", "types"}},
      {"model", {"base", "types", "config"}},
      {"controller", below_stages},
      {"plant", below_stages},  // of model/ only the map of names, which both sides must read alike
      // path/ for the curve against which the walked way is measured.
      {"experiment", {"base", "types", "config", "controller", "plant", "path"}},
  };
  for (const std::string& stage : stages) {
    allowed[stage] = below_stages;
    allowed["controller"].insert(stage);
  }
  return allowed;
}

struct Include {
  std::string file;    ///< relative to the source tree
  std::string folder;  ///< of that file, below src/pirouette
  std::string target;  ///< what it includes
};

std::vector<Include> includes_below(const std::string& tree) {
  const fs::path root = PIROUETTE_SOURCE_DIR;
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> includes;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / tree)) {
    const fs::path extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp") continue;
    const std::string folder = entry.path().parent_path().filename().string();
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);) {
      if (std::regex_search(line, match, pattern)) {
        includes.push_back({fs::relative(entry.path(), root).string(), folder, match[1].str()});
      }
    }
  }
  return includes;
}

/// "gait" of "pirouette/gait/gait_clock.hpp"; empty for what is not ours.
std::string folder_of(const std::string& target) {
  const std::string prefix = "pirouette/";
  if (!target.starts_with(prefix)) return "";
  return target.substr(prefix.size(), target.rfind('/') - prefix.size());
}

TEST(Architecture, TheSourcesAreFound) { EXPECT_GT(includes_below("src/pirouette").size(), 50u); }

TEST(Architecture, IncludesPointOnlyTheAllowedWay) {
  const std::map<std::string, Folders> allowed = allowed_folders();
  for (const Include& include : includes_below("src/pirouette")) {
    const std::string target = folder_of(include.target);
    if (target.empty() || target == include.folder) continue;
    ASSERT_TRUE(allowed.contains(include.folder)) << "unknown folder of " << include.file;
    EXPECT_TRUE(allowed.at(include.folder).contains(target))
        << include.file << " includes " << include.target;
  }
}

TEST(Architecture, OwnHeadersAreIncludedByTheirFullPath) {
  for (const Include& include : includes_below("src/pirouette")) {
    if (!include.target.ends_with(".hpp") || include.target.starts_with("pirouette/")) continue;
    EXPECT_TRUE(include.target.starts_with("nlohmann/") ||
                include.target.starts_with("eiquadprog/"))
        << include.file << " includes " << include.target;
  }
}

TEST(Architecture, ALibraryStaysWhereItBelongs) {
  const std::map<std::string, Folders> homes = {
      {"mujoco/", {"model", "plant"}},
      {"toml++/", {"config"}},
      {"eiquadprog/", {"lowlevel"}},
      {"nlohmann/", {"experiment"}},
      {"CLI/", {}},
  };
  for (const Include& include : includes_below("src/pirouette")) {
    for (const auto& [library, folders] : homes) {
      if (!include.target.starts_with(library)) continue;
      EXPECT_TRUE(folders.contains(include.folder))
          << include.file << " includes " << include.target;
    }
  }
}

}  // namespace
