#include "pirouette/model/foot_finder.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

using RowMajorMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Points = std::vector<Vec3>;

/// A sphere is the foot unless another shape reaches farther by this share of the leg below the
/// knee.
constexpr double kBeyond = 0.02;
/// Share of a shape, measured from its end, that the sphere has to fit.
constexpr double kEnd = 0.4;
constexpr double kMaxMisfit = 0.25;  ///< of a fitted radius, rms
/// Least and largest radius of a foot as a share of the leg below the knee.
constexpr double kLeast = 0.03, kLargest = 0.25;

/// Points of the surface of `geom`, world axes; of a sphere or capsule its centres.
Points points_of(const mjModel& m, const mjData& d, int geom) {
  const RowMajorMat3 R = Eigen::Map<const RowMajorMat3>(d.geom_xmat + 9 * geom);
  const Vec3 centre = Eigen::Map<const Vec3>(d.geom_xpos + 3 * geom);
  const Vec3 size = Eigen::Map<const Vec3>(m.geom_size + 3 * geom);
  Points points;
  const auto add = [&](double x, double y, double z) {
    points.push_back(centre + R * Vec3(x, y, z));
  };
  switch (m.geom_type[geom]) {
    case mjGEOM_SPHERE:
      add(0.0, 0.0, 0.0);
      break;
    case mjGEOM_CAPSULE:
      for (const double end : {-1.0, 1.0}) add(0.0, 0.0, end * size[1]);
      break;
    case mjGEOM_BOX:
      for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
          for (const double z : {-1.0, 1.0}) add(x * size[0], y * size[1], z * size[2]);
      break;
    case mjGEOM_CYLINDER:
      for (int i = 0; i < 24; ++i) {
        const double angle = 2.0 * kPi * i / 24.0;
        for (const double end : {-1.0, 1.0})
          add(size[0] * std::cos(angle), size[0] * std::sin(angle), end * size[1]);
      }
      break;
    case mjGEOM_ELLIPSOID:
      for (int i = 0; i < 16; ++i) {
        for (int j = 0; j <= 8; ++j) {
          const double longitude = 2.0 * kPi * i / 16.0, latitude = kPi * (j / 8.0 - 0.5);
          add(size[0] * std::cos(latitude) * std::cos(longitude),
              size[1] * std::cos(latitude) * std::sin(longitude), size[2] * std::sin(latitude));
        }
      }
      break;
    case mjGEOM_MESH: {
      const int mesh = m.geom_dataid[geom];
      const float* vertex = m.mesh_vert + 3 * m.mesh_vertadr[mesh];
      for (int i = 0; i < m.mesh_vertnum[mesh]; ++i, vertex += 3)
        add(vertex[0], vertex[1], vertex[2]);
      break;
    }
    default:
      break;
  }
  return points;
}

bool is_round(const mjModel& m, int geom) {
  return m.geom_type[geom] == mjGEOM_SPHERE || m.geom_type[geom] == mjGEOM_CAPSULE;
}

/// Sphere through `points` in the least-squares sense of |p|^2 = 2 c.p + (r^2 - |c|^2).
struct Sphere {
  Vec3 centre;
  double radius, misfit;
};
Sphere fit_sphere(const Points& points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd A(count, 4);
  Eigen::VectorXd b(count);
  const Vec3 origin = points.front();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec3 p = points[static_cast<std::size_t>(i)] - origin;
    A.row(i) << 2.0 * p.transpose(), 1.0;
    b(i) = p.squaredNorm();
  }
  const Eigen::Vector4d x = A.colPivHouseholderQr().solve(b);
  const Vec3 centre = x.head<3>();
  const double radius = std::sqrt(std::max(0.0, x[3] + centre.squaredNorm()));
  double sum = 0.0;
  for (const Vec3& p : points) sum += square((p - origin - centre).norm() - radius);
  return {origin + centre, radius, std::sqrt(sum / static_cast<double>(count))};
}

/// Sphere at the end of a shape that is neither sphere nor capsule.
Sphere end_sphere(const Points& points, const Vec3& p_WK, double reach) {
  double nearest = reach;
  for (const Vec3& p : points) nearest = std::min(nearest, (p - p_WK).norm());
  const double from = reach - std::min(kEnd * (reach - nearest), kLargest * reach);
  Points end;
  Vec3 tip = Vec3::Zero();
  for (const Vec3& p : points) {
    if ((p - p_WK).norm() >= from) end.push_back(p), tip += p;
  }
  tip /= static_cast<double>(end.size());
  if (end.size() >= 8) {
    const Sphere fit = fit_sphere(end);
    const bool plausible = kLeast * reach < fit.radius && fit.radius < kLargest * reach;
    if (plausible && fit.misfit < kMaxMisfit * fit.radius) return fit;
  }
  // Half the narrowest width of the end, its surface touching the end's farthest point.
  const Vec3 along = (tip - p_WK).normalized();
  double width = reach;
  for (int i = 0; i < 12; ++i) {
    const Vec3 any = std::abs(along.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 across = Eigen::AngleAxisd(kPi * i / 12.0, along) * along.cross(any).normalized();
    double least = 0.0, most = 0.0;
    for (const Vec3& p : end) {
      least = std::min(least, across.dot(p - tip));
      most = std::max(most, across.dot(p - tip));
    }
    width = std::min(width, most - least);
  }
  const double radius = std::clamp(0.5 * width, kLeast * reach, kLargest * reach);
  return {p_WK + (reach - radius) * along, radius, 0.0};
}

}  // namespace

std::optional<Foot> find_foot(const mjModel& m, const mjData& d, int shank, const Vec3& p_WK,
                              const std::string& place, std::optional<double> radius) {
  const int at_geom = mj_name2id(&m, mjOBJ_GEOM, place.c_str());
  const int at_body = mj_name2id(&m, mjOBJ_BODY, place.c_str());
  const int at_site = mj_name2id(&m, mjOBJ_SITE, place.c_str());
  const auto belongs = [&](int geom) {
    if (place.empty()) return true;
    return at_geom >= 0 ? geom == at_geom : m.geom_bodyid[geom] == at_body;
  };

  int sphere = -1, other = -1;
  double sphere_reach = 0.0, other_reach = 0.0;
  for (int g = 0; g < m.ngeom; ++g) {
    if (m.body_weldid[m.geom_bodyid[g]] != m.body_weldid[shank] || !belongs(g)) continue;
    if (m.geom_contype[g] == 0 && m.geom_conaffinity[g] == 0 && g != at_geom) continue;
    double reach = 0.0;
    for (const Vec3& p : points_of(m, d, g)) reach = std::max(reach, (p - p_WK).norm());
    if (is_round(m, g)) reach += m.geom_size[3 * g];
    const bool is_sphere = m.geom_type[g] == mjGEOM_SPHERE;
    int& best = is_sphere ? sphere : other;
    double& farthest = is_sphere ? sphere_reach : other_reach;
    if (reach > farthest) farthest = reach, best = g;
  }

  Foot foot;
  if (sphere >= 0 && other_reach < (1.0 + kBeyond) * sphere_reach) {
    foot.geom = sphere;
    foot.is_sphere = true;
    foot.centre = Eigen::Map<const Vec3>(d.geom_xpos + 3 * sphere);
    foot.radius = radius.value_or(m.geom_size[3 * sphere]);
    return foot;
  }
  if (other >= 0) {
    foot.geom = other;
    const Points points = points_of(m, d, other);
    if (is_round(m, other)) {
      foot.radius = m.geom_size[3 * other];
      foot.centre = *std::max_element(
          points.begin(), points.end(),
          [&](const Vec3& a, const Vec3& b) { return (a - p_WK).norm() < (b - p_WK).norm(); });
    } else {
      const Sphere fit = end_sphere(points, p_WK, other_reach);
      foot.radius = fit.radius;
      foot.centre = fit.centre;
    }
    if (radius) {  // the end of the leg stays where it is
      foot.centre += (foot.radius - *radius) * (foot.centre - p_WK).normalized();
      foot.radius = *radius;
    }
    return foot;
  }
  if (!radius || (at_body < 0 && at_site < 0)) return std::nullopt;
  foot.centre =
      Eigen::Map<const Vec3>(at_site >= 0 ? d.site_xpos + 3 * at_site : d.xpos + 3 * at_body);
  foot.radius = *radius;
  return foot;
}

}  // namespace pirouette
