// The ground plane from the feet's last contacts, and the trunk attitude that goes with it.
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
/// less than `min_scatter` (m^2) keeps the slope of `previous`; `ridge` (m^2) pulls the others
/// towards it. Weights that sum to zero return `previous` with weight 0. [Zhu21] Eqs. (13)-(14),
/// guarded (E14): docs/equations.md#eq-14
TerrainPlane fit_plane(std::span<const Vec3> points_W, std::span<const double> weights,
                       const TerrainPlane& previous, double min_scatter, double ridge) noexcept;

/// Attitude with the trunk's z axis along the plane's normal and its heading at `yaw` (E15).
RollPitchYaw terrain_aligned_rpy(const TerrainPlane& plane, double yaw);

/// rad/s, world axes: angular velocity of a trunk that stays aligned with the plane while its yaw
/// changes at `yaw_rate` (E16).
Vec3 terrain_aligned_rate(const TerrainPlane& plane, double yaw, double yaw_rate);

struct PlaneInput {
  PerLeg<Vec3> p_WC = PerLeg<Vec3>::filled(Vec3::Zero());  ///< m, contact points
  PerLeg<bool> touching{};
  std::optional<TerrainPlane> remembered;  ///< through many more contacts; used instead of the feet
};

class PlaneEstimator {
 public:
  explicit PlaneEstimator(const TerrainConfig& config) : config_(config) {}

  TerrainPlane update(const PlaneInput& in, double dt) noexcept;

  /// Forgets all contacts; the ground is `plane` until feet say otherwise.
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
