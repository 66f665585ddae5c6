#include "pirouette/plant/terrain.hpp"

#include <mujoco/mujoco.h>

#include <array>
#include <charconv>
#include <limits>
#include <optional>

#include "pirouette/config/fields.hpp"
#include "pirouette/plant/random.hpp"

namespace pirouette {
namespace {

constexpr Range kSlopeDegrees{0.0, 40.0};
constexpr Range kRise{0.0, 0.2};
constexpr Range kRun{0.1, 1.0};
constexpr Range kRoughHeight{0.0, 0.1};

constexpr double kHalfExtent = 5.0;  ///< m, of stairs and rough ground
constexpr double kBaseDepth = 0.5;   ///< m, of solid ground below the lowest point

/// Rough ground: random heights on a coarse lattice, joined by a smooth curve and sampled on a fine
/// grid.
constexpr double kLatticePitch = 0.25;  ///< m, about half of the shortest wave
constexpr int kSamplesPerPitch = 8;
constexpr int kLatticeCells = static_cast<int>(2.0 * kHalfExtent / kLatticePitch);
constexpr int kGridSize = kLatticeCells * kSamplesPerPitch + 1;  ///< points along one side
constexpr double kGridPitch = kLatticePitch / kSamplesPerPitch;

constexpr std::string_view kGrammar =
    "flat, slope:DEGREES (0 to 40), stairs:RISExRUN (m; rise 0 to 0.2, run 0.1 to 1) or "
    "rough:HEIGHT (m; 0 to 0.1)";

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::to_string(value);
}

Error terrain_error(std::string_view given, const std::string& reason) {
  return {"", 0, "plant.terrain", "\"" + std::string(given) + "\": " + reason};
}

/// Error if `value` is out of `range`.
std::optional<Error> check(std::string_view given, std::string_view what, double value,
                           const Range& range) {
  if (value >= range.min && value <= range.max) return std::nullopt;
  return terrain_error(given, std::string(what) + " is " + shortest(value) + "; allowed " +
                                  shortest(range.min) + " to " + shortest(range.max));
}

/// Weights of Catmull and Rom's cubic for the four points about a cell, at share t of the cell.
std::array<double, 4> cubic_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {0.5 * (-t + 2.0 * t2 - t3), 0.5 * (2.0 - 5.0 * t2 + 3.0 * t3),
          0.5 * (t + 4.0 * t2 - 3.0 * t3), 0.5 * (t3 - t2)};
}

std::vector<double> random_field(std::uint64_t seed) {
  constexpr int kLatticeSize = kLatticeCells + 4;  // the cubic reaches one point beyond each end
  RandomStream random(seed, RandomPurpose::kTerrain);
  std::vector<double> lattice(static_cast<std::size_t>(kLatticeSize * kLatticeSize));
  for (double& value : lattice) value = random.uniform();

  std::vector<double> field;
  field.reserve(static_cast<std::size_t>(kGridSize * kGridSize));
  for (int row = 0; row < kGridSize; ++row) {
    const auto wy = cubic_weights(static_cast<double>(row % kSamplesPerPitch) / kSamplesPerPitch);
    for (int column = 0; column < kGridSize; ++column) {
      const auto wx =
          cubic_weights(static_cast<double>(column % kSamplesPerPitch) / kSamplesPerPitch);
      double value = 0.0;
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          const int cell =
              (row / kSamplesPerPitch + j) * kLatticeSize + column / kSamplesPerPitch + i;
          value += wy[static_cast<std::size_t>(j)] * wx[static_cast<std::size_t>(i)] *
                   lattice[static_cast<std::size_t>(cell)];
        }
      }
      field.push_back(value);
    }
  }
  return field;
}

double stair_index(const Stairs& stairs, double x) {
  const double last = std::ceil(kHalfExtent / stairs.run);
  return std::clamp(std::round(x / stairs.run), -last, last);
}

mjsGeom* add_geom(mjSpec& spec, mjtGeom type, const std::string& name, const Vec3& friction) {
  mjsGeom* geom = mjs_addGeom(mjs_findBody(&spec, "world"), nullptr);
  mjs_setName(geom->element, name.c_str());
  geom->type = type;
  // Every bit, so that a robot with its own collision bits meets the ground too.
  geom->contype = std::numeric_limits<int>::max();
  geom->conaffinity = std::numeric_limits<int>::max();
  geom->condim = 6;
  Eigen::Map<Vec3>(geom->friction) = friction;
  Eigen::Map<Eigen::Vector4f>(geom->rgba) << 0.55F, 0.57F, 0.6F, 1.0F;
  return geom;
}

}  // namespace

Result<TerrainSpec> parse_terrain(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const std::string_view rest = colon == std::string_view::npos ? "" : text.substr(colon + 1);
  const Error unknown = terrain_error(text, "expected " + std::string(kGrammar));

  if (kind == "flat") return text == kind ? Result<TerrainSpec>(FlatGround{}) : unknown;

  if (kind == "slope" || kind == "rough") {
    const std::optional<double> number = parse_number(rest);
    if (!number) return unknown;
    const bool is_slope = kind == "slope";
    const auto error = is_slope ? check(text, "the slope in degrees", *number, kSlopeDegrees)
                                : check(text, "the height in metres", *number, kRoughHeight);
    if (error) return *error;
    return is_slope ? TerrainSpec(Slope{*number}) : TerrainSpec(RoughGround{*number});
  }

  if (kind == "stairs") {
    const std::size_t cross = rest.find('x');
    if (cross == std::string_view::npos) return unknown;
    const std::optional<double> rise = parse_number(rest.substr(0, cross));
    const std::optional<double> run = parse_number(rest.substr(cross + 1));
    if (!rise || !run) return unknown;
    Errors errors;
    if (const auto error = check(text, "the rise in metres", *rise, kRise))
      errors.push_back(*error);
    if (const auto error = check(text, "the run in metres", *run, kRun)) errors.push_back(*error);
    if (!errors.empty()) return errors;
    return TerrainSpec(Stairs{*rise, *run});
  }
  return unknown;
}

std::string to_string(const TerrainSpec& spec) {
  if (const auto* slope = std::get_if<Slope>(&spec)) return "slope:" + shortest(slope->degrees);
  if (const auto* stairs = std::get_if<Stairs>(&spec)) {
    return "stairs:" + shortest(stairs->rise) + "x" + shortest(stairs->run);
  }
  if (const auto* rough = std::get_if<RoughGround>(&spec))
    return "rough:" + shortest(rough->height);
  return "flat";
}

Terrain::Terrain(const TerrainSpec& spec, std::uint64_t seed) : spec_(spec) {
  const auto* rough = std::get_if<RoughGround>(&spec_);
  if (!rough) return;
  const std::vector<double> field = random_field(seed);
  const auto [low, high] = std::minmax_element(field.begin(), field.end());
  double sum = 0.0;
  grid_.reserve(field.size());
  for (const double value : field) {
    const double share = (value - *low) / (*high - *low);
    grid_.push_back(static_cast<float>(share));
    sum += share;
  }
  grid_bottom_ = -rough->height * sum / static_cast<double>(field.size());
}

double Terrain::height(const Vec2& xy) const {
  if (const auto* slope = std::get_if<Slope>(&spec_))
    return std::tan(radians(slope->degrees)) * xy.x();
  if (const auto* stairs = std::get_if<Stairs>(&spec_))
    return stairs->rise * stair_index(*stairs, xy.x());
  if (std::holds_alternative<RoughGround>(spec_)) return grid_height(xy);
  return 0.0;
}

double Terrain::grid_height(const Vec2& xy) const {
  const double scale = std::get<RoughGround>(spec_).height;
  const Vec2 cells =
      ((xy.array() + kHalfExtent) / kGridPitch).cwiseMax(0.0).cwiseMin(kGridSize - 1.0);
  const int column = std::min(static_cast<int>(cells.x()), kGridSize - 2);
  const int row = std::min(static_cast<int>(cells.y()), kGridSize - 2);
  const double u = cells.x() - column, v = cells.y() - row;
  const auto at = [&](int r, int c) -> double {
    return grid_[static_cast<std::size_t>(r * kGridSize + c)];
  };
  // MuJoCo splits a cell into two triangles along the diagonal from (row, column) to the far
  // corner.
  const double low = at(row, column), far = at(row + 1, column + 1);
  const double share =
      u > v ? low + u * (at(row, column + 1) - low) + v * (far - at(row, column + 1))
            : low + v * (at(row + 1, column) - low) + u * (far - at(row + 1, column));
  return grid_bottom_ + scale * share;
}

double Terrain::ball_height(const Vec2& xy, double radius) const {
  if (const auto* stairs = std::get_if<Stairs>(&spec_)) {
    const double to_next_tread = (stair_index(*stairs, xy.x()) + 0.5) * stairs->run - xy.x();
    const double above_edge = square(radius) - square(to_next_tread);
    const double on_edge = above_edge > 0.0 ? stairs->rise + std::sqrt(above_edge) : 0.0;
    return height(xy) + std::max(radius, on_edge);
  }
  if (!std::holds_alternative<RoughGround>(spec_)) return height(xy) + radius / normal().z();

  // The upper envelope of balls about the ground points near enough to touch.
  constexpr int kSamples = 16;
  double highest = height(xy) + radius;
  for (int i = -kSamples; i <= kSamples; ++i) {
    for (int j = -kSamples; j <= kSamples; ++j) {
      const Vec2 offset = Vec2(i, j) * (radius / kSamples);
      const double above = square(radius) - offset.squaredNorm();
      if (above >= 0.0) highest = std::max(highest, height(xy + offset) + std::sqrt(above));
    }
  }
  return highest;
}

Vec3 Terrain::normal() const {
  if (const auto* slope = std::get_if<Slope>(&spec_)) {
    return {-std::sin(radians(slope->degrees)), 0.0, std::cos(radians(slope->degrees))};
  }
  if (const auto* stairs = std::get_if<Stairs>(&spec_))
    return Vec3(-stairs->rise, 0.0, stairs->run).normalized();
  return Vec3::UnitZ();
}

double Terrain::half_extent() const {
  const bool has_edge =
      std::holds_alternative<Stairs>(spec_) || std::holds_alternative<RoughGround>(spec_);
  return has_edge ? kHalfExtent : std::numeric_limits<double>::infinity();
}

void Terrain::add_to(mjSpec_& spec, const Vec3& friction) const {
  if (const auto* stairs = std::get_if<Stairs>(&spec_); stairs && stairs->rise > 0.0) {
    const int last = static_cast<int>(stair_index(*stairs, kHalfExtent));
    const double bottom = -last * stairs->rise - kBaseDepth;
    for (int i = -last; i <= last; ++i) {
      const double half_height = 0.5 * (i * stairs->rise - bottom);
      mjsGeom* geom = add_geom(spec, mjGEOM_BOX, "step_" + std::to_string(i), friction);
      Eigen::Map<Vec3>(geom->pos) << i * stairs->run, 0.0, bottom + half_height;
      Eigen::Map<Vec3>(geom->size) << 0.5 * stairs->run, kHalfExtent, half_height;
    }
    return;
  }
  if (const auto* rough = std::get_if<RoughGround>(&spec_); rough && rough->height > 0.0) {
    mjsHField* field = mjs_addHField(&spec);
    mjs_setName(field->element, "ground");
    field->nrow = field->ncol = kGridSize;
    Eigen::Map<Vec4>(field->size) << kHalfExtent, kHalfExtent, rough->height, kBaseDepth;
    mjs_setFloat(field->userdata, grid_.data(), static_cast<int>(grid_.size()));
    mjsGeom* geom = add_geom(spec, mjGEOM_HFIELD, "ground", friction);
    mjs_setString(geom->hfieldname, "ground");
    geom->pos[2] = grid_bottom_;
    return;
  }
  mjsGeom* geom = add_geom(spec, mjGEOM_PLANE, "ground", friction);
  Eigen::Map<Vec3>(geom->size) << 0.0, 0.0,
      1.0;  // endless; the last is the spacing of the picture's grid
  const Quat tilt = Quat::FromTwoVectors(Vec3::UnitZ(), normal());
  Eigen::Map<Vec4>(geom->quat) << tilt.w(), tilt.x(), tilt.y(), tilt.z();
}

}  // namespace pirouette
