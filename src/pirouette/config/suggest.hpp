// Names in error texts: the one that was probably meant and those that exist.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pirouette {

/// The candidate nearest to `given`; absent when none is near. The last part of a dotted key is
/// also compared by itself, so that a key in the wrong table is found.
std::optional<std::string> nearest(std::string_view given,
                                   const std::vector<std::string>& candidates);

/// "a, b, c".
std::string joined(const std::vector<std::string>& names);

/// `text` in quotes.
std::string in_quotes(std::string_view text);

/// A TOML literal without the quotes of a string.
std::string without_quotes(const std::string& literal);

/// Error text: `given`, the allowed names and the nearest one.
std::string unknown_name(std::string_view given, const std::vector<std::string>& known);

}  // namespace pirouette
