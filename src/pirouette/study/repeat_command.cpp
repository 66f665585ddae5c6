#include "pirouette/study/repeat_command.hpp"

#include <map>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/config/toml.hpp"

namespace pirouette {
namespace {

/// Options of `pirouette spin` that are shorter than --set.
const std::map<std::string, std::string> kOptions = {{"run.rate", "--rate"},
                                                     {"run.turns", "--turns"},
                                                     {"run.seed", "--seed"},
                                                     {"plant.terrain", "--terrain"}};

std::map<std::string, std::string> literals(const Config& config) {
  std::map<std::string, std::string> values;
  for (const ParameterGroup& group : describe(config)) {
    for (const ParameterInfo& parameter : group.parameters) {
      values[parameter.key] = parameter.value;
    }
  }
  return values;
}

}  // namespace

std::string shell_word(const std::string& text) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == text.npos) return text;
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') {
      word += "'\\''";
    } else {
      word += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? '?' : c;
    }
  }
  return word + "'";
}

std::string repeat_command(const Config& config) {
  const Config standard;
  std::string line = "pirouette spin";
  const auto add = [&](const std::string& option, const std::string& value) {
    line += " " + option + " " + shell_word(value);
  };
  if (config.robot != standard.robot) add("--robot", config.robot);
  if (config.controller != standard.controller) add("--controller", config.controller);
  if (config.profile != standard.profile) add("--profile", config.profile);
  const Result<Config> bundle = load_config(
      {.robot = config.robot, .controller = config.controller, .profile = config.profile});
  const auto usual = literals(bundle ? bundle.value() : standard);
  for (const auto& [key, value] : literals(config)) {
    if (value == usual.at(key)) continue;
    const auto option = kOptions.find(key);
    if (option != kOptions.end()) {
      add(option->second, without_quotes(value));
    } else {
      add("--set", key + "=" + value);
    }
  }
  return line;
}

}  // namespace pirouette
