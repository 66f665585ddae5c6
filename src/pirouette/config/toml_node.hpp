// TOML files and the words of their values, for this folder's loaders only.
#pragma once

#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

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
