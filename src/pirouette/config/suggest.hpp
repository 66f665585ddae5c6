// Words for error texts: which known name was probably meant, and which names there are.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pirouette {

/// The candidate that `given` probably meant, if one is near. The last part of a dotted key counts
/// by itself too, so that a key in the wrong table finds its home.
std::optional<std::string> nearest(std::string_view given,
                                   const std::vector<std::string>& candidates);

/// "a, b, c".
std::string joined(const std::vector<std::string>& names);

std::string in_quotes(std::string_view text);

/// The value of a TOML literal as a user names it.
std::string without_quotes(const std::string& literal);

/// What was given, which names are allowed and which was probably meant.
std::string unknown_name(std::string_view given, const std::vector<std::string>& known);

}  // namespace pirouette
