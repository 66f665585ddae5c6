// Parameters of the control clock and the posture.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Parameters `control.*`.
struct ControlConfig {
  double rate = 500.0;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.rate, "rate", "Hz", Range{100.0, 2000.0}, "Control ticks per second.");
  }
};

/// Parameters `body.*`.
struct BodyConfig {
  double height = 0.27;
  std::array<double, 2> stance_offset = {0.0, 0.0};

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.height, "height", "m", Range{0.05, 1.0},
      "Height of the CoM above the ground, along gravity.");
    v(s.stance_offset, "stance_offset", "m, m", Range{-0.2, 0.2},
      "Nominal foothold outwards of the point below the hip: forwards and sideways.");
  }
};

}  // namespace pirouette
