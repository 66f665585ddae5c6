// Ground plane through the feet's last contacts, and the trunk attitude parallel to it.
#pragma once

#include <optional>
#include <span>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/terrain/terrain_config.hpp"
#include "pirouette/types/terrain_plane.hpp"

namespace pirouette {

/// Weighted least-squares plane through `points_W` (m). A direction in which the points scatter
/// less than `min_scatter` (m^2) keeps the slope of `previous`; `ridge` (m^2) pulls the other
/// slopes towards it. Weights that sum to zero return `previous` with weight 0. [Zhu21] Eqs.
/// (13)-(14), guarded (E14): docs/equations.md#eq-14
TerrainPlane fit_plane(std::span<const Vec3> points_W, std::span<const double> weights,
                       const TerrainPlane& previous, double min_scatter, double ridge) noexcept;

/// Attitude (rad) with the trunk's z axis along the plane's normal and its heading at `yaw` (rad)
/// (E15).
RollPitchYaw terrain_aligned_rpy(const TerrainPlane& plane, double yaw);

/// Angular velocity (rad/s, world axes) of a trunk that stays aligned with the plane while its yaw
/// changes at `yaw_rate` (E16).
Vec3 terrain_aligned_rate(const TerrainPlane& plane, double yaw, double yaw_rate);

/// Input of PlaneEstimator::update().
struct PlaneInput {
  PerLeg<Vec3> p_WC = PerLeg<Vec3>::filled(Vec3::Zero());  ///< m, contact points
  PerLeg<bool> touching{};                                 ///< feet on the ground
  /// Plane through many more contacts, used instead of the feet.
  std::optional<TerrainPlane> remembered;
};

/// Low-passed plane through the last contact of each foot.
class PlaneEstimator {
 public:
  explicit PlaneEstimator(const TerrainConfig& config) : config_(config) {}  ///< horizontal plane

  /// Plane after one tick of `dt` (s).
  TerrainPlane update(const PlaneInput& in, double dt) noexcept;

  /// Discards all contacts; the result is `plane` until feet touch the ground.
  void reset(const TerrainPlane& plane) noexcept;

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, plane, contacts] = self;
    visit(plane, contacts);
  }

 private:
  struct Contact {
    Vec3 p_WC = Vec3::Zero();
    double age = 0.0;  ///< s since the foot left it
    bool known = false;
  };

  void remember_contacts(const PlaneInput& in, double dt) noexcept;
  double weight(const Contact& contact) const noexcept;

  TerrainConfig config_;
  TerrainPlane plane_;
  PerLeg<Contact> contacts_;
};

}  // namespace pirouette
