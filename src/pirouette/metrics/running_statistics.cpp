#include "pirouette/metrics/running_statistics.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include "pirouette/metrics/statistics.hpp"

namespace pirouette {

void RunningMoments::add(double count, double mean, double squares) {
  const double delta = mean - mean_;
  const double sum = count_ + count;
  squares_ += squares + square(delta) * count_ * count / sum;
  mean_ += delta * count / sum;
  count_ = sum;
}

std::optional<double> RunningMoments::mean() const {
  if (count_ < 1.0) return std::nullopt;
  return mean_;
}

std::optional<double> RunningMoments::variance() const {
  if (count_ < 2.0) return std::nullopt;
  return squares_ / (count_ - 1.0);
}

// ---- quantiles: bins are the values of a double's exponent and leading 11 bits ----

namespace {

constexpr int kDroppedBits = 52 - 11;
constexpr double kLowest = 0x1p-32, kHighest = 0x1p32;
constexpr std::uint64_t kFirstBin = std::bit_cast<std::uint64_t>(kLowest) >> kDroppedBits;
constexpr std::uint64_t kBins =
    (std::bit_cast<std::uint64_t>(kHighest) >> kDroppedBits) - kFirstBin;

std::size_t bin_of(double x) {
  if (!(x > kLowest)) return 0;
  if (x >= kHighest) return kBins - 1;
  return (std::bit_cast<std::uint64_t>(x) >> kDroppedBits) - kFirstBin;
}

double lower_edge(std::size_t bin) {
  return std::bit_cast<double>((kFirstBin + bin) << kDroppedBits);
}

}  // namespace

void RunningQuantiles::add(double x) {
  if (std::isnan(x)) has_nan_ = true;
  largest_ = count_ == 0 ? x : std::max(largest_, x);
  ++count_;
  if (!bins_.empty()) {
    ++bins_[bin_of(x)];
    return;
  }
  samples_.push_back(x);
  if (samples_.size() <= kExact) return;
  bins_.assign(kBins, 0);
  for (const double sample : samples_) ++bins_[bin_of(sample)];
  samples_ = {};
}

std::optional<double> RunningQuantiles::quantile(double share) const {
  if (count_ == 0 || has_nan_) return std::nullopt;
  if (bins_.empty()) return pirouette::quantile(samples_, share);
  const double position = share * static_cast<double>(count_ - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, count_ - 1);
  return std::lerp(order_statistic(below), order_statistic(above),
                   position - static_cast<double>(below));
}

double RunningQuantiles::order_statistic(std::size_t index) const {
  std::size_t bin = 0, below = 0;
  while (bin + 1 < kBins && below + bins_[bin] <= index) below += bins_[bin++];
  const double part = (static_cast<double>(index - below) + 0.5) / static_cast<double>(bins_[bin]);
  return std::min(largest_, std::lerp(lower_edge(bin), lower_edge(bin + 1), part));
}

std::optional<double> RunningQuantiles::largest() const {
  if (count_ == 0 || has_nan_) return std::nullopt;
  return largest_;
}

void WindowRange::add(double x) {
  if (std::isnan(x)) sum_ = x;
  low_ = filled_ == 0 ? x : std::min(low_, x);
  high_ = filled_ == 0 ? x : std::max(high_, x);
  if (++filled_ < length_) return;
  sum_ += high_ - low_;
  ++windows_;
  filled_ = 0;
}

std::optional<double> WindowRange::mean() const {
  if (windows_ > 0) return sum_ / static_cast<double>(windows_);
  if (filled_ > 0) return sum_ + (high_ - low_);
  return std::nullopt;
}

void PointMoments::add(const PointMoments& other) {
  const Vec2 delta = other.mean - mean;
  const double sum = count + other.count;
  scatter += other.scatter + delta * delta.transpose() * (count * other.count / sum);
  mean += delta * (other.count / sum);
  count = sum;
}

void CircleFit::add(const Vec2& p) {
  const Vec2 delta = p - points_.mean;
  const double n = points_.count + 1.0;
  const Mat2& scatter = points_.scatter;  // before p
  moment_ += delta * delta.squaredNorm() * ((n - 1.0) * (n - 2.0) / square(n)) -
             (scatter.trace() * delta + 2.0 * scatter * delta) / n;
  points_.add({1.0, p, Mat2::Zero()});
}

std::optional<Circle> CircleFit::circle() const {
  if (points_.count < 3.0) return std::nullopt;
  // About the mean point the constant decouples: 2 S c = sum x |x|^2, k = mean |x|^2.
  constexpr double kCollinear = 1e-12;  // of the scatter's eigenvalues: rounding of doubles
  const Mat2& scatter = points_.scatter;
  const double trace = scatter.trace();
  if (!(scatter.determinant() > kCollinear * trace * trace)) return std::nullopt;
  const Vec2 centre = scatter.ldlt().solve(0.5 * moment_);
  return Circle{points_.mean + centre, std::sqrt(trace / points_.count + centre.squaredNorm())};
}

// ---- points that become cells ----

PointCloud::PointCloud() : directions_(kDirections), extremes_(kDirections) {
  points_.reserve(kCapacity + 1);
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * kPi * static_cast<double>(k) / static_cast<double>(kDirections);
    directions_[k] = Vec2(std::cos(angle), std::sin(angle));
  }
}

void PointCloud::add(const Vec2& p) {
  if (!p.allFinite()) {
    has_nan_ = true;
    return;
  }
  if (points_.empty()) {
    origin_ = p;
    std::fill(extremes_.begin(), extremes_.end(), p);
  }
  for (std::size_t k = 0; k < kDirections; ++k) {
    if (directions_[k].dot(p) > directions_[k].dot(extremes_[k])) extremes_[k] = p;
  }
  points_.push_back({1.0, p, Mat2::Zero()});
  if (points_.size() <= kCapacity) return;
  if (cell_ == 0.0) cell_ = smallest_cell();
  while (!merge_cells()) cell_ *= 2.0;
}

double PointCloud::smallest_cell() const {
  constexpr double kShare = 1.0 / 1024.0, kLeast = 1e-12;  // m
  double extent = 0.0;
  for (const Vec2& p : extremes_) extent = std::max(extent, (p - origin_).norm());
  return std::max(kLeast, kShare * extent);
}

bool PointCloud::merge_cells() {
  struct Place {
    double x, y;
    std::size_t index;
    bool operator<(const Place& b) const {
      return std::tie(x, y, index) < std::tie(b.x, b.y, b.index);
    }
    bool same_cell(const Place& b) const { return x == b.x && y == b.y; }
  };
  std::vector<Place> places;
  places.reserve(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vec2 place = (points_[i].mean - origin_) / cell_;
    places.push_back({std::floor(place.x()), std::floor(place.y()), i});
  }
  std::sort(places.begin(), places.end());
  std::size_t cells = 1;
  for (std::size_t i = 1; i < places.size(); ++i) cells += !places[i].same_cell(places[i - 1]);
  if (cells > kCapacity / 2) return false;
  std::vector<PointMoments> merged;
  merged.reserve(cells);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == 0 || !places[i].same_cell(places[i - 1])) merged.emplace_back();
    merged.back().add(points_[places[i].index]);
  }
  points_.assign(merged.begin(), merged.end());
  return true;
}

std::optional<PointCloud::Distances> PointCloud::distances(const Vec2& centre) const {
  if (points_.empty() || has_nan_ || !centre.allFinite()) return std::nullopt;
  RunningMoments all;
  double largest = 0.0;
  for (const PointMoments& p : points_) {
    const Vec2 arm = p.mean - centre;
    const double squared = arm.squaredNorm();
    const Vec2 along = squared > 0.0 ? Vec2(arm / std::sqrt(squared)) : Vec2::UnitX();
    const double radial = along.dot(p.scatter * along);
    const double across = p.scatter.trace() - radial;
    // Mean to second order in the cell; with the radial part the mean square is exact.
    all.add(p.count, std::sqrt(squared + across / p.count), radial);
    if (p.count == 1.0) largest = std::max(largest, std::sqrt(squared));
  }
  for (const Vec2& p : extremes_) largest = std::max(largest, (p - centre).norm());
  return Distances{*all.mean(), largest, all.variance()};
}

// ---- the filter ----

void Biquad::settle(double x) {
  s2 = (b2 - a2) * x;
  s1 = (b1 - a1) * x + s2;
}

double Biquad::step(double x) {
  const double y = b0 * x + s1;
  s1 = b1 * x - a1 * y + s2;
  s2 = b2 * x - a2 * y;
  return y;
}

Biquad butterworth(double rate, double cutoff) {
  const double k = std::tan(kPi * cutoff / rate);
  const double damping = std::sqrt(2.0) * k;
  const double norm = 1.0 + damping + k * k;
  const double b = k * k / norm;
  return {b, 2.0 * b, b, 2.0 * (k * k - 1.0) / norm, (1.0 - damping + k * k) / norm};
}

ZeroPhaseLowpass::ZeroPhaseLowpass(double rate, double cutoff) : defined_(cutoff < rate / 2.0) {
  if (!defined_) return;
  filter_ = butterworth(rate, cutoff);
  const double pole = std::sqrt(filter_.a2);  // size of both
  const double decay = std::log(std::numeric_limits<double>::epsilon()) / std::log(pole);
  lookahead_ = 1 + static_cast<std::size_t>(std::ceil(decay));
}

std::span<const double> ZeroPhaseLowpass::add(double x) {
  final_.clear();
  if (!defined_) return final_;
  last_.push_back(x);
  if (last_.size() <= kPad) return final_;
  if (last_.size() == kPad + 1 && forward_.empty()) {
    filter_.settle(2.0 * last_[0] - last_[kPad]);
    for (std::size_t i = kPad; i > 0; --i) filter_.step(2.0 * last_[0] - last_[i]);
    for (const double sample : last_) forward_.push_back(filter_.step(sample));
    return final_;
  }
  last_.erase(last_.begin());
  forward_.push_back(filter_.step(x));
  if (forward_.size() < kBlock + lookahead_) return final_;
  final_ = forward_;
  filter_backwards(final_);
  final_.resize(kBlock);
  forward_.erase(forward_.begin(), forward_.begin() + kBlock);
  return final_;
}

std::vector<double> ZeroPhaseLowpass::finish() const {
  if (last_.size() <= kPad) return {};
  std::vector<double> rest = forward_;
  Biquad filter = filter_;
  for (std::size_t i = 1; i <= kPad; ++i) {
    rest.push_back(filter.step(2.0 * last_[kPad] - last_[kPad - i]));
  }
  filter_backwards(rest);
  rest.resize(forward_.size());
  return rest;
}

void ZeroPhaseLowpass::filter_backwards(std::vector<double>& x) const {
  Biquad filter = filter_;
  filter.settle(x.back());
  for (std::size_t i = x.size(); i-- > 0;) x[i] = filter.step(x[i]);
}

void FilteredVariance::add(double x) {
  for (const double y : filter_.add(x)) moments_.add(y);
}

RunningMoments FilteredVariance::moments() const {
  RunningMoments all = moments_;
  for (const double y : filter_.finish()) all.add(y);
  return all;
}

void FilteredSlopeVariance::add(double x) {
  if (count_ == 1) slope_.add((x - last_) * rate_);
  if (count_ > 1) slope_.add((x - before_last_) * rate_ / 2.0);
  before_last_ = last_;
  last_ = x;
  ++count_;
}

RunningMoments FilteredSlopeVariance::moments() const {
  FilteredVariance slope = slope_;
  if (count_ > 1) slope.add((last_ - before_last_) * rate_);
  return slope.moments();
}

}  // namespace pirouette
