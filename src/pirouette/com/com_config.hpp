// Parameters of the CoM planner.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Values of com.planner.
enum class ComPlanner { kLinear, kPsp };
template <>
struct EnumNames<ComPlanner> {
  static constexpr std::array<std::string_view, 2> kNames = {"linear", "psp"};
};

/// Values of com.weight.
enum class PspWeight { kGaussian, kGeometric, kPoisson, kPolynomial };
template <>
struct EnumNames<PspWeight> {
  static constexpr std::array<std::string_view, 4> kNames = {"gaussian", "geometric", "poisson",
                                                             "polynomial"};
};

/// Parameters `com.*`.
struct ComConfig {
  ComPlanner planner = ComPlanner::kPsp;
  PspWeight weight = PspWeight::kGaussian;
  double width = 0.5;
  double swing_weight_min = 0.0;
  bool on_diagonal = false;
  double max_speed = 0.2;
  double gain = 0.3;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.planner, "planner",
      "linear: interpolation between current and commanded CoM; psp: projected support polygon, "
      "E16-E19.");
    v(s.weight, "weight", "Family of the PSP vertex weight over the phase.");
    v(s.width, "width", "1", Range{0.01, 5.0},
      "Gaussian: sigma as a share of the phase. Poisson: lambda = 4 (0.25 / width)^2. Geometric: "
      "rho = 0.05^(0.25 / width).");
    v(s.swing_weight_min, "swing_weight_min", "1", Range{0.0, 0.95},
      "Weight of a swing foot at mid-swing, w_m of E18.");
    v(s.on_diagonal, "on_diagonal", "Keep the target on the stance diagonal at all times, E20.");
    v(s.max_speed, "max_speed", "m/s", Range{0.001, 5.0}, "Speed limit of the target.");
    v(s.gain, "gain", "1", Range{0.0, 1.0},
      "Share of the PSP offset from the path reference that is followed.");
  }
};

}  // namespace pirouette
