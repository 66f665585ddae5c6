// The folder that a run leaves: run.toml, metrics.json, trace.npy, terrain.npy, perhaps a
// recording. All of it or nothing.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/runtime/recording.hpp"

namespace pirouette {

inline constexpr const char* kRunFile = "run.toml";
inline constexpr const char* kMetricsFile = "metrics.json";
inline constexpr const char* kTraceFile = "trace.npy";
inline constexpr const char* kTerrainFile = "terrain.npy";
/// Names of the files in the folder that this product wrote, one on each line.
inline constexpr const char* kRecordFile = "files.txt";
/// Every name that may stand in the record; `pirouette report` adds its own.
inline constexpr std::array kRunFiles = {kRunFile,      kMetricsFile,   kTraceFile,
                                         kTerrainFile,  kRecordingFile, kRecordingStartFile,
                                         "report.html", kRecordFile};

inline constexpr double kTerrainHalfExtent = 1.5;  ///< m, of terrain.npy along x and y
inline constexpr double kTerrainPitch = 0.01;      ///< m, between its points

struct RunFolderOptions {
  bool replace = false;     ///< an earlier run's own files at the path may be replaced
  std::uintmax_t size = 0;  ///< bytes that are going to be written
};

/// A folder under construction in `.<name>.pirouette-part` beside its final place, locked against
/// other processes. commit() moves it there; without it the destructor removes it, so that a
/// failure leaves nothing behind. What a process that was killed left there is cleaned up by the
/// next one. No file is ever removed or replaced that the record (kRecordFile) of its folder does
/// not list.
class RunFolder {
 public:
  /// Creates the part folder, and missing parents. Errors: `path` is a file, a link to nothing, not
  /// to be written, too small for options.size, being written by another process; a folder with
  /// things in it, unless options.replace and its record says that a run is what it holds.
  static Result<RunFolder> open(const std::filesystem::path& path,
                                const RunFolderOptions& options = {});

  /// The same at the first of `path`, `path`-2, `path`-3 ... where nothing is and nobody writes.
  static Result<RunFolder> open_next(const std::filesystem::path& path,
                                     const RunFolderOptions& options = {});

  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

  const std::filesystem::path& path() const { return path_; }  ///< absolute, the final place
  /// Place to write `name`, one of kRunFiles, to until commit().
  std::filesystem::path file(const std::string& name) const { return part_ / name; }
  std::optional<Error> write(const std::string& name, const std::string& text) const;
  /// Writes the record and moves the files to their place. On an error nothing there has changed.
  std::optional<Error> commit();

 private:
  RunFolder() = default;

  std::optional<Error> replace_files(const std::vector<std::string>& names) const;

  std::filesystem::path path_;
  std::filesystem::path part_;                          ///< empty: nothing to clean up
  std::vector<std::filesystem::path> created_parents_;  ///< deepest first
  RunFolderOptions options_;
  int lock_ = -1;  ///< file descriptor of the part folder's lock; -1: none
};

/// Writes terrain.npy: heights (m, float32) of the ground of `terrain`, a text of
/// parse_terrain(), on a square grid about the world's origin, rows along y, columns along x, from
/// the least to the largest.
std::optional<Error> write_terrain(const RunFolder& folder, const std::string& terrain,
                                   std::uint64_t seed);

}  // namespace pirouette
