// Checks that ranges of single parameters cannot express.
#pragma once

#include "pirouette/base/result.hpp"

namespace pirouette {

struct Config;

/// Errors in relations between parameters and in the files of robot and path; empty: none. Part of
/// load_config; call it after changing a Config in code.
Errors validate(const Config& config);

}  // namespace pirouette
