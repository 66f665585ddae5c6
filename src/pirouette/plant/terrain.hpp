// The ground: what it may be, how high it is, and its shape in the simulated world.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"

struct mjSpec_;

namespace pirouette {

struct FlatGround {};

/// A plane through the origin, uphill along +x.
struct Slope {
  double degrees = 0.0;
};

/// Straight stairs, up along +x, with the origin in the middle of a tread.
struct Stairs {
  double rise = 0.0;  ///< m
  double run = 0.0;   ///< m
};

/// A smooth random field without a direction, of zero mean.
struct RoughGround {
  double height = 0.0;  ///< m, from the lowest valley to the highest peak
};

using TerrainSpec = std::variant<FlatGround, Slope, Stairs, RoughGround>;

/// Reads "flat", "slope:DEGREES", "stairs:RISExRUN" or "rough:HEIGHT".
Result<TerrainSpec> parse_terrain(std::string_view text);

/// The text that parse_terrain() reads back to the same numbers.
std::string to_string(const TerrainSpec& spec);

class Terrain {
 public:
  /// `seed` decides rough ground and nothing else.
  Terrain(const TerrainSpec& spec, std::uint64_t seed);

  /// m, of the surface that the simulator collides with; beyond the edge, that of the nearest edge.
  double height(const Vec2& xy) const;

  /// m, height of the centre of a ball of `radius` lowered onto the ground at `xy` without touching
  /// anything else.
  double ball_height(const Vec2& xy, double radius) const;

  /// Unit normal of the overall slope, world axes; of stairs, of the plane through the middles of
  /// the treads.
  Vec3 normal() const;

  /// m, distance of the edge from the origin along x and y; infinite for planes.
  double half_extent() const;

  /// Adds the ground's geoms to the world body of `spec`, with the `friction` of sliding (1),
  /// torsion (m) and rolling (m).
  void add_to(mjSpec_& spec, const Vec3& friction) const;

 private:
  double grid_height(const Vec2& xy) const;

  TerrainSpec spec_;
  std::vector<float> grid_;   ///< rough ground: share of `height`, rows along y, columns along x
  double grid_bottom_ = 0.0;  ///< m, height of share 0
};

}  // namespace pirouette
