// Map of stairs from the footholds: treads along the climb and their edges.
#pragma once

#include <array>
#include <optional>

#include "pirouette/base/math.hpp"
#include "pirouette/terrain/terrain_config.hpp"
#include "pirouette/types/robot_scale.hpp"
#include "pirouette/types/terrain_plane.hpp"

namespace pirouette {

/// Adapted foothold on a remembered tread.
struct RememberedGround {
  Vec2 p_W = Vec2::Zero();  ///< m, moved along the climb away from the nearest edge
  double height = 0.0;      ///< m, of the tread
};

/// Footholds of the last strides in the odometry's frame, sorted along the direction of the climb.
/// The first guess of that direction is the gradient of the plane through them, several degrees off
/// on steps; with each foothold it turns to where the sorted heights jump least. Neighbours that
/// differ in height by more than min_step have an edge between them; the footholds between two
/// edges are on one tread. Single odd heights (a foot on an edge) make no tread. Where the treads
/// do not explain the heights, as on rough ground, there is no result. Assumes straight stairs;
/// old footholds are discarded, to follow the odometry's drift. docs/terrain.md#memory
class FootholdMemory {
 public:
  static constexpr std::size_t kCapacity = 160;  ///< footholds kept

  /// No footholds.
  explicit FootholdMemory(const TerrainConfig& config, const RobotScale& scale = {})
      : config_(config), scale_(scale) {}

  /// Adds one foothold, once per stance: contact point `p_WC` (m) of a foot on level ground; `p_WG`
  /// (m) is the CoM.
  void add(const Vec3& p_WC, const Vec2& p_WG) noexcept;

  /// Plane through the footholds around the robot, on any kind of ground; on steps it varies much
  /// less than the plane through the last four. Absent while there are few footholds.
  const std::optional<TerrainPlane>& plane() const { return plane_; }

  /// The remembered ground at `p_W` (m); absent where it is not known.
  std::optional<RememberedGround> at(const Vec2& p_W) const noexcept;

  std::size_t tread_count() const { return valid_ ? tread_count_ : 0; }  ///< number of treads known
  void reset() noexcept;                                                 ///< no footholds

  /// See base/memory.hpp. Of the footholds only the count() valid ones.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, scale, footholds, added, plane, climb, sorted, treads, tread_count, valid] =
        self;
    visit(added, plane, climb, treads, tread_count, valid);
    for (std::size_t i = 0; i < self.count(); ++i) visit(footholds[i]);
  }

 private:
  struct Sample {
    double along;  ///< m, uphill
    double height;
  };
  struct Tread {
    double from = 0.0, to = 0.0;  ///< m, of the footholds on it, uphill
    double height = 0.0;          ///< m, mean
    double squares = 0.0;         ///< m^2, of the heights about it
    int count = 0;
  };

  std::size_t count() const { return std::min(added_, kCapacity); }
  void fit_around(const Vec2& p_WG) noexcept;
  bool find_climb() noexcept;
  /// m^2, sum of the squared jumps of the newest `n` heights in their order along `direction`
  /// (rad), in which it leaves sorted_.
  double sort_along(double direction, std::size_t n) noexcept;
  /// Turns climb_ a little to where the heights jump less.
  void turn_climb() noexcept;
  /// Treads of the newest `n` footholds.
  void find_treads(std::size_t n) noexcept;
  double lower_edge(std::size_t tread) const noexcept;
  double upper_edge(std::size_t tread) const noexcept;

  TerrainConfig config_;
  RobotScale scale_;
  std::array<Vec3, kCapacity> footholds_;
  std::size_t added_ = 0;
  std::optional<TerrainPlane> plane_;
  std::optional<double> climb_;  ///< rad, direction uphill in the world; absent: none known
  std::array<Sample, kCapacity> sorted_;
  std::array<Tread, kCapacity> treads_;
  std::size_t tread_count_ = 0;
  bool valid_ = false;
};

}  // namespace pirouette
