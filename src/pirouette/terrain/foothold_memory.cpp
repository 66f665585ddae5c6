#include "pirouette/terrain/foothold_memory.hpp"

#include <algorithm>
#include <limits>

#include "pirouette/base/rotation.hpp"
#include "pirouette/terrain/plane_estimator.hpp"

namespace pirouette {
namespace {

constexpr double kMinFootholds = 24.0;  // for a plane: three strides of four legs and as many again
constexpr double kMaxFromGradient = 0.5;  // rad, that the climb may differ from the gradient
constexpr double kMinGradient = 0.03;     // below it there is no direction to climb
constexpr std::size_t kFewestAlone = 60;  // fifteen strides of four legs
constexpr int kMinFootholdsPerTread = 3;  // fewer are feet on edges

// m, of a robot of scale 1.
constexpr double kNear = 0.5;           // around the robot
constexpr double kMaxResidual = 0.004;  // rms about the treads; more is no flight of stairs
constexpr double kReach = 0.05;  // beyond the outermost footholds that a tread is taken to go on

Vec2 unit_vector(double direction) { return Vec2(std::cos(direction), std::sin(direction)); }

}  // namespace

void FootholdMemory::reset() noexcept {
  added_ = tread_count_ = 0;
  valid_ = false;
  climb_.reset();
  plane_.reset();
}

void FootholdMemory::add(const Vec3& p_WC, const Vec2& p_WG) noexcept {
  if (!config_.memory) return;
  footholds_[added_++ % kCapacity] = p_WC;
  valid_ = false;
  fit_around(p_WG);
  if (!find_climb()) return;
  turn_climb();
  find_treads(count());
  // The odometry's height drifts: where old footholds contradict new ones, the new are asked alone.
  if (!valid_ && count() / 2 >= kFewestAlone) find_treads(count() / 2);
}

void FootholdMemory::fit_around(const Vec2& p_WG) noexcept {
  std::array<double, kCapacity> weights;
  const std::size_t n = count();
  for (std::size_t i = 0; i < n; ++i) {
    weights[i] = (footholds_[i].head<2>() - p_WG).norm() < kNear * scale_.length ? 1.0 : 0.0;
  }
  const TerrainPlane fit = fit_plane({footholds_.data(), n}, {weights.data(), n}, TerrainPlane{},
                                     config_.min_scatter, 0.0);
  plane_.reset();
  if (fit.weight >= kMinFootholds) plane_ = fit;
}

bool FootholdMemory::find_climb() noexcept {
  if (!plane_ || std::hypot(plane_->a1, plane_->a2) < kMinGradient) {
    climb_.reset();
    return false;
  }
  const double gradient = std::atan2(plane_->a2, plane_->a1);
  if (!climb_ || std::abs(wrap_angle(*climb_ - gradient)) > kMaxFromGradient) climb_ = gradient;
  return true;
}

double FootholdMemory::sort_along(double direction, std::size_t n) noexcept {
  const Vec2 uphill = unit_vector(direction);
  std::size_t found = 0;
  for (std::size_t i = 0; i < count(); ++i) {
    const std::size_t age = (added_ - 1 - i) % kCapacity;
    if (age < n) sorted_[found++] = {uphill.dot(footholds_[i].head<2>()), footholds_[i].z()};
  }
  std::sort(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(n),
            [](const Sample& a, const Sample& b) { return a.along < b.along; });
  double jumps = 0.0;
  for (std::size_t i = 1; i < n; ++i) jumps += square(sorted_[i].height - sorted_[i - 1].height);
  return jumps;
}

void FootholdMemory::turn_climb() noexcept {
  constexpr double kTurn = 0.02;  // rad, tried to both sides
  double best = *climb_;
  double least = sort_along(best, count());
  for (const double tried : {*climb_ - kTurn, *climb_ + kTurn}) {
    const double jumps = sort_along(tried, count());
    if (jumps < least) least = jumps, best = tried;
  }
  climb_ = best;
}

void FootholdMemory::find_treads(std::size_t n) noexcept {
  sort_along(*climb_, n);
  tread_count_ = 0;
  std::size_t kept = 0;
  double squares = 0.0;
  Tread open;
  const auto close = [&] {
    // Of two pieces at one height the feet on the edge between them are left out.
    if (open.count < kMinFootholdsPerTread) return;
    if (tread_count_ > 0 &&
        std::abs(treads_[tread_count_ - 1].height - open.height) < config_.min_step) {
      treads_[tread_count_ - 1].to = open.to;
    } else {
      treads_[tread_count_++] = open;
    }
    kept += static_cast<std::size_t>(open.count);
    squares += open.squares;
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Sample& s = sorted_[i];
    if (open.count > 0 && std::abs(s.height - open.height) > config_.min_step) {
      close();
      open = {};
    }
    if (open.count == 0) open.from = s.along;
    open.to = s.along;
    const double off = s.height - open.height;
    ++open.count;
    open.height += off / open.count;
    open.squares += off * (s.height - open.height);
  }
  close();
  constexpr double kMinShareKept = 0.7;
  valid_ = tread_count_ >= 2 &&
           static_cast<double>(kept) > kMinShareKept * static_cast<double>(n) &&
           std::sqrt(squares / static_cast<double>(kept)) < kMaxResidual * scale_.length;
}

double FootholdMemory::lower_edge(std::size_t tread) const noexcept {
  if (tread == 0) return -std::numeric_limits<double>::infinity();
  return 0.5 * (treads_[tread - 1].to + treads_[tread].from);
}

double FootholdMemory::upper_edge(std::size_t tread) const noexcept {
  if (tread + 1 == tread_count_) return std::numeric_limits<double>::infinity();
  return lower_edge(tread + 1);
}

std::optional<RememberedGround> FootholdMemory::at(const Vec2& p_W) const noexcept {
  if (!valid_) return std::nullopt;
  const Vec2 uphill = unit_vector(*climb_);
  const double along = uphill.dot(p_W);
  const double reach = kReach * scale_.length;
  if (along < treads_[0].from - reach || along > treads_[tread_count_ - 1].to + reach) {
    return std::nullopt;
  }
  std::size_t tread = 0;
  while (along > upper_edge(tread)) ++tread;
  const double lowest = lower_edge(tread) + config_.edge_margin;
  const double highest = upper_edge(tread) - config_.edge_margin;
  const double moved =
      lowest > highest ? 0.5 * (lowest + highest) : std::clamp(along, lowest, highest);
  return RememberedGround{p_W + (moved - along) * uphill, treads_[tread].height};
}

}  // namespace pirouette
