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

/// Straight stairs with the origin in the middle of a tread.
struct Stairs {
  double rise = 0.0;     ///< m
  double run = 0.0;      ///< m
  double degrees = 0.0;  ///< from +x to the direction of climbing, counter-clockwise
};

/// A smooth random field without a direction, of zero mean, added along z to a slope.
struct RoughGround {
  double height = 0.0;         ///< m, from the lowest valley to the highest peak
  double slope_degrees = 0.0;  ///< uphill along +x
};

/// Boxes scattered over flat ground within 2 m of the origin, each of a random height from 0 to
/// `height`.
struct Blocks {
  double height = 0.0;  ///< m
};

/// Flat ground with a square of another sliding friction, 0 <= x <= side and |y| <= side / 2: one
/// edge passes the origin, so that half of the footholds of a robot that spins there lie on it.
struct Patch {
  double friction = 0.0;  ///< 1
  double side = 0.0;      ///< m
};

/// Flat ground into which the feet sink.
struct SoftGround {
  double time_constant = 0.0;  ///< s, of the contact, in the place of plant.contact_time_constant
};

using TerrainSpec = std::variant<FlatGround, Slope, Stairs, RoughGround, Blocks, Patch, SoftGround>;

/// Reads the texts that plant.terrain allows; an error names them.
Result<TerrainSpec> parse_terrain(std::string_view text);

/// The text that parse_terrain() reads back to the same numbers.
std::string to_string(const TerrainSpec& spec);

class Terrain {
 public:
  /// `seed` decides rough ground and blocks, and nothing else.
  Terrain(const TerrainSpec& spec, std::uint64_t seed);

  /// m, of the surface that the simulator collides with; beyond the edge, that of the nearest edge.
  double height(const Vec2& xy) const;

  /// m, height of the centre of a ball of `radius` lowered onto the ground at `xy` without touching
  /// anything else.
  double ball_height(const Vec2& xy, double radius) const;

  /// Unit normal of the overall slope, world axes; of stairs, of the plane through the middles of
  /// the treads.
  Vec3 normal() const;

  /// Sliding friction at `xy`; `elsewhere` where the terrain says nothing about it.
  double friction(const Vec2& xy, double elsewhere) const;

  /// s, of the feet's contact; `otherwise` where the terrain says nothing about it.
  double contact_time_constant(double otherwise) const;

  /// m, distance of the edge from the origin along x and y; infinite for planes.
  double half_extent() const;

  /// Adds the ground's geoms to the world body of `spec`, with the `friction` of sliding (1),
  /// torsion (m) and rolling (m). The friction of a patch is not in them: see friction().
  void add_to(mjSpec_& spec, const Vec3& friction) const;

 private:
  /// A box that stands on flat ground.
  struct Block {
    Vec2 centre;          ///< m
    double yaw;           ///< rad
    double half_side;     ///< m
    double height = 0.0;  ///< m

    /// m, horizontal distance of `xy` from the box; 0 above it.
    double distance(const Vec2& xy) const;
  };

  void make_grid(const RoughGround& rough, std::uint64_t seed);
  void make_blocks(const Blocks& blocks, std::uint64_t seed);
  double grid_height(const Vec2& xy) const;
  /// Largest value of `height_on(block)` over the blocks near `xy`, at least 0.
  template <class HeightOn>
  double highest_block(const Vec2& xy, HeightOn&& height_on) const;
  void add_stairs(mjSpec_& spec, const Stairs& stairs, const Vec3& friction) const;
  void add_grid(mjSpec_& spec, const Vec3& friction) const;
  void add_blocks(mjSpec_& spec, const Vec3& friction) const;

  TerrainSpec spec_;
  std::vector<float> grid_;    ///< rough ground: share of `grid_range_`, rows along y, columns x
  double grid_bottom_ = 0.0;   ///< m, height of share 0
  double grid_range_ = 0.0;    ///< m
  std::vector<Block> blocks_;  ///< one for each cell of a square grid, rows along y, columns x
};

}  // namespace pirouette
