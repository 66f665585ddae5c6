#include "pirouette/plant/terrain.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pirouette/base/random.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

constexpr double kHalfExtent = 5.0;  ///< m, of stairs and rough ground
constexpr double kBaseDepth = 0.5;   ///< m, of solid ground below the lowest point

/// Rough ground: random heights on a coarse lattice, joined by a smooth curve and sampled on a fine
/// grid.
constexpr double kLatticePitch = 0.25;  ///< m, about half of the shortest wave
constexpr int kSamplesPerPitch = 8;
constexpr int kLatticeCells = static_cast<int>(2.0 * kHalfExtent / kLatticePitch);
constexpr int kGridSize = kLatticeCells * kSamplesPerPitch + 1;  ///< points along one side
constexpr double kGridPitch = kLatticePitch / kSamplesPerPitch;

/// Blocks: one box somewhere in each cell of a square grid about the origin.
constexpr double kBlockPitch = 0.2;  ///< m
constexpr int kBlockCells = 20;      ///< along one side
constexpr double kBlockHalfExtent = 0.5 * kBlockCells * kBlockPitch;
constexpr double kBlockSide = 0.1, kBlockSideSpread = 0.05;  ///< m, smallest and what is added
constexpr double kBlockShift = 0.05;  ///< m, largest from the middle of the cell along x and y

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

Vec2 climb_direction(const Stairs& stairs) {
  const double angle = radians(stairs.degrees);
  return {std::cos(angle), std::sin(angle)};
}

/// Number of the tread at `along` (m) in the direction of climbing.
double stair_index(const Stairs& stairs, double along) {
  const double last = std::ceil(kHalfExtent / stairs.run);
  return std::clamp(std::round(along / stairs.run), -last, last);
}

/// m, of the centre of a ball that touches the upper edge of a wall of `height` at a horizontal
/// distance `distance` from it; 0 if it passes by.
double height_on_edge(double height, double distance, double radius) {
  const double above = square(radius) - square(distance);
  return above > 0.0 ? height + std::sqrt(above) : 0.0;
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

Terrain::Terrain(const TerrainSpec& spec, std::uint64_t seed) : spec_(spec) {
  if (const auto* rough = std::get_if<RoughGround>(&spec_); rough && rough->height > 0.0)
    make_grid(*rough, seed);
  if (const auto* blocks = std::get_if<Blocks>(&spec_); blocks && blocks->height > 0.0)
    make_blocks(*blocks, seed);
}

void Terrain::make_grid(const RoughGround& rough, std::uint64_t seed) {
  std::vector<double> heights = random_field(seed);
  const auto [smallest, largest] = std::minmax_element(heights.begin(), heights.end());
  const double offset = *smallest, spread = *largest - *smallest;
  const double gradient = std::tan(radians(rough.slope_degrees));
  double mean_share = 0.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double share = (heights[i] - offset) / spread;
    mean_share += share / static_cast<double>(heights.size());
    const double x = static_cast<double>(i % kGridSize) * kGridPitch - kHalfExtent;
    heights[i] = rough.height * share + gradient * x;
  }
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  grid_range_ = *high - *low;
  grid_bottom_ = *low - rough.height * mean_share;
  grid_.reserve(heights.size());
  for (const double height : heights)
    grid_.push_back(static_cast<float>((height - *low) / grid_range_));
}

void Terrain::make_blocks(const Blocks& blocks, std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::kTerrain);
  const auto shift = [&] { return kBlockShift * (2.0 * random.uniform() - 1.0); };
  blocks_.reserve(kBlockCells * kBlockCells);
  for (int row = 0; row < kBlockCells; ++row) {
    for (int column = 0; column < kBlockCells; ++column) {
      Block& block = blocks_.emplace_back();
      block.centre =
          Vec2((column + 0.5) * kBlockPitch, (row + 0.5) * kBlockPitch).array() - kBlockHalfExtent;
      block.centre.x() += shift();
      block.centre.y() += shift();
      block.yaw = 0.5 * kPi * random.uniform();
      block.half_side = 0.5 * (kBlockSide + kBlockSideSpread * random.uniform());
      block.height = blocks.height * random.uniform();
    }
  }
}

double Terrain::Block::distance(const Vec2& xy) const {
  const Vec2 beyond = (rot2(-yaw) * (xy - centre)).cwiseAbs().array() - half_side;
  return beyond.cwiseMax(0.0).norm();
}

template <class HeightOn>
double Terrain::highest_block(const Vec2& xy, HeightOn&& height_on) const {
  double highest = 0.0;
  if (blocks_.empty()) return highest;
  // A block of another cell than the next ones is out of reach of a foot.
  const auto cell = [](double x) {
    return static_cast<int>(std::floor((x + kBlockHalfExtent) / kBlockPitch));
  };
  const auto first = [&](double x) { return std::clamp(cell(x) - 1, 0, kBlockCells); };
  const auto end = [&](double x) { return std::clamp(cell(x) + 2, 0, kBlockCells); };
  for (int row = first(xy.y()); row < end(xy.y()); ++row) {
    for (int column = first(xy.x()); column < end(xy.x()); ++column) {
      const Block& block = blocks_[static_cast<std::size_t>(row * kBlockCells + column)];
      highest = std::max(highest, height_on(block));
    }
  }
  return highest;
}

double Terrain::height(const Vec2& xy) const {
  if (const auto* slope = std::get_if<Slope>(&spec_))
    return std::tan(radians(slope->degrees)) * xy.x();
  if (const auto* stairs = std::get_if<Stairs>(&spec_))
    return stairs->rise * stair_index(*stairs, climb_direction(*stairs).dot(xy));
  if (const auto* rough = std::get_if<RoughGround>(&spec_)) {
    return grid_.empty() ? std::tan(radians(rough->slope_degrees)) * xy.x() : grid_height(xy);
  }
  return highest_block(
      xy, [&](const Block& block) { return block.distance(xy) > 0.0 ? 0.0 : block.height; });
}

double Terrain::grid_height(const Vec2& xy) const {
  if (!xy.allFinite()) return std::numeric_limits<double>::quiet_NaN();
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
  return grid_bottom_ + grid_range_ * share;
}

double Terrain::ball_height(const Vec2& xy, double radius) const {
  if (const auto* stairs = std::get_if<Stairs>(&spec_)) {
    const double along = climb_direction(*stairs).dot(xy);
    const double to_next_tread = (stair_index(*stairs, along) + 0.5) * stairs->run - along;
    return height(xy) + std::max(radius, height_on_edge(stairs->rise, to_next_tread, radius));
  }
  if (std::holds_alternative<Blocks>(spec_)) {
    const double on_blocks = highest_block(xy, [&](const Block& block) {
      return height_on_edge(block.height, block.distance(xy), radius);
    });
    return std::max(radius, on_blocks);
  }
  if (grid_.empty()) return height(xy) + radius / normal().z();

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

Vec2 Terrain::beside_edges(const Vec2& xy, double radius) const {
  const auto* stairs = std::get_if<Stairs>(&spec_);
  if (stairs == nullptr) return xy;
  const Vec2 climb = climb_direction(*stairs);
  const double along = climb.dot(xy), middle = stair_index(*stairs, along) * stairs->run;
  constexpr double kGap = 1e-4;  // m, beside the riser
  const double room = std::max(0.0, 0.5 * stairs->run - radius - kGap);
  return xy + (middle + std::clamp(along - middle, -room, room) - along) * climb;
}

Vec3 Terrain::normal() const {
  const auto of_slope = [](double degrees) {
    return Vec3(-std::sin(radians(degrees)), 0.0, std::cos(radians(degrees)));
  };
  if (const auto* slope = std::get_if<Slope>(&spec_)) return of_slope(slope->degrees);
  if (const auto* rough = std::get_if<RoughGround>(&spec_)) return of_slope(rough->slope_degrees);
  if (const auto* stairs = std::get_if<Stairs>(&spec_)) {
    Vec3 normal;
    normal << -stairs->rise * climb_direction(*stairs), stairs->run;
    return normal.normalized();
  }
  return Vec3::UnitZ();
}

double Terrain::friction(const Vec2& xy, double elsewhere) const {
  const auto* patch = std::get_if<Patch>(&spec_);
  const bool on_patch =
      patch && xy.x() >= 0.0 && xy.x() <= patch->side && std::abs(xy.y()) <= 0.5 * patch->side;
  return on_patch ? patch->friction : elsewhere;
}

double Terrain::contact_time_constant(double otherwise) const {
  const auto* soft = std::get_if<SoftGround>(&spec_);
  return soft ? soft->time_constant : otherwise;
}

double half_extent(const TerrainSpec& spec) {
  if (const auto* stairs = std::get_if<Stairs>(&spec))
    return kHalfExtent / climb_direction(*stairs).lpNorm<1>();  // of the square within a turned one
  const auto* rough = std::get_if<RoughGround>(&spec);
  return rough && rough->height > 0.0 ? kHalfExtent : std::numeric_limits<double>::infinity();
}

void Terrain::add_stairs(mjSpec_& spec, const Stairs& stairs, const Vec3& friction) const {
  const Vec2 direction = climb_direction(stairs);
  const double half_angle = 0.5 * radians(stairs.degrees);
  const int last = static_cast<int>(stair_index(stairs, kHalfExtent));
  const double bottom = -last * stairs.rise - kBaseDepth;
  for (int i = -last; i <= last; ++i) {
    const double half_height = 0.5 * (i * stairs.rise - bottom);
    mjsGeom* geom = add_geom(spec, mjGEOM_BOX, "step_" + std::to_string(i), friction);
    Eigen::Map<Vec3>(geom->pos) << i * stairs.run * direction, bottom + half_height;
    Eigen::Map<Vec4>(geom->quat) << std::cos(half_angle), 0.0, 0.0, std::sin(half_angle);
    Eigen::Map<Vec3>(geom->size) << 0.5 * stairs.run, kHalfExtent, half_height;
  }
}

void Terrain::add_grid(mjSpec_& spec, const Vec3& friction) const {
  mjsHField* field = mjs_addHField(&spec);
  mjs_setName(field->element, "ground");
  field->nrow = field->ncol = kGridSize;
  Eigen::Map<Vec4>(field->size) << kHalfExtent, kHalfExtent, grid_range_, kBaseDepth;
  mjs_setFloat(field->userdata, grid_.data(), static_cast<int>(grid_.size()));
  mjsGeom* geom = add_geom(spec, mjGEOM_HFIELD, "ground", friction);
  mjs_setString(geom->hfieldname, "ground");
  geom->pos[2] = grid_bottom_;
}

void Terrain::add_blocks(mjSpec_& spec, const Vec3& friction) const {
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const Block& block = blocks_[i];
    const double half_height = 0.5 * (block.height + kBaseDepth);
    mjsGeom* geom = add_geom(spec, mjGEOM_BOX, "block_" + std::to_string(i), friction);
    Eigen::Map<Vec3>(geom->pos) << block.centre, block.height - half_height;
    Eigen::Map<Vec4>(geom->quat) << std::cos(0.5 * block.yaw), 0.0, 0.0, std::sin(0.5 * block.yaw);
    Eigen::Map<Vec3>(geom->size) << block.half_side, block.half_side, half_height;
  }
}

void Terrain::add_to(mjSpec_& spec, const Vec3& friction) const {
  if (const auto* stairs = std::get_if<Stairs>(&spec_); stairs && stairs->rise > 0.0) {
    add_stairs(spec, *stairs, friction);
    return;
  }
  if (!grid_.empty()) {
    add_grid(spec, friction);
    return;
  }
  add_blocks(spec, friction);
  mjsGeom* geom = add_geom(spec, mjGEOM_PLANE, "ground", friction);
  Eigen::Map<Vec3>(geom->size) << 0.0, 0.0,
      1.0;  // endless; the last is the spacing of the picture's grid
  const Quat tilt = Quat::FromTwoVectors(Vec3::UnitZ(), normal());
  Eigen::Map<Vec4>(geom->quat) << tilt.w(), tilt.x(), tilt.y(), tilt.z();
}

}  // namespace pirouette
