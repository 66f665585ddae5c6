// Description of every parameter, for the dump, the documentation and the error texts.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pirouette/base/fields.hpp"

namespace pirouette {

struct Config;

/// Description of one parameter.
struct ParameterInfo {
  std::string key;      ///< dotted, such as gait.period
  std::string name;     ///< last part of the key
  std::string value;    ///< as a TOML literal
  std::string unit;     ///< empty where there is none; "1" for a pure number
  std::string law;      ///< how the default follows the robot, "u l^1.5"; empty: it does not
  std::string allowed;  ///< "0.15 to 2", "centre, rolling", "true, false"; empty for free text
  std::string meaning;  ///< a sentence
  std::optional<Range> range;  ///< of a number, or of each of a list of numbers
};

/// One TOML table. The first group of a Config has an empty key and holds robot and controller.
struct ParameterGroup {
  std::string key;                        ///< dotted; empty for the first group
  std::string meaning;                    ///< a sentence
  std::vector<ParameterInfo> parameters;  ///< in the order of the fields
};

/// All parameters with the values of `config`, in the order of config.hpp, parents before children.
std::vector<ParameterGroup> describe(const Config& config);

/// The complete TOML text with unit, range and meaning beside each value; loading it gives the same
/// Config.
std::string dump_toml(const Config& config);

/// `text` as a TOML string in quotes.
std::string toml_literal(const std::string& text);

/// Shortest TOML float that reads back as the same double: 0.1, 5.0, 2e-4.
std::string toml_literal(double value);

/// Range of the parameter `key`; absent if there is none of this name or it is no number.
std::optional<Range> parameter_range(std::string_view key);

/// Dotted keys of all parameters.
std::vector<std::string> list_keys();

/// The reference table of docs/parameters.md, with the defaults.
std::string config_markdown();

}  // namespace pirouette
