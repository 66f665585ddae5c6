#include "pirouette/config/toml.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <type_traits>
#include <utility>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/robot_defaults.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/config/toml_node.hpp"
#include "pirouette/config/validate.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

/// Where a value was given.
struct Origin {
  std::string file;  ///< or "--set", "--robot", "--controller", "--profile"
  int line = 0;
};

/// Parsed TOML and the place to name in its errors.
struct Layer {
  std::string file;
  bool has_lines = true;
  toml::table table;

  Origin origin(const toml::node& node) const {
    return {file, has_lines ? static_cast<int>(node.source().begin.line) : 0};
  }
};

Error make_error(const Origin& origin, std::string key, std::string message) {
  return {origin.file, origin.line, std::move(key), std::move(message)};
}

/// Key -> what is allowed there, with the unit, for error texts.
std::map<std::string, std::string> allowed_texts() {
  std::map<std::string, std::string> texts;
  for (const ParameterGroup& group : describe(Config{})) {
    texts[group.key] = "a table of parameters";
    for (const ParameterInfo& p : group.parameters) {
      std::string text = p.allowed.empty() ? "a text in quotes" : p.allowed;
      const bool one_unit = p.unit.find(',') == std::string::npos;
      if (!p.unit.empty() && p.unit != "1") text += one_unit ? " " + p.unit : " (" + p.unit + ")";
      texts[p.key] = text;
    }
  }
  return texts;
}

bool within(double value, Range range) {
  return std::isfinite(value) && range.min <= value && value <= range.max;
}

/// TOML integers are accepted for numbers, booleans never.
bool parse(const toml::node& node, Range range, double& out) {
  if (!node.is_floating_point() && !node.is_integer()) return false;
  const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get())
                                         : node.as_floating_point()->get();
  if (!within(value, range)) return false;
  out = value;
  return true;
}

bool parse(const toml::node& node, Range range, std::int64_t& out) {
  if (!node.is_integer()) return false;
  const std::int64_t value = node.as_integer()->get();
  if (!within(static_cast<double>(value), range)) return false;
  out = value;
  return true;
}

bool parse(const toml::node& node, Range range, int& out) {
  std::int64_t value = 0;
  if (!parse(node, range, value)) return false;
  out = static_cast<int>(value);
  return true;
}

template <std::size_t N>
bool parse(const toml::node& node, Range range, std::array<double, N>& out) {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != N) return false;
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!parse((*list)[i], range, values[i])) return false;
  }
  out = values;
  return true;
}

bool parse(const toml::node& node, bool& out) {
  if (!node.is_boolean()) return false;
  out = node.as_boolean()->get();
  return true;
}

bool parse(const toml::node& node, std::string& out) {
  if (!node.is_string()) return false;
  out = node.as_string()->get();
  return true;
}

template <class Enum>
  requires std::is_enum_v<Enum>
bool parse(const toml::node& node, Enum& out) {
  if (!node.is_string()) return false;
  const auto& names = EnumNames<Enum>::kNames;
  const auto found = std::find(names.begin(), names.end(), node.as_string()->get());
  if (found == names.end()) return false;
  out = static_cast<Enum>(found - names.begin());
  return true;
}

/// A parameter that counted control ticks, and the time that stands for it.
struct Renamed {
  std::string_view from, to;
};
constexpr std::array kRenamed = {
    Renamed{"mpc.ticks_per_solve", "mpc.solve_period"},
    Renamed{"estimation.contact_debounce", "estimation.contact_debounce_time"},
    Renamed{"estimation.gyro_rest_samples", "estimation.gyro_rest_time"},
    Renamed{"safety.max_bad_readings", "safety.max_bad_reading_time"},
    Renamed{"safety.max_repeated_samples", "safety.max_repeat_time"},
};

/// Reads a layer over a Config. A wrong value leaves the lower layer's in place and is recorded.
class LayerReader {
 public:
  LayerReader(const Layer& layer, std::map<std::string, Origin>& origins, Errors& errors)
      : layer_(layer), origins_(origins), errors_(errors) {}

  template <class Group>
  void read(const toml::table& table, const std::string& prefix, Group& group) {
    std::vector<std::string> names;
    Group::fields(group, [&](auto& member, const char* name, auto... rest) {
      names.emplace_back(name);
      if (const toml::node* node = table.get(name)) assign(*node, prefix + name, member, rest...);
    });
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        report_unknown(node, prefix + name, names);
      }
    }
  }

 private:
  template <class T>
  void assign(const toml::node& node, const std::string& key, T& member, const char* /*unit*/,
              Range range, const char* /*meaning*/) {
    record(node, key, parse(node, range, member));
  }

  template <class T>
  void assign(const toml::node& node, const std::string& key, T& member, const char* /*meaning*/) {
    if constexpr (requires { parse(node, member); }) {
      record(node, key, parse(node, member));
    } else if (const toml::table* table = node.as_table()) {
      read(*table, key + ".", member);
    } else {
      record(node, key, false);
    }
  }

  void record(const toml::node& node, const std::string& key, bool good) {
    if (good) {
      origins_[key] = layer_.origin(node);
      return;
    }
    static const std::map<std::string, std::string> kAllowed = allowed_texts();
    report(node, key, "given " + shown(node) + "; allowed: " + kAllowed.at(key));
  }

  void report_unknown(const toml::node& node, const std::string& key,
                      const std::vector<std::string>& names) {
    const auto renamed = std::find_if(kRenamed.begin(), kRenamed.end(),
                                      [&](const Renamed& r) { return r.from == key; });
    if (renamed != kRenamed.end()) {
      report(node, key, "unknown key; it is " + std::string(renamed->to) + " now, in s");
      return;
    }
    std::vector<std::string> candidates = list_keys();
    for (const ParameterGroup& group : describe(Config{})) {
      if (!group.key.empty()) candidates.push_back(group.key);
    }
    const std::optional<std::string> meant = nearest(key, candidates);
    report(node, key,
           "unknown key; " +
               (meant ? "did you mean " + *meant + "?" : "allowed here: " + joined(names)));
  }

  void report(const toml::node& node, const std::string& key, std::string message) {
    errors_.push_back(make_error(layer_.origin(node), key, std::move(message)));
  }

  const Layer& layer_;
  std::map<std::string, Origin>& origins_;
  Errors& errors_;
};

std::optional<Layer> parse_file(const fs::path& path, Errors& errors) {
  std::optional<toml::table> table = parse_toml_file(path, errors);
  if (!table) return std::nullopt;
  const char* other = nullptr;
  if (table->contains("rows")) other = "an experiment: pirouette sweep or montecarlo runs it";
  if (table->contains("points")) other = "a path: pirouette turn --path follows it";
  if (other != nullptr) {
    errors.push_back({path.string(), 0, "", std::string("is no configuration but ") + other});
    return std::nullopt;
  }
  return Layer{path.string(), true, *std::move(table)};
}

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(kBlank) - first + 1));
}

std::optional<Layer> parse_override(const std::string& text, Errors& errors) {
  constexpr std::string_view kKeyCharacters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  const std::size_t equals = text.find('=');
  const std::string key = trimmed(text.substr(0, equals));
  const std::string value = equals == std::string::npos ? "" : trimmed(text.substr(equals + 1));
  if (!key.empty() && !value.empty() && value.find('\n') == std::string::npos &&
      key.find_first_not_of(kKeyCharacters) == std::string::npos) {
    toml::parse_result result = toml::parse(key + " = " + value);
    // What is no TOML is a bare word, unless it begins like a quoted text, a list or a table.
    if (!result && value.find_first_of("\"'[{") == std::string::npos) {
      result = toml::parse(key + " = '" + value + "'");
    }
    if (result) return Layer{"--set", false, std::move(result).table()};
  }
  errors.push_back({"--set", 0, "",
                    "given " + in_quotes(text) + "; allowed: key=value, such as gait.period=0.3"});
  return std::nullopt;
}

/// The name of a robot, a controller or a profile, and where it was given.
struct Choice {
  std::string name;
  Origin origin;
};

/// The flag, else the highest layer that names `key`, else `fallback`.
Choice choose(const std::string& key, const std::optional<std::string>& flag,
              const std::vector<Layer>& layers, const std::string& fallback) {
  if (flag) return {*flag, {"--" + key, 0}};
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    const toml::node* node = layer->table.get(key);
    if (node != nullptr && node->is_string()) {
      return {node->as_string()->get(), layer->origin(*node)};
    }
  }
  return {fallback, {}};
}

bool is_known(const std::string& name, const std::vector<std::string>& sorted_names) {
  return std::binary_search(sorted_names.begin(), sorted_names.end(), name);
}

/// The project's own layers below the user's: the robot's overlay, the controller's bundle and the
/// plant's profile.
std::vector<Layer> parse_own_layers(const Choice& robot, const Choice& controller,
                                    const Choice& profile, Errors& errors) {
  std::vector<Layer> layers;
  const auto add = [&](const fs::path& path) {
    std::optional<Layer> layer = parse_file(path, errors);
    if (!layer) return;
    for (const char* key : {"robot", "controller", "profile"}) {
      if (const toml::node* node = layer->table.get(key)) {
        errors.push_back(
            make_error(layer->origin(*node), key,
                       "not allowed here: this file is chosen by robot, controller and profile"));
        layer->table.erase(key);
      }
    }
    layers.push_back(*std::move(layer));
  };
  const auto add_chosen = [&](const char* key, const Choice& choice, const char* folder,
                              const std::vector<std::string>& known) {
    if (is_known(choice.name, known)) {
      add(data_dir() / "config" / folder / (choice.name + ".toml"));
    } else {
      errors.push_back(make_error(choice.origin, key, unknown_name(choice.name, known)));
    }
  };

  const fs::path overlay = data_dir() / "config" / "robots" / (robot.name + ".toml");
  if (is_known(robot.name, known_robots()) && fs::exists(overlay)) add(overlay);
  add_chosen("controller", controller, "controllers", known_controllers());
  add_chosen("profile", profile, "plants", known_profiles());
  return layers;
}

}  // namespace

Result<Config> load_config(const ConfigSources& sources) {
  if (!fs::is_directory(data_dir() / "config")) {
    return Error{data_dir().string(), 0, "",
                 "no folder config/ here; set PIROUETTE_DATA_DIR to where config/ and robots/ are"};
  }
  Errors errors;
  std::vector<Layer> user_layers;
  const auto add = [&](std::optional<Layer> layer) {
    if (layer) user_layers.push_back(*std::move(layer));
  };
  if (sources.file) add(parse_file(*sources.file, errors));
  for (const std::string& text : sources.overrides) add(parse_override(text, errors));

  Config config;
  const Choice robot = choose("robot", sources.robot, user_layers, config.robot);
  const Choice controller =
      choose("controller", sources.controller, user_layers, config.controller);
  const Choice profile = choose("profile", sources.profile, user_layers, config.profile);

  std::map<std::string, Origin> origins;
  const auto read = [&](const std::vector<Layer>& layers) {
    for (const Layer& layer : layers) {
      const auto first = static_cast<std::ptrdiff_t>(errors.size());
      LayerReader(layer, origins, errors).read(layer.table, "", config);
      std::stable_sort(errors.begin() + first, errors.end(),
                       [](const Error& a, const Error& b) { return a.line < b.line; });
    }
  };
  config.robot = robot.name;
  for (const Error& error : fit_to_robot(config))
    errors.push_back(error.key == "robot" ? make_error(robot.origin, error.key, error.message)
                                          : error);
  read(parse_own_layers(robot, controller, profile, errors));
  read(user_layers);
  config.robot = robot.name;
  config.controller = controller.name;
  config.profile = profile.name;
  origins["robot"] = robot.origin;
  config.plant.terrain = terrain_in_metres(config.plant.terrain, config.body.height);

  for (const Error& error : validate(config)) {
    const bool known = std::any_of(errors.begin(), errors.end(),
                                   [&](const Error& e) { return e.key == error.key; });
    if (!known) errors.push_back(make_error(origins[error.key], error.key, error.message));
  }
  if (!errors.empty()) return errors;
  return config;
}

}  // namespace pirouette
