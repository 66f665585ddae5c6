// Folder of a run: run.toml, metrics.json, trace.npy, terrain.npy, robot.xml, perhaps a recording;
// written completely or not at all.
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

inline constexpr const char* kRunFile = "run.toml";          ///< Config of the run
inline constexpr const char* kMetricsFile = "metrics.json";  ///< Metrics
inline constexpr const char* kTraceFile = "trace.npy";       ///< rows of TraceRow
inline constexpr const char* kTerrainFile = "terrain.npy";   ///< heights of the ground
inline constexpr const char* kRobotFile = "robot.xml";       ///< MJCF of the robot as it was read
/// Names of the files in the folder that this product wrote, one on each line.
inline constexpr const char* kRecordFile = "files.txt";
/// Names of the files that a run writes.
inline constexpr std::array kRunFiles = {
    kRunFile,   kMetricsFile,   kTraceFile,          kTerrainFile,
    kRobotFile, kRecordingFile, kRecordingStartFile, kRecordFile};
/// Names that `pirouette report` and `export` add to the record.
inline constexpr std::array kDerivedFiles = {"report.html", "trace.csv", "trace.mcap",
                                             "trace.parquet", "video.mp4"};

inline constexpr double kTerrainHalfExtent = 1.5;  ///< m, of terrain.npy along x and y
inline constexpr double kTerrainPitch = 0.01;      ///< m, between its points

/// Options of RunFolder::open().
struct RunFolderOptions {
  bool replace = false;     ///< an earlier run's own files at the path may be replaced
  std::uintmax_t size = 0;  ///< bytes that are going to be written
};

/// A folder under construction in `.NAME.pirouette-part` beside its final place, locked against
/// other processes. commit() moves it there, or its files into a folder that is there already;
/// without commit() the destructor removes it, so that a failure leaves nothing behind. The part
/// folder of a killed process is removed by the next one. No file is removed or replaced that the
/// record (kRecordFile) of its folder does not list.
class RunFolder {
 public:
  /// Creates the part folder, and missing parents. Errors: `path` is a file, a dangling link, not
  /// writable, too small for options.size or being written by another process; it is a folder with
  /// content, unless options.replace is set and its record lists a run.
  static Result<RunFolder> open(const std::filesystem::path& path,
                                const RunFolderOptions& options = {});

  /// The same at the first of PATH, PATH-2, PATH-3 ... that does not exist and is not being
  /// written.
  static Result<RunFolder> open_next(const std::filesystem::path& path,
                                     const RunFolderOptions& options = {});

  RunFolder(RunFolder&& other) noexcept;  ///< moves
  RunFolder& operator=(RunFolder&&) = delete;
  ~RunFolder();

  const std::filesystem::path& path() const { return path_; }  ///< absolute, the final place
  /// Path of the file `name`, one of kRunFiles, until commit().
  std::filesystem::path file(const std::string& name) const { return part_ / name; }
  /// Writes the file `name`. Returns the error when it cannot be written; absent: done.
  std::optional<Error> write(const std::string& name, const std::string& text) const;
  /// Writes the record and moves the files to their final place. Returns the error when that fails,
  /// and nothing there has changed; absent: done.
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
/// the least to the largest. Returns the error when it cannot be written; absent: done.
std::optional<Error> write_terrain(const RunFolder& folder, const std::string& terrain,
                                   std::uint64_t seed);

}  // namespace pirouette
