// The sphere on which a leg stands, in a robot whose feet may have any shape.
#pragma once

#include <optional>
#include <string>

#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/model/mujoco.hpp"

namespace pirouette {

/// A foot in a compiled model.
struct Foot {
  int geom = -1;  ///< the colliding geom that is the foot, or in whose place the sphere stands
  bool is_sphere = false;      ///< the geom is the sphere itself
  Vec3 centre = Vec3::Zero();  ///< m, world axes
  double radius = 0.0;         ///< m
};

/// The foot among the geoms fixed to body `shank`, whose knee is at `p_WK` (m), at the pose of
/// `data`: the colliding sphere farthest from the knee or, where another shape reaches farther,
/// the sphere that fits its end. `place` names a geom, body or site to which the foot belongs;
/// empty: any. Without a colliding geom there, `radius` makes a sphere at that body or site.
std::optional<Foot> find_foot(const mjModel& model, const mjData& data, int shank, const Vec3& p_WK,
                              const std::string& place, std::optional<double> radius);

}  // namespace pirouette
