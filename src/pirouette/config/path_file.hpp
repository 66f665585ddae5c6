// TOML file of a path to follow.
#pragma once

#include <filesystem>
#include <vector>

#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/path/path.hpp"
#include "pirouette/trial/trial_config.hpp"

namespace pirouette {

/// Waypoints, and how to follow the spline through them. Keys of the file:
/// - points = [[x, y], ...]: m; the first is where the robot starts, facing along the path;
/// - closed = false; true: the path returns from the last point to the first, which is not
/// repeated;
/// - speed = 0.2: m/s;
/// - heading = "tangent": the body turns with the path; "fixed": it keeps its heading; a number: it
///   turns with the path, whose direction is at this angle (deg) from its front: 90 is to its left,
///   180 backwards.
struct PathFile {
  std::vector<Vec2> points;       ///< m
  bool closed = false;            ///< returns to the first point
  Path curve;                     ///< the spline through the points
  double speed = 0.2;             ///< m/s
  bool hold_heading = false;      ///< the body keeps its heading
  double travel_direction = 0.0;  ///< rad, direction of the path from the body's front
};

/// The checked file, or all of its errors.
Result<PathFile> load_path_file(const std::filesystem::path& file);

/// File of run.path: experiments/paths/<run.path>.toml of the data folder, or run.path itself when
/// that ends in .toml. An error for a path that does not exist lists the known ones.
Result<std::filesystem::path> resolve_path(const TrialConfig& run);

/// Names under experiments/paths of the data folder, sorted.
std::vector<std::string> known_paths();

}  // namespace pirouette
