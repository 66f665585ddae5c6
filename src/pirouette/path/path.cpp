#include "pirouette/path/path.hpp"

#include <Eigen/SparseCholesky>
#include <limits>

#include "pirouette/base/planar_twist.hpp"
#include "pirouette/base/rotation.hpp"

namespace pirouette {
namespace {

using Piece = Spline::Piece;

constexpr double kPieceLength = 0.02;  // m, about, of a spline's pieces

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

Vec2 position(const Piece& k, double u) {
  return k.c.col(0) + u * (k.c.col(1) + u * (k.c.col(2) + u * k.c.col(3)));
}
Vec2 first_derivative(const Piece& k, double u) {
  return k.c.col(1) + u * (2.0 * k.c.col(2) + 3.0 * u * k.c.col(3));
}
Vec2 second_derivative(const Piece& k, double u) { return 2.0 * k.c.col(2) + 6.0 * u * k.c.col(3); }

/// m, from the piece's beginning: Gauss-Legendre of five points.
double arc_length(const Piece& k, double u) {
  constexpr double kNodes[] = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr double kWeights[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double half = 0.5 * u;
  double sum = kWeights[0] * first_derivative(k, half).norm();
  for (int i = 1; i < 3; ++i) {
    sum += kWeights[i] * (first_derivative(k, half * (1.0 - kNodes[i])).norm() +
                          first_derivative(k, half * (1.0 + kNodes[i])).norm());
  }
  return half * sum;
}

/// Least |p'| of the piece, which is about 1 everywhere but where the curve turns back on itself.
/// p' is taken as straight between samples.
double least_speed(const Piece& k) {
  constexpr int kSamples = 8;
  double least = std::numeric_limits<double>::infinity();
  Vec2 from = first_derivative(k, 0.0);
  for (int i = 1; i <= kSamples; ++i) {
    const Vec2 to = first_derivative(k, i * k.end / kSamples);
    const Vec2 step = to - from;
    const double length2 = step.squaredNorm();
    const double share = length2 > 0.0 ? std::clamp(-from.dot(step) / length2, 0.0, 1.0) : 0.0;
    least = std::min(least, (from + share * step).norm());
    from = to;
  }
  return least;
}

/// The same curve with u counted from `start`, up to `length` further.
Piece cut(const Piece& k, double start, double length) {
  Piece out;
  out.c << position(k, start), first_derivative(k, start), 0.5 * second_derivative(k, start),
      k.c.col(3);
  out.end = length;
  return out;
}

bool are_usable(std::span<const Vec2> waypoints, bool closed) {
  constexpr double kMinChord = 1e-6;  // m
  if (waypoints.size() < (closed ? 3 : 2)) return false;
  const std::size_t chords = closed ? waypoints.size() : waypoints.size() - 1;
  for (std::size_t i = 0; i < chords; ++i) {
    const double chord = (waypoints[(i + 1) % waypoints.size()] - waypoints[i]).norm();
    if (!std::isfinite(chord) || chord < kMinChord) return false;
  }
  return true;
}

/// Second derivatives at the waypoints of the spline over `chords`: the tridiagonal (closed:
/// cyclic) system that makes first derivatives agree.
Eigen::MatrixX2d knot_curvatures(std::span<const Vec2> waypoints, std::span<const double> chords) {
  const auto n = static_cast<int>(waypoints.size());
  const bool closed = chords.size() == waypoints.size();
  Eigen::SparseMatrix<double> system(n, n);
  Eigen::MatrixX2d slope_change = Eigen::MatrixX2d::Zero(n, 2);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    if (!closed && (i == 0 || i == n - 1)) {
      entries.emplace_back(i, i, 1.0);  // natural: no curvature at the ends
      continue;
    }
    const int before = (i + n - 1) % n, after = (i + 1) % n;
    const auto at = [&](int k) -> const Vec2& { return waypoints[static_cast<std::size_t>(k)]; };
    const double h0 = chords[static_cast<std::size_t>(before)];
    const double h1 = chords[static_cast<std::size_t>(i)];
    entries.emplace_back(i, i, 2.0 * (h0 + h1));
    if (closed || before > 0) entries.emplace_back(i, before, h0);
    if (closed || after < n - 1) entries.emplace_back(i, after, h1);
    const Vec2 change = 6.0 * ((at(after) - at(i)) / h1 - (at(i) - at(before)) / h0);
    slope_change.row(i) = change.transpose();
  }
  system.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(system).solve(slope_change);
}

}  // namespace

PathSample Arc::at(double s) const noexcept {
  const Vec2 travelled = planar_twist_displacement(Vec2::UnitX(), curvature, s);
  return {start + rot2(heading) * travelled, wrap_angle(heading + curvature * s), curvature};
}

double Arc::nearest(const Vec2& p, double s_near) const noexcept {
  const Vec2 from_start = rot2(-heading) * (p - start);  // tangent and normal at the start
  if (curvature == 0.0) return from_start.x();
  const Vec2 from_centre(from_start.x(), from_start.y() - 1.0 / curvature);
  if (from_centre.isZero(0.0)) return s_near;  // every point is as near
  const double side = curvature > 0.0 ? 1.0 : -1.0;
  const double angle = std::atan2(side * from_centre.x(), -side * from_centre.y());
  return s_near + wrap_angle(angle - curvature * s_near) / curvature;
}

void Spline::index_pieces() {
  const std::size_t parts = pieces.size() + 1;
  part_begins.clear();
  std::uint32_t piece = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    const double s = length * static_cast<double>(part) / static_cast<double>(parts - 1);
    while (piece + 1 < pieces.size() && pieces[piece + 1].s <= s) ++piece;
    part_begins.push_back(piece);
  }
}

std::size_t Spline::piece_at(double s) const noexcept {
  if (!(s > 0.0)) return 0;
  const std::size_t parts = part_begins.size();
  const auto part =
      static_cast<std::size_t>(std::min(s / length, 1.0) * static_cast<double>(parts - 1));
  // One part further on each side: s / length may round across the border of two.
  const std::size_t first = part_begins[part > 0 ? part - 1 : 0];
  const std::size_t last = part_begins[std::min(part + 2, parts - 1)];
  const auto begin = pieces.begin() + static_cast<std::ptrdiff_t>(first) + 1;
  const auto end = pieces.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  const auto after =
      std::upper_bound(begin, end, s, [](double value, const Piece& k) { return value < k.s; });
  return static_cast<std::size_t>(after - pieces.begin()) - 1;
}

PathSample Spline::at(double s) const noexcept {
  constexpr int kNewtonSteps = 3;  // of pieces so short that one is nearly exact
  s = closed ? s - length * std::floor(s / length) : std::clamp(s, 0.0, length);
  const Piece& piece = pieces[piece_at(s)];
  double u = (s - piece.s) / first_derivative(piece, 0.0).norm();
  for (int i = 0; i < kNewtonSteps; ++i) {
    u += (s - piece.s - arc_length(piece, u)) / first_derivative(piece, u).norm();
  }
  const Vec2 d1 = first_derivative(piece, u);
  const double speed = d1.norm();
  return {position(piece, u), std::atan2(d1.y(), d1.x()),
          cross(d1, second_derivative(piece, u)) / (speed * speed * speed)};
}

double Spline::nearest(const Vec2& p, double s_near, double window) const noexcept {
  const double lap = closed ? length * std::floor(s_near / length) : 0.0;
  const double reach = std::min(window, closed ? 0.5 * length : length);
  const auto to_near = [&](double s) {  // signed way from s_near to a point of the first lap
    const double way = s + lap - s_near;
    return closed ? std::remainder(way, length) : way;
  };
  // The nearest beginning of a piece within reach, or s_near itself ...
  double best = std::numeric_limits<double>::infinity(), way = 0.0;
  const auto consider = [&](const Vec2& q, double candidate) {
    const double distance = (q - p).squaredNorm();
    if (distance < best) best = distance, way = candidate;
  };
  const auto consider_between = [&](double from, double to) {  // m, within the first lap
    if (from > length + kPieceLength || to < -kPieceLength) return;
    const std::size_t first = piece_at(from), last = std::min(piece_at(to) + 1, pieces.size() - 1);
    for (std::size_t i = first > 0 ? first - 1 : 0; i <= last; ++i) {
      const double candidate = to_near(pieces[i].s);
      if (std::abs(candidate) <= reach) consider(pieces[i].c.col(0), candidate);
    }
  };
  const double low_end = s_near - lap - reach, high_end = s_near - lap + reach;
  if (closed) consider_between(0.0, high_end - length);
  consider_between(low_end, high_end);
  if (closed) consider_between(low_end + length, length);
  consider(at(s_near).p, 0.0);
  if (!closed) consider(at(length).p, std::clamp(length - s_near, -reach, reach));
  // ... then Newton on (p(s) - p).t(s) = 0, no further than a piece on either side.
  constexpr int kNewtonSteps = 8;
  constexpr double kMinSlope = 0.1;  // 1 far from the centre of curvature, 0 there
  const double low = std::max(way - 2.0 * kPieceLength, -reach);
  const double high = std::min(way + 2.0 * kPieceLength, reach);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const PathSample here = at(s_near + way);
    const Vec2 tangent(std::cos(here.heading), std::sin(here.heading));
    const Vec2 error = here.p - p;
    const double slope = 1.0 + here.curvature * cross(tangent, error);
    way = std::clamp(way - error.dot(tangent) / std::max(slope, kMinSlope), low, high);
  }
  const double s = s_near + way;
  return closed ? s : std::clamp(s, 0.0, length);
}

Path Path::line(const Vec2& start, double heading) { return arc(start, heading, 0.0); }

Path Path::circle(const Vec2& start, double heading, double radius) {
  return arc(start, heading, 1.0 / radius);
}

Path Path::arc(const Vec2& start, double heading, double curvature) {
  return Path(Arc{start, heading, curvature});
}

std::optional<Path> Path::spline(std::span<const Vec2> waypoints, bool closed,
                                 std::size_t* turns_back_after) {
  if (!are_usable(waypoints, closed)) return std::nullopt;
  const std::size_t n = waypoints.size();
  std::vector<double> chords;
  for (std::size_t i = 0; i + 1 < n + (closed ? 1 : 0); ++i) {
    chords.push_back((waypoints[(i + 1) % n] - waypoints[i]).norm());
  }
  const Eigen::MatrixX2d m = knot_curvatures(waypoints, chords);

  constexpr double kMinSpeed = 0.02;
  Spline spline;
  spline.closed = closed;
  for (std::size_t i = 0; i < chords.size(); ++i) {
    const double h = chords[i];
    const Vec2 m0 = m.row(static_cast<Eigen::Index>(i)).transpose();
    const Vec2 m1 = m.row(static_cast<Eigen::Index>((i + 1) % n)).transpose();
    Piece whole;
    whole.c << waypoints[i],
        (waypoints[(i + 1) % n] - waypoints[i]) / h - h / 6.0 * (2.0 * m0 + m1), 0.5 * m0,
        (m1 - m0) / (6.0 * h);
    const double count = std::ceil(h / kPieceLength);
    for (double k = 0.0; k < count; ++k) {
      Piece piece = cut(whole, k * h / count, h / count);
      if (!(least_speed(piece) > kMinSpeed)) {
        if (turns_back_after != nullptr) *turns_back_after = i;
        return std::nullopt;
      }
      piece.s = spline.length;
      spline.length += arc_length(piece, piece.end);
      spline.pieces.push_back(piece);
    }
  }
  spline.index_pieces();
  return Path(std::move(spline));
}

void Path::start_at(const Vec2& start, double heading) noexcept {
  if (auto* arc = std::get_if<Arc>(&shape_)) {
    arc->start = start;
    arc->heading = heading;
    return;
  }
  const PathSample old = at(0.0);
  const Mat2 turn = rot2(heading - old.heading);
  for (Piece& k : std::get<Spline>(shape_).pieces) {
    k.c.col(0) -= old.p;
    for (int i = 0; i < 4; ++i) k.c.col(i) = (turn * k.c.col(i)).eval();
    k.c.col(0) += start;
  }
}

PathSample Path::at(double s) const noexcept {
  return std::visit([&](const auto& shape) { return shape.at(s); }, shape_);
}

double Path::nearest(const Vec2& p) const noexcept {
  return nearest(p, 0.0, std::numeric_limits<double>::infinity());
}

double Path::nearest(const Vec2& p, double s_near, double window) const noexcept {
  if (const auto* arc = std::get_if<Arc>(&shape_)) return arc->nearest(p, s_near);
  return std::get<Spline>(shape_).nearest(p, s_near, window);
}

double Path::length() const noexcept {
  if (const auto* spline = std::get_if<Spline>(&shape_)) return spline->length;
  const double curvature = std::abs(std::get<Arc>(shape_).curvature);
  return curvature > 0.0 ? 2.0 * kPi / curvature : std::numeric_limits<double>::infinity();
}

bool Path::closed() const noexcept {
  if (const auto* spline = std::get_if<Spline>(&shape_)) return spline->closed;
  return std::get<Arc>(shape_).curvature != 0.0;
}

}  // namespace pirouette
