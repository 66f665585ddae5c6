#include "pirouette/config/path_file.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pirouette/base/rotation.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/config/toml_node.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr Range kSpeed{0.01, 2.0};          // m/s
constexpr Range kDirection{-180.0, 180.0};  // deg
constexpr double kMaxCoordinate = 1000.0;   // m
constexpr double kMinDistance = 0.01;       // m, between neighbouring points
constexpr std::size_t kMaxPoints = 10000;

/// Finite number of the node; a boolean is none.
std::optional<double> number(const toml::node& node) {
  const std::optional<double> value = node.value<double>();
  if (node.is_boolean() || !value || !std::isfinite(*value)) return std::nullopt;
  return value;
}

std::optional<double> number_within(const toml::node& node, Range range) {
  const std::optional<double> value = number(node);
  return value && range.min <= *value && *value <= range.max ? value : std::nullopt;
}

class PathReader {
 public:
  explicit PathReader(const fs::path& file) : file_(file.string()) {}

  Result<PathFile> read(const toml::table& table) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (name == "points") {
        read_points(node);
      } else if (name == "closed") {
        check(node, name, read_flag(node, path_.closed), "true, false");
      } else if (name == "speed") {
        const std::optional<double> speed = number_within(node, kSpeed);
        check(node, name, speed.has_value(), "0.01 to 2 m/s");
        path_.speed = speed.value_or(path_.speed);
      } else if (name == "heading") {
        check(node, name, read_heading(node),
              "\"tangent\", \"fixed\", or the angle of the path from the front, -180 to 180 deg");
      } else {
        report_unknown(node, name);
      }
    }
    const toml::node* points = table.get("points");
    if (points == nullptr) errors_.push_back({file_, 0, "points", "missing; a path needs points"});
    if (points != nullptr && errors_.empty()) check_distances(*points);
    if (points != nullptr && errors_.empty()) fit(*points->as_array());
    std::stable_sort(errors_.begin(), errors_.end(),
                     [](const Error& a, const Error& b) { return a.line < b.line; });
    if (!errors_.empty()) return errors_;
    return path_;
  }

 private:
  void report(const toml::node& node, const std::string& key, std::string message) {
    errors_.push_back({file_, static_cast<int>(node.source().begin.line), key, std::move(message)});
  }

  void check(const toml::node& node, const std::string& key, bool good, const char* allowed) {
    if (!good) report(node, key, "given " + shown(node) + "; allowed: " + allowed);
  }

  void report_unknown(const toml::node& node, const std::string& name) {
    const std::vector<std::string> names = {"points", "closed", "speed", "heading"};
    const std::optional<std::string> meant = nearest(name, names);
    report(node, name,
           "unknown key; " +
               (meant ? "did you mean " + *meant + "?" : "allowed here: " + joined(names)));
  }

  static bool read_flag(const toml::node& node, bool& out) {
    if (!node.is_boolean()) return false;
    out = node.as_boolean()->get();
    return true;
  }

  bool read_heading(const toml::node& node) {
    if (const auto* word = node.as_string()) {
      path_.hold_heading = word->get() == "fixed";
      return path_.hold_heading || word->get() == "tangent";
    }
    const std::optional<double> direction = number_within(node, kDirection);
    path_.travel_direction = radians(direction.value_or(0.0));
    return direction.has_value();
  }

  void read_points(const toml::node& node) {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() > kMaxPoints) {
      report(node, "points",
             "allowed: a list of up to " + std::to_string(kMaxPoints) + " points [x, y] in m");
      return;
    }
    for (const toml::node& element : *list) {
      const toml::array* pair = element.as_array();
      std::optional<double> x, y;
      if (pair != nullptr && pair->size() == 2) {
        x = number_within((*pair)[0], {-kMaxCoordinate, kMaxCoordinate});
        y = number_within((*pair)[1], {-kMaxCoordinate, kMaxCoordinate});
      }
      check(element, "points", x && y, "[x, y] in m, each -1000 to 1000");
      path_.points.emplace_back(x.value_or(0.0), y.value_or(0.0));
    }
  }

  void check_distances(const toml::node& node) {
    const std::size_t n = path_.points.size(), needed = path_.closed ? 3 : 2;
    if (n < needed) {
      report(node, "points",
             "given " + std::to_string(n) + "; allowed: " + std::to_string(needed) + " or more" +
                 (path_.closed ? " of a closed path" : ""));
      return;
    }
    const toml::array& list = *node.as_array();
    for (std::size_t i = 0; i + (path_.closed ? 0 : 1) < n; ++i) {
      const std::size_t next = (i + 1) % n;
      if ((path_.points[next] - path_.points[i]).norm() >= kMinDistance) continue;
      const std::string words = next == 0 ? "the last is the first again, which closed adds"
                                          : "given " + shown(list[next]) + " beside " +
                                                shown(list[i]) + "; allowed: 0.01 m apart and more";
      report(list[next == 0 ? i : next], "points", words);
    }
  }

  void fit(const toml::array& list) {
    std::size_t before = 0;
    const std::optional<Path> curve = Path::spline(path_.points, path_.closed, &before);
    if (curve) {
      path_.curve = *curve;
      return;
    }
    const std::size_t after = (before + 1) % list.size();
    report(list[after], "points",
           "the curve turns back on itself between " + shown(list[before]) + " and " +
               shown(list[after]) + "; allowed: points through which a smooth curve runs forwards");
  }

  std::string file_;
  PathFile path_;
  Errors errors_;
};

fs::path paths_folder() { return data_dir() / "experiments" / "paths"; }

}  // namespace

Result<PathFile> load_path_file(const fs::path& file) {
  Errors errors;
  const std::optional<toml::table> table = parse_toml_file(file, errors);
  if (!table) return errors;
  return PathReader(file).read(*table);
}

std::vector<std::string> known_paths() { return toml_stems(paths_folder()); }

Result<fs::path> resolve_path(const TrialConfig& run) {
  const fs::path path = run.path;
  if (path.extension() == ".toml") {
    if (fs::is_regular_file(path)) return path;
    return Error{"", 0, "run.path", "given " + in_quotes(run.path) + ": no such file"};
  }
  const std::vector<std::string> names = known_paths();
  if (std::binary_search(names.begin(), names.end(), run.path)) {
    return paths_folder() / (run.path + ".toml");
  }
  return Error{"", 0, "run.path",
               unknown_name(run.path, names) + "; or the path of a file ending in .toml"};
}

}  // namespace pirouette
