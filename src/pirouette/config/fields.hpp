// How a parameter declares itself: one line with name, unit, range and meaning. Loader, range
// check, dump and the documentation table all walk these lines (config/toml.cpp,
// config/config_doc.cpp).
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace pirouette {

/// Closed interval of allowed values.
struct Range {
  double min;
  double max;
};

/// Names of an enum's values in declaration order; specialised beside each enum in config.hpp.
template <class Enum>
struct EnumNames;

template <class Enum>
std::string_view enum_name(Enum value) {
  return EnumNames<Enum>::kNames.at(static_cast<std::size_t>(value));
}

}  // namespace pirouette
