// Parameters of one robot as those of a larger or heavier one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pirouette/base/fields.hpp"
#include "pirouette/base/unit_law.hpp"

namespace pirouette {

/// The units of a list of parameters: "m, m" -> m and m.
inline std::vector<std::string_view> units_of(std::string_view text) {
  std::vector<std::string_view> units;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(", ", begin), text.size());
    units.push_back(text.substr(begin, end - begin));
    begin = end + 2;
  }
  return units;
}

/// `value`, of the law `law`, where lengths are `length` times and masses `mass` times as large and
/// times go with the root of length: to four digits, and `value` itself where nothing changes.
inline double scaled(double value, const UnitLaw& law, double length, double mass) {
  const double factor = std::pow(length, law.length + 0.5 * law.time) * std::pow(mass, law.mass);
  if (factor == 1.0 || value == 0.0) return value;
  const double exact = value * factor;
  const double digit = std::pow(10.0, 3.0 - std::floor(std::log10(std::abs(exact))));
  return std::round(exact * digit) / digit;
}

/// Visitor of a parameter group's `fields` (base/fields.hpp) that scales each number by the law
/// that `law_of(key, unit)` returns; absent: it stays. Results are kept within their range.
template <class LawOf>
class FitToScale {
 public:
  /// Keys begin with `prefix`; lengths are `length` times and masses `mass` times as large.
  FitToScale(std::string prefix, double length, double mass, const LawOf& law_of)
      : prefix_(std::move(prefix)), length_(length), mass_(mass), law_of_(law_of) {}

  /// Scales a number, or each of a list.
  template <class T>
  void operator()(T& value, const std::string& name, const char* unit, Range range,
                  const char* /*meaning*/) const {
    if constexpr (std::is_same_v<T, double>) {
      value = fit(value, name, unit, range);
    } else if constexpr (!std::is_arithmetic_v<T>) {
      const std::vector<std::string_view> units = units_of(unit);
      for (std::size_t i = 0; i < value.size(); ++i)
        value[i] = fit(value[i], name, units[std::min(i, units.size() - 1)], range);
    }
  }

  /// Enters a group of parameters; leaves any other value.
  template <class T>
  void operator()(T& value, const std::string& name, const char* /*meaning*/) const {
    if constexpr (std::is_class_v<T> && !std::is_same_v<T, std::string>)
      T::fields(value, FitToScale(prefix_ + name + ".", length_, mass_, law_of_));
  }

 private:
  double fit(double value, const std::string& name, std::string_view unit, Range range) const {
    const std::optional<UnitLaw> law = law_of_(prefix_ + name, unit);
    return law ? std::clamp(scaled(value, *law, length_, mass_), range.min, range.max) : value;
  }

  std::string prefix_;
  double length_, mass_;
  const LawOf& law_of_;
};

}  // namespace pirouette
