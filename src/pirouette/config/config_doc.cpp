#include "pirouette/config/config_doc.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <utility>

#include "pirouette/base/fit_to_scale.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/config/robot_defaults.hpp"

namespace pirouette {
namespace {

/// Shortest decimal that reads back as the same double, without padding in the exponent: 5, 2e-4.
std::string shortest(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), end);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const bool negative = text[exponent + 1] == '-';
  const std::size_t digits = text.find_first_not_of("+-0", exponent + 1);
  return text.substr(0, exponent) + (negative ? "e-" : "e") + text.substr(digits);
}

std::string literal(double value) { return toml_literal(value); }
std::string literal(std::int64_t value) { return std::to_string(value); }
std::string literal(int value) { return std::to_string(value); }
std::string literal(bool value) { return value ? "true" : "false"; }

std::string literal(std::string_view value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      text += '\\';
      text += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      constexpr std::string_view kHex = "0123456789ABCDEF";
      text += "\\u00";
      text += kHex[static_cast<unsigned char>(c) / 16];
      text += kHex[static_cast<unsigned char>(c) % 16];
    } else {
      text += c;
    }
  }
  return text + '"';
}
std::string literal(const std::string& value) { return literal(std::string_view(value)); }

template <std::size_t N>
std::string literal(const std::array<double, N>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "[" : ", ") + toml_literal(value);
  return text + "]";
}

std::string allowed(double, Range range) {
  return shortest(range.min) + " to " + shortest(range.max);
}
std::string allowed(std::int64_t, Range range) { return "whole number, " + allowed(0.0, range); }
std::string allowed(int, Range range) { return allowed(std::int64_t{0}, range); }

template <std::size_t N>
std::string allowed(const std::array<double, N>&, Range range) {
  return std::to_string(N) + " numbers, each " + allowed(0.0, range);
}

template <class Enum>
std::string enum_names() {
  std::string text;
  for (const std::string_view name : EnumNames<Enum>::kNames) {
    if (!text.empty()) text += ", ";
    text += name;
  }
  return text;
}

/// Laws of a parameter, one for each of a list's units that differ.
std::string law_of(std::string_view key, std::string_view unit) {
  if (key == "body.height") return "by the legs";
  std::string text;
  bool differ = false, any = false;
  for (const std::string_view one : units_of(unit)) {
    const std::optional<UnitLaw> law = parameter_law(key, one);
    const std::string words = law ? law_text(*law) : "";
    any = any || !words.empty();
    if (text.empty()) {
      text = words.empty() ? "1" : words;
    } else if (text != words) {
      differ = true;
      text += ", " + (words.empty() ? std::string("1") : words);
    }
  }
  return any || differ ? text : "";
}

/// Visits one group: its own parameters go into its entry of `groups`, its subgroups behind it,
/// because in TOML a table's values come before its subtables.
class Describer {
 public:
  Describer(std::vector<ParameterGroup>& groups, std::string key, std::string meaning)
      : groups_(groups), own_(groups.size()), prefix_(key.empty() ? "" : key + ".") {
    groups_.push_back({std::move(key), std::move(meaning), {}});
  }

  template <class T>
  void operator()(const T& value, const std::string& name, std::string unit, Range range,
                  std::string meaning) const {
    add({prefix_ + name, name, literal(value), std::move(unit), "", allowed(value, range),
         std::move(meaning), range});
  }

  template <class T>
  void operator()(const T& value, const std::string& name, std::string meaning) const {
    if constexpr (std::is_enum_v<T>) {
      add({prefix_ + name, name, literal(enum_name(value)), "", "", enum_names<T>(), meaning, {}});
    } else if constexpr (std::is_same_v<T, bool>) {
      add({prefix_ + name, name, literal(value), "", "", "true, false", meaning, {}});
    } else if constexpr (std::is_same_v<T, std::string>) {
      add({prefix_ + name, name, literal(value), "", "", "", meaning, {}});
    } else {
      T::fields(value, Describer(groups_, prefix_ + name, std::move(meaning)));
    }
  }

 private:
  void add(ParameterInfo parameter) const {
    if (!parameter.unit.empty()) parameter.law = law_of(parameter.key, parameter.unit);
    groups_[own_].parameters.push_back(std::move(parameter));
  }

  std::vector<ParameterGroup>& groups_;
  std::size_t own_;
  std::string prefix_;
};

/// `text` with what Markdown would take for a column border escaped.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
    text.insert(at, "\\");
  }
  return text;
}

}  // namespace

std::vector<ParameterGroup> describe(const Config& config) {
  std::vector<ParameterGroup> groups;
  Config::fields(config, Describer(groups, "", "What to run."));
  return groups;
}

std::string toml_literal(const std::string& text) { return literal(text); }

std::string toml_literal(double value) {
  const std::string text = shortest(value);
  const bool whole = text.find_first_not_of("-0123456789") == std::string::npos;
  return whole ? text + ".0" : text;
}

std::vector<std::string> list_keys() {
  std::vector<std::string> keys;
  for (const ParameterGroup& group : describe(Config{})) {
    for (const ParameterInfo& parameter : group.parameters) keys.push_back(parameter.key);
  }
  return keys;
}

std::optional<Range> parameter_range(std::string_view key) {
  for (const ParameterGroup& group : describe(Config{})) {
    for (const ParameterInfo& parameter : group.parameters) {
      if (parameter.key == key) return parameter.range;
    }
  }
  return std::nullopt;
}

std::string dump_toml(const Config& config) {
  constexpr std::size_t kCommentColumn = 40;
  std::string text = "# name = value  # [unit] (allowed) meaning\n\n";
  for (const ParameterGroup& group : describe(config)) {
    if (!group.key.empty()) text += "\n[" + group.key + "]  # " + group.meaning + "\n";
    for (const ParameterInfo& parameter : group.parameters) {
      std::string line = parameter.name + " = " + parameter.value;
      if (line.size() < kCommentColumn) line.resize(kCommentColumn, ' ');
      line += "  # ";
      if (!parameter.unit.empty()) line += "[" + parameter.unit + "] ";
      if (!parameter.allowed.empty()) line += "(" + parameter.allowed + ") ";
      text += line + parameter.meaning + "\n";
    }
  }
  return text;
}

std::string config_markdown() {
  std::string text =
      "# Parameters\n\nDefaults are those of the Mini Cheetah. The column law says how they follow "
      "another robot: u is its mass over the Mini Cheetah's 8.912 kg, l the length of its legs, "
      "hip "
      "to foot, over 0.415 m; times go with l^0.5, so that robots of all sizes move alike. Where "
      "the law is empty the default is the same for all. body.height leaves the legs as bent as "
      "the "
      "Mini Cheetah's. What a file or --set says holds as it stands; run.toml has what came of "
      "it.\n";
  for (const ParameterGroup& group : describe(Config{})) {
    text += group.key.empty() ? "" : "\n## " + group.key + "\n";
    text += "\n" + group.meaning +
            "\n\n| key | default | unit | law | allowed | meaning |\n|---|---|---|---|---|---|\n";
    for (const ParameterInfo& p : group.parameters) {
      text += "| `" + p.key + "` | `" + cell(p.value) + "` | " + cell(p.unit) + " | " +
              cell(p.law) + " | " + cell(p.allowed) + " | " + cell(p.meaning) + " |\n";
    }
  }
  return text;
}

}  // namespace pirouette
