// Plane curves by arc length: the path of the CoM.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "pirouette/base/math.hpp"

namespace pirouette {

/// A point of a path, in the frame of the path.
struct PathSample {
  Vec2 p = Vec2::Zero();   ///< m
  double heading = 0.0;    ///< rad, of the tangent, in [-pi, pi]
  double curvature = 0.0;  ///< 1/m, positive to the left
};

/// Curve of constant curvature: a straight line or a circle.
struct Arc {
  Vec2 start = Vec2::Zero();  ///< m
  double heading = 0.0;       ///< rad, of the tangent at the start
  double curvature = 0.0;     ///< 1/m

  /// Point at arc length `s` (m).
  PathSample at(double s) const noexcept;
  /// Arc length (m) of the point nearest to `p` (m), on a circle the one nearest to `s_near` (m).
  double nearest(const Vec2& p, double s_near) const noexcept;
};

/// Twice continuously differentiable cubic spline, cut into short pieces.
struct Spline {
  /// p(u) = c0 + c1 u + c2 u^2 + c3 u^3 for u in [0, end].
  struct Piece {
    Eigen::Matrix<double, 2, 4, Eigen::DontAlign> c;  ///< c0 to c3
    double end = 0.0;                                 ///< m, largest u
    double s = 0.0;                                   ///< m, arc length at u = 0
  };
  std::vector<Piece> pieces;  ///< from the start
  double length = 0.0;        ///< m
  bool closed = false;        ///< the last piece ends where the first begins
  /// Index of the piece at each of as many borders as there are pieces, one more, evenly along the
  /// length: with it, finding a piece takes as long on any path.
  std::vector<std::uint32_t> part_begins;

  /// Fills part_begins from the pieces.
  void index_pieces();
  /// Index of the piece at arc length `s` (m), held within [0, length].
  std::size_t piece_at(double s) const noexcept;
  /// Point at arc length `s` (m).
  PathSample at(double s) const noexcept;
  /// Arc length (m) of the point nearest to `p` (m) within `window` (m) of `s_near` (m); takes time
  /// in proportion to the window.
  double nearest(const Vec2& p, double s_near, double window) const noexcept;
};

/// A line, circle or spline; only construction and copying allocate. Arc length `s` (m) counts on
/// from lap to lap of a closed path and is held within [0, length] on an open one; a line has no
/// ends. [Zhu21] Eq. (19), corrected: docs/equations.md#eq-19
class Path {
 public:
  /// The line from the origin along x.
  Path() = default;
  /// The line from `start` (m) along `heading` (rad).
  static Path line(const Vec2& start, double heading);
  /// Circle of signed `radius` (m), not 0: a positive one has its centre to the left.
  static Path circle(const Vec2& start, double heading, double radius);
  /// Curve of constant signed `curvature` (1/m); 0: a line.
  static Path arc(const Vec2& start, double heading, double curvature);
  /// Cubic spline through `waypoints` (m) over their chord length: natural ends, or periodic when
  /// `closed` (the first is not repeated). Absent for fewer than two waypoints (three when closed),
  /// neighbours that coincide, values that are not finite, and a curve that turns back on itself,
  /// because it has no tangent there; the index of the waypoint before that place then goes to
  /// `turns_back_after`.
  static std::optional<Path> spline(std::span<const Vec2> waypoints, bool closed,
                                    std::size_t* turns_back_after = nullptr);

  /// Moves the path so that it starts at `start` with its tangent along `heading` (rad).
  void start_at(const Vec2& start, double heading) noexcept;

  /// Point at arc length `s` (m).
  PathSample at(double s) const noexcept;
  /// Arc length (m) of the point nearest to `p` (m), over all of the path.
  double nearest(const Vec2& p) const noexcept;
  /// The same within `window` (m) of `s_near` on both sides, and on a circle the one nearest to
  /// `s_near`: where a path crosses itself, the branch that is being followed.
  double nearest(const Vec2& p, double s_near, double window) const noexcept;

  double length() const noexcept;  ///< m, of one lap; infinite for a line
  bool closed() const noexcept;    ///< ends where it begins

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [shape] = self;
    visit(shape);
  }

 private:
  explicit Path(std::variant<Arc, Spline> shape) : shape_(std::move(shape)) {}

  std::variant<Arc, Spline> shape_;
};

}  // namespace pirouette
