// Declaration of a parameter: one line with name, unit, range and meaning. Loader, range check,
// dump and the documentation table all use these lines (config/toml.cpp, config/config_doc.cpp).
//
// A struct of parameters has a static `fields(self, visit)` that calls, one line a parameter,
//   visit(self.member, "key", "unit", Range{min, max}, "meaning")
// for a number or a fixed-size list of numbers, and
//   visit(self.member, "key", "meaning")
// for a bool, an enum, a string or a nested group.
// `self` is a const or mutable reference, so the same list serves reading and writing.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace pirouette {

/// Closed interval of allowed values.
struct Range {
  double min;  ///< smallest allowed value
  double max;  ///< largest allowed value
};

/// Names of an enum's values in files, in declaration order, as kNames; specialised beside each
/// enum.
template <class Enum>
struct EnumNames;

/// Name of `value` in files.
template <class Enum>
std::string_view enum_name(Enum value) {
  return EnumNames<Enum>::kNames.at(static_cast<std::size_t>(value));
}

}  // namespace pirouette
