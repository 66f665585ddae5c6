// The folder that a run leaves: run.toml, metrics.json, trace.npy, terrain.npy. All of it or
// nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"

namespace pirouette {

inline constexpr const char* kRunFile = "run.toml";
inline constexpr const char* kMetricsFile = "metrics.json";
inline constexpr const char* kTraceFile = "trace.npy";
inline constexpr const char* kTerrainFile = "terrain.npy";

inline constexpr double kTerrainHalfExtent = 1.5;  ///< m, of terrain.npy along x and y
inline constexpr double kTerrainPitch = 0.01;      ///< m, between its points

/// A folder under construction beside its final place, `<path>.part-<pid>`. commit() moves it
/// there; without it the destructor removes it, so that a failure leaves nothing behind.
class RunFolder {
 public:
  /// Creates the part folder, and missing parents. An earlier run at `path` may be replaced;
  /// anything else there, other than an empty folder, is an error.
  static Result<RunFolder> open(const std::filesystem::path& path);

  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

  const std::filesystem::path& path() const { return path_; }  ///< absolute, the final place
  /// Place to write `name` to until commit().
  std::filesystem::path file(const std::string& name) const { return part_ / name; }
  std::optional<Error> write(const std::string& name, const std::string& text) const;
  /// Moves the folder to its place, and an earlier run there out of the way.
  std::optional<Error> commit();

 private:
  RunFolder() = default;

  std::filesystem::path path_;
  std::filesystem::path part_;                          ///< empty: nothing to clean up
  std::vector<std::filesystem::path> created_parents_;  ///< deepest first
};

/// Writes terrain.npy: heights (m, float32) of the ground of `terrain`, a text of
/// parse_terrain(), on a square grid about the world's origin, rows along y, columns along x, from
/// the least to the largest.
std::optional<Error> write_terrain(const RunFolder& folder, const std::string& terrain,
                                   std::uint64_t seed);

}  // namespace pirouette
