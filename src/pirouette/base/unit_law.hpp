// Dimensions of a unit: how a quantity changes with the size and mass of a robot.
#pragma once

#include <string>
#include <string_view>

namespace pirouette {

/// A quantity is proportional to length^length mass^mass time^time.
struct UnitLaw {
  double length = 0.0;  ///< exponent of the length
  double mass = 0.0;    ///< exponent of the mass
  double time = 0.0;    ///< exponent of the time

  bool operator==(const UnitLaw&) const = default;  ///< same exponents
};

/// Exponents of a unit as the parameters have them: products and powers of m, s, kg, N, rad, Hz
/// with at most one slash, such as "N m s/rad", "(m/s)^2/s" or "1/N^2". 1, rad and steps have none.
/// Throws std::invalid_argument for any other text: a mistake in a parameter's declaration.
UnitLaw unit_law(std::string_view unit);

/// The law of a robot of l times the leg length and u times the mass of the Mini Cheetah under the
/// same gravity, times going with the square root of l: "l", "u l^1.5"; empty: none.
std::string law_text(const UnitLaw& law);

}  // namespace pirouette
