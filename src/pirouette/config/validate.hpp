// What ranges of single parameters cannot express.
#pragma once

#include "pirouette/base/result.hpp"

namespace pirouette {

struct Config;

/// Relations between parameters, and the files of robot and path. Part of load_config; call it
/// after changing a Config in code. Empty: all is well.
Errors validate(const Config& config);

}  // namespace pirouette
