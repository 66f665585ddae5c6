// A path to walk along, as a TOML file.
#pragma once

#include <filesystem>
#include <vector>

#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/trial/trial_config.hpp"

namespace pirouette {

/// Waypoints and how to walk along the spline through them. Keys of the file:
/// - points = [[x, y], ...]: m; the first is where the robot starts, facing along the path;
/// - closed = false: the path returns from the last point to the first, which is not repeated;
/// - speed = 0.2: m/s;
/// - heading = "tangent": the body turns with the path; "fixed": it keeps its heading; a number:
///   it turns with the path, which runs at this angle (deg) from its front: 90 leads to its left,
///   180 backwards.
struct PathFile {
  std::vector<Vec2> points;  ///< m
  bool closed = false;
  double speed = 0.2;  ///< m/s
  bool hold_heading = false;
  double travel_direction = 0.0;  ///< rad, of the path from the body's front
};

/// The checked file, or everything that is wrong with it at once.
Result<PathFile> load_path_file(const std::filesystem::path& file);

/// File of run.path: experiments/paths/<run.path>.toml of the data folder, or run.path itself when
/// that ends in .toml.
Result<std::filesystem::path> resolve_path(const TrialConfig& run);

/// Names under experiments/paths of the data folder, sorted.
std::vector<std::string> known_paths();

}  // namespace pirouette
