// From TOML files and command-line overrides to a Config; the way back is config_doc.hpp. The only
// place that reads TOML.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"

namespace pirouette {

/// What the user chose. Layers from the lowest to the highest, each overriding those before it:
/// the defaults in config.hpp; config/robots/<robot>.toml, where it exists;
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

/// The checked configuration, or everything that is wrong with it at once.
Result<Config> load_config(const ConfigSources& sources = {});

}  // namespace pirouette
