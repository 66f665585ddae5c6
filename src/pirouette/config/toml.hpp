// Config from TOML files and command-line overrides; config_doc.hpp writes it. Only config/ and
// study/ read TOML.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"

namespace pirouette {

/// What the user gave. Layers from the lowest to the highest, each overriding those before it: the
/// defaults in config.hpp; config/robots/<robot>.toml, if it exists;
/// config/controllers/<controller>.toml; config/plants/<profile>.toml; `file`; `overrides` in their
/// order. `robot`, `controller` and `profile` themselves come from the highest of: the fields here,
/// `overrides`, `file`.
struct ConfigSources {
  std::optional<std::string> robot = {};           ///< --robot
  std::optional<std::string> controller = {};      ///< --controller
  std::optional<std::string> profile = {};         ///< --profile
  std::optional<std::filesystem::path> file = {};  ///< --config
  /// --set key=value, such as "gait.period=0.3". The value is TOML; what is not TOML is a string,
  /// so "foot.model=rolling" needs no quotes.
  std::vector<std::string> overrides = {};
};

/// The checked configuration, or all errors in its sources.
Result<Config> load_config(const ConfigSources& sources = {});

}  // namespace pirouette
