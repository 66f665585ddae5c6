// How large and heavy a robot is, as multiples of the robot for which the defaults are written.
#pragma once

#include <cmath>

namespace pirouette {

/// Size and weight of a robot over those of the shipped Mini Cheetah. Under the same gravity two
/// robots that differ in these alone move alike when times go with sqrt(length) (Froude).
struct RobotScale {
  double length = 1.0;  ///< of the legs, hip to foot
  double mass = 1.0;    ///< of the whole robot

  static constexpr double kLegLength = 0.415;  ///< m, thigh and calf of the Mini Cheetah
  static constexpr double kMass = 8.912;       ///< kg, of the Mini Cheetah

  /// Of a robot with legs of `leg_length` (m) and `total_mass` (kg), to six decimals, so that the
  /// Mini Cheetah's are exactly 1.
  static RobotScale of(double leg_length, double total_mass) {
    constexpr double kDecimals = 1e6;
    return {std::round(leg_length / kLegLength * kDecimals) / kDecimals,
            std::round(total_mass / kMass * kDecimals) / kDecimals};
  }

  double time() const { return std::sqrt(length); }  ///< of motions
  double area() const { return length * length; }    ///< of squares of lengths
  double volume() const { return length * area(); }  ///< of determinants of leg Jacobians
};

}  // namespace pirouette
