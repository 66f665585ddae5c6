#include "pirouette/trial/run_folder.hpp"

#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <system_error>
#include <utility>

#include "pirouette/base/npy.hpp"
#include "pirouette/plant/terrain.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

Error out_error(const fs::path& path, std::string message) {
  return {path.string(), 0, "", std::move(message)};
}

fs::path beside(const fs::path& path, const char* suffix) {
  return path.string() + suffix + std::to_string(::getpid());
}

bool is_run(const fs::path& folder) {
  return fs::is_regular_file(folder / kRunFile) && fs::is_regular_file(folder / kMetricsFile);
}

/// What is wrong with putting a run at `path`, as far as one can see without writing.
std::optional<Error> check_target(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return std::nullopt;
  if (!fs::is_directory(status)) return out_error(path, "is a file; allowed: a folder for the run");
  const bool empty = fs::is_empty(path, error);
  if (error) return out_error(path, error.message());
  if (!empty && !is_run(path)) {
    return out_error(path,
                     "is a folder with other things in it; allowed: a new or empty folder, or an "
                     "earlier run, which is replaced");
  }
  return std::nullopt;
}

}  // namespace

Result<RunFolder> RunFolder::open(const fs::path& path) {
  if (path.empty()) return Error{"", 0, "", "the run folder has no name"};
  std::error_code error;
  RunFolder folder;
  folder.path_ = fs::weakly_canonical(fs::absolute(path), error);
  if (error) return out_error(path, error.message());
  if (!folder.path_.has_filename()) folder.path_ = folder.path_.parent_path();
  if (const auto wrong = check_target(folder.path_)) return *wrong;

  const fs::path parent = folder.path_.parent_path();
  for (fs::path p = parent; !p.empty() && !fs::exists(p, error); p = p.parent_path()) {
    folder.created_parents_.push_back(p);
  }
  folder.part_ = beside(folder.path_, ".part-");
  fs::create_directories(parent, error);
  if (!error) fs::remove_all(folder.part_, error);  // of a killed process that had this number
  if (!error) fs::create_directory(folder.part_, error);
  if (error) return out_error(folder.path_, "cannot be created: " + error.message());
  return folder;
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)),
      part_(std::exchange(other.part_, {})),
      created_parents_(std::exchange(other.created_parents_, {})) {}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!part_.empty()) fs::remove_all(part_, ignored);
  for (const fs::path& parent : created_parents_) fs::remove(parent, ignored);  // only when empty
}

std::optional<Error> RunFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream stream(file(name), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) return out_error(file(name), "cannot be written: is the disk full?");
  return std::nullopt;
}

std::optional<Error> RunFolder::commit() {
  if (const auto wrong = check_target(path_)) return wrong;  // it may have changed meanwhile
  std::error_code error;
  const bool replaces = is_run(path_);
  const fs::path old = beside(path_, ".old-");
  if (replaces) fs::rename(path_, old, error);
  if (!error) fs::rename(part_, path_, error);
  if (error) {
    const std::string message = "cannot be written: " + error.message();
    if (replaces && !fs::exists(path_, error)) fs::rename(old, path_, error);
    return out_error(path_, message);
  }
  if (replaces) fs::remove_all(old, error);
  part_.clear();
  created_parents_.clear();
  return std::nullopt;
}

std::optional<Error> write_terrain(const RunFolder& folder, const std::string& text,
                                   std::uint64_t seed) {
  const Result<TerrainSpec> spec = parse_terrain(text);
  if (!spec) return spec.errors().front();
  const Terrain terrain(spec.value(), seed);

  const int half = static_cast<int>(std::lround(kTerrainHalfExtent / kTerrainPitch));
  const std::string side = std::to_string(2 * half + 1);
  std::string file = npy_header("'<f4'", "(" + side + ", " + side + ")");
  for (int row = -half; row <= half; ++row) {
    for (int column = -half; column <= half; ++column) {
      const auto height = static_cast<float>(terrain.height(kTerrainPitch * Vec2(column, row)));
      const auto bytes = std::bit_cast<std::array<char, sizeof height>>(height);
      file.append(bytes.data(), bytes.size());
    }
  }
  return folder.write(kTerrainFile, file);
}

}  // namespace pirouette
