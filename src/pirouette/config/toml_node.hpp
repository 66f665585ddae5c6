// TOML files and the words of their values, for this folder's loaders only.
#pragma once

#define TOML_EXCEPTIONS 0
// The parser tells of `[*` as of any other mistake, but first asserts that there is none, or with
// NDEBUG and Clang has the optimizer assume it.
#define TOML_ASSERT(expr) static_assert(true)
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#include <filesystem>
#include <optional>
#include <string>

#include "pirouette/base/result.hpp"

namespace pirouette {

/// The value as the user may have written it, on one line; it reads back as the same value.
std::string shown(const toml::node& node);

/// Absent, with what is wrong added to `errors`, when there is no such file or it is no TOML.
std::optional<toml::table> parse_toml_file(const std::filesystem::path& path, Errors& errors);

}  // namespace pirouette
