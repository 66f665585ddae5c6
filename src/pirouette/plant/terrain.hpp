// Ground of the simulated world: kinds, height and collision shape.
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

/// The plane z = 0.
struct FlatGround {};

/// A plane through the origin, uphill along +x.
struct Slope {
  double degrees = 0.0;  ///< deg, angle from the horizontal
};

/// Straight stairs with the origin in the middle of a tread.
struct Stairs {
  double rise = 0.0;     ///< m
  double run = 0.0;      ///< m
  double degrees = 0.0;  ///< deg, from +x to the direction of climbing, counter-clockwise
};

/// Smooth isotropic random heights of zero mean, added along z to a slope.
struct RoughGround {
  double height = 0.0;         ///< m, from the lowest valley to the highest peak
  double slope_degrees = 0.0;  ///< deg, uphill along +x
};

/// Boxes scattered over flat ground within 2 m of the origin, each of a random height from 0 to
/// `height`.
struct Blocks {
  double height = 0.0;  ///< m
};

/// Flat ground with a square of another sliding friction, 0 <= x <= side and |y| <= side / 2: one
/// edge passes through the origin, so that half of the footholds of a robot that spins there are on
/// it.
struct Patch {
  double friction = 0.0;  ///< sliding friction
  double side = 0.0;      ///< m, length
};

/// Flat ground into which the feet sink.
struct SoftGround {
  double time_constant = 0.0;  ///< s, of the contact; replaces plant.contact_time_constant
};

/// Description of the ground.
using TerrainSpec = std::variant<FlatGround, Slope, Stairs, RoughGround, Blocks, Patch, SoftGround>;

/// Reads a value of plant.terrain; an error lists the allowed ones.
Result<TerrainSpec> parse_terrain(std::string_view text);

/// The value of plant.terrain for `spec`; parse_terrain() gives the same numbers.
std::string to_string(const TerrainSpec& spec);

/// Distance (m) of the ground's edge from the origin along x and y; infinite for planes.
double half_extent(const TerrainSpec& spec);

/// The ground of one world.
class Terrain {
 public:
  /// `seed` of rough ground and blocks; other ground does not depend on it.
  Terrain(const TerrainSpec& spec, std::uint64_t seed);

  /// Height (m) of the colliding surface at `xy` (m); beyond the edge, that of the nearest edge.
  double height(const Vec2& xy) const;

  /// Height (m) of the centre of a ball of `radius` (m) that is lowered at `xy` (m) until it
  /// touches the ground.
  double ball_height(const Vec2& xy, double radius) const;
  /// The point of the tread under `xy` (m) nearest to it on which a ball of `radius` (m) touches no
  /// edge; `xy` itself on ground without stairs.
  Vec2 beside_edges(const Vec2& xy, double radius) const;

  /// Unit normal of the overall slope, world axes; of stairs, of the plane through the middles of
  /// the treads.
  Vec3 normal() const;

  /// Sliding friction at `xy`; `elsewhere` where the terrain has none of its own.
  double friction(const Vec2& xy, double elsewhere) const;

  /// Time constant (s) of the feet's contact; `otherwise` if the terrain has none of its own.
  double contact_time_constant(double otherwise) const;

  /// Adds the ground's geoms to the world body of `spec`, with the `friction` of sliding (1),
  /// torsion (m) and rolling (m). They do not include the friction of a patch: see friction().
  void add_to(mjSpec_& spec, const Vec3& friction) const;

 private:
  /// A box that stands on flat ground.
  struct Block {
    Vec2 centre;          ///< m
    double yaw;           ///< rad
    double half_side;     ///< m
    double height = 0.0;  ///< m

    /// Horizontal distance (m) of `xy` (m) from the box; 0 above it.
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
