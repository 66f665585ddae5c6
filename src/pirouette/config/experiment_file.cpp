#include "pirouette/config/experiment_file.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/config/toml.hpp"
#include "pirouette/config/toml_node.hpp"
#include "pirouette/config/validate.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr const char* kText = "a text in quotes";
constexpr int kMaxSeeds = 10000;

/// A parameter's value in the experiment file, and where it stands.
struct Setting {
  std::string key;
  std::string value;  ///< TOML
  int line = 0;
};

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

std::string without_quotes(const std::string& literal) {
  const bool quoted = literal.size() > 1 && literal.front() == '"';
  return quoted ? literal.substr(1, literal.size() - 2) : literal;
}

/// The settings of the rows and axes beside the public part of the experiment.
struct Settings {
  std::string robot;
  int robot_line = 0;
  std::vector<Setting> common;
  std::vector<std::vector<Setting>> rows;
  std::vector<int> row_lines;
  std::vector<std::vector<Setting>> axes;  ///< one for each value
  std::vector<Setting> trace;
};

class Reader {
 public:
  Reader(Experiment& experiment, Settings& settings, Errors& errors)
      : experiment_(experiment), settings_(settings), errors_(errors) {}

  void read(const toml::table& table) {
    allow_keys(table, "",
               {"title", "source", "robot", "seeds", "ladder", "common", "rows", "axes", "trace",
                "columns", "paper", "bounds"});
    experiment_.title = text(table, "", "title").value_or(experiment_.name);
    experiment_.source = text(table, "", "source").value_or("");
    settings_.robot = text(table, "", "robot").value_or("");
    if (const toml::node* robot = table.get("robot")) settings_.robot_line = line_of(*robot);
    settings_.common = settings(table, "", "common");
    settings_.trace = settings(table, "", "trace");
    read_seeds(table);
    for_each(table, "rows", [&](const toml::table& row) { read_row(row); });
    for_each(table, "axes", [&](const toml::table& axis) { read_axis(axis); });
    for_each(table, "columns", [&](const toml::table& column) { read_column(column); });
    for_each(table, "paper", [&](const toml::table& printed) { read_printed(printed); });
    for_each(table, "bounds", [&](const toml::table& bound) { read_bound(bound); });
    if (experiment_.rows.empty()) report(table, "rows", "none given; an experiment needs [[rows]]");
    read_ladder(table);
  }

 private:
  void report(const toml::node& node, const std::string& key, std::string message) {
    errors_.push_back({experiment_.file.string(), line_of(node), key, std::move(message)});
  }

  void allow_keys(const toml::table& table, const std::string& prefix,
                  const std::vector<std::string>& names) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      const std::optional<std::string> meant = nearest(name, names);
      report(node, prefix + name,
             "unknown key; " +
                 (meant ? "did you mean " + *meant + "?" : "allowed here: " + joined(names)));
    }
  }

  std::optional<std::string> text(const toml::table& table, const std::string& prefix,
                                  const char* name) {
    const toml::node* node = table.get(name);
    if (node == nullptr) return std::nullopt;
    if (node->is_string()) return node->as_string()->get();
    report(*node, prefix + name, "given " + shown(*node) + "; allowed: " + kText);
    return std::nullopt;
  }

  std::string needed_text(const toml::table& table, const std::string& prefix, const char* name) {
    if (table.get(name) == nullptr) report(table, prefix + name, std::string("missing: ") + kText);
    return text(table, prefix, name).value_or("");
  }

  std::optional<double> number(const toml::node& node, const std::string& key) {
    const std::optional<double> value = node.value<double>();
    if (!node.is_boolean() && value && std::isfinite(*value)) return value;
    report(node, key, "given " + shown(node) + "; allowed: a finite number");
    return std::nullopt;
  }

  /// Calls `visit` for each table of the array of tables `name`.
  template <class Visit>
  void for_each(const toml::table& table, const char* name, Visit&& visit) {
    const toml::node* node = table.get(name);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      report(*node, name, std::string("allowed: tables, each headed [[") + name + "]]");
      return;
    }
    for (const toml::node& element : *list) {
      if (const toml::table* entry = element.as_table()) {
        visit(*entry);
      } else {
        report(element, name, "given " + shown(element) + "; allowed: a table");
      }
    }
  }

  /// The parameters below the table `name` with dotted keys, in the order of the file.
  std::vector<Setting> settings(const toml::table& table, const std::string& prefix,
                                const char* name) {
    std::vector<Setting> out;
    const toml::node* node = table.get(name);
    if (node == nullptr) return out;
    if (const toml::table* values = node->as_table()) {
      flatten(*values, "", out);
    } else {
      report(*node, prefix + name, "given " + shown(*node) + "; allowed: a table of parameters");
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Setting& a, const Setting& b) { return a.line < b.line; });
    return out;
  }

  static void flatten(const toml::table& table, const std::string& prefix,
                      std::vector<Setting>& out) {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + std::string(key.str());
      if (const toml::table* below = node.as_table()) {
        flatten(*below, path + ".", out);
      } else {
        out.push_back({path, shown(node), line_of(node)});
      }
    }
  }

  void read_seeds(const toml::table& table) {
    experiment_.seeds = {1};
    const toml::node* node = table.get("seeds");
    if (node == nullptr) return;
    std::vector<std::int64_t> seeds;
    const toml::array* list = node->as_array();
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
      const auto* seed = (*list)[i].as_integer();
      if (seed != nullptr && seed->get() >= 0) seeds.push_back(seed->get());
    }
    const bool distinct = std::set<std::int64_t>(seeds.begin(), seeds.end()).size() == seeds.size();
    if (list == nullptr || seeds.empty() || seeds.size() != list->size() || !distinct) {
      report(*node, "seeds",
             "given " + shown(*node) + "; allowed: a list of different whole numbers from 0 on");
      return;
    }
    experiment_.seeds = seeds;
  }

  void read_row(const toml::table& table) {
    allow_keys(table, "rows.", {"label", "controller", "paper", "set"});
    ExperimentRow row;
    row.label = needed_text(table, "rows.", "label");
    row.controller = needed_text(table, "rows.", "controller");
    row.paper = text(table, "rows.", "paper").value_or("");
    const bool taken = std::any_of(experiment_.rows.begin(), experiment_.rows.end(),
                                   [&](const ExperimentRow& r) { return r.label == row.label; });
    if (taken) report(table, "rows.label", in_quotes(row.label) + " stands there twice");
    experiment_.rows.push_back(std::move(row));
    settings_.rows.push_back(settings(table, "rows.", "set"));
    settings_.row_lines.push_back(line_of(table));
  }

  void read_axis(const toml::table& table) {
    allow_keys(table, "axes.", {"key", "values"});
    ExperimentAxis axis;
    axis.key = needed_text(table, "axes.", "key");
    if (axis.key == "run.seed") report(table, "axes.key", "seeds are given by the list `seeds`");
    const toml::node* node = table.get("values");
    const toml::array* list = node != nullptr ? node->as_array() : nullptr;
    if (list == nullptr || list->empty()) {
      report(node != nullptr ? *node : table, "axes.values", "allowed: a list of values");
      return;
    }
    std::vector<Setting> settings;
    for (const toml::node& value : *list) {
      settings.push_back({axis.key, shown(value), line_of(value)});
      axis.values.push_back(without_quotes(settings.back().value));
    }
    experiment_.axes.push_back(std::move(axis));
    settings_.axes.push_back(std::move(settings));
  }

  void read_column(const toml::table& table) {
    allow_keys(table, "columns.", {"metric", "title"});
    experiment_.columns.push_back(
        {needed_text(table, "columns.", "metric"), needed_text(table, "columns.", "title")});
  }

  void read_printed(const toml::table& table) {
    allow_keys(table, "paper.", {"row", "profile", "metrics"});
    PrintedResult printed;
    printed.row = needed_text(table, "paper.", "row");
    printed.profile = needed_text(table, "paper.", "profile");
    const bool known = std::any_of(experiment_.rows.begin(), experiment_.rows.end(),
                                   [&](const ExperimentRow& r) { return r.paper == printed.row; });
    if (!known) report(table, "paper.row", "no row has paper = " + in_quotes(printed.row));
    const toml::node* metrics = table.get("metrics");
    if (metrics == nullptr || !metrics->is_table()) {
      report(table, "paper.metrics", "missing: a table of printed values");
      return;
    }
    read_numbers(*metrics->as_table(), "", printed.metrics);
    experiment_.printed.push_back(std::move(printed));
  }

  void read_numbers(const toml::table& table, const std::string& prefix,
                    std::map<std::string, double>& out) {
    for (const auto& [key, node] : table) {
      const std::string path = prefix + std::string(key.str());
      if (const toml::table* below = node.as_table()) {
        read_numbers(*below, path + ".", out);
      } else if (const std::optional<double> value = number(node, path)) {
        out[path] = *value;
      }
    }
  }

  void read_bound(const toml::table& table) {
    allow_keys(table, "bounds.", {"row", "metric", "min", "max"});
    ExperimentBound bound;
    bound.row = text(table, "bounds.", "row").value_or("");
    bound.metric = needed_text(table, "bounds.", "metric");
    if (!bound.row.empty()) check_label(table, "bounds.row", bound.row);
    if (const toml::node* min = table.get("min")) bound.min = number(*min, "bounds.min");
    if (const toml::node* max = table.get("max")) bound.max = number(*max, "bounds.max");
    if (!table.get("min") && !table.get("max")) report(table, "bounds", "needs min or max");
    experiment_.bounds.push_back(std::move(bound));
  }

  void read_ladder(const toml::table& table) {
    const toml::node* node = table.get("ladder");
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      report(*node, "ladder", "given " + shown(*node) + "; allowed: a list of labels of rows");
      return;
    }
    for (const toml::node& label : *list) {
      experiment_.ladder.push_back(without_quotes(shown(label)));
      check_label(label, "ladder", experiment_.ladder.back());
    }
  }

  void check_label(const toml::node& node, const std::string& key, const std::string& label) {
    std::vector<std::string> labels;
    for (const ExperimentRow& row : experiment_.rows) labels.push_back(in_quotes(row.label));
    if (std::find(labels.begin(), labels.end(), in_quotes(label)) != labels.end()) return;
    report(node, key, "given " + in_quotes(label) + "; allowed: " + joined(labels));
  }

  Experiment& experiment_;
  Settings& settings_;
  Errors& errors_;
};

/// Expands rows, axes and seeds, and loads the configuration of each.
class Expansion {
 public:
  Expansion(Experiment& experiment, const Settings& settings, const ExperimentChanges& changes,
            Errors& errors)
      : experiment_(experiment), settings_(settings), changes_(changes), errors_(errors) {}

  void run() {
    for (std::size_t row = 0; row < experiment_.rows.size(); ++row) {
      std::vector<std::size_t> levels(experiment_.axes.size(), 0);
      do {
        add_trials(row, levels);
      } while (next(levels));
    }
    check_trace_keys();
  }

 private:
  /// The next combination of axis values, the last axis varying fastest; false after the last one.
  bool next(std::vector<std::size_t>& levels) const {
    for (std::size_t axis = levels.size(); axis-- > 0;) {
      if (++levels[axis] < experiment_.axes[axis].values.size()) return true;
      levels[axis] = 0;
    }
    return false;
  }

  void add_trials(std::size_t row, const std::vector<std::size_t>& levels) {
    std::vector<Setting> settings = settings_.common;
    const auto& own = settings_.rows[row];
    settings.insert(settings.end(), own.begin(), own.end());
    for (std::size_t axis = 0; axis < levels.size(); ++axis) {
      settings.push_back(settings_.axes[axis][levels[axis]]);
    }
    const std::optional<Config> config = load(row, settings);
    if (!config) return;
    const bool traced = is_traced(settings);
    for (const std::int64_t seed : experiment_.seeds) {
      ExperimentTrial trial{row, levels, seed, traced && seed == experiment_.seeds.front(),
                            *config};
      trial.config.run.seed = seed;
      experiment_.trials.push_back(std::move(trial));
    }
  }

  std::optional<Config> load(std::size_t row, const std::vector<Setting>& settings) {
    ConfigSources sources;
    if (!settings_.robot.empty()) sources.robot = settings_.robot;
    sources.controller = experiment_.rows[row].controller;
    for (const Setting& s : settings) sources.overrides.push_back(s.key + "=" + s.value);
    if (changes_.turns) {
      sources.overrides.push_back("run.turns=" + toml_literal(*changes_.turns));
    }
    const Result<Config> config = load_config(sources);
    if (config) return config.value();
    for (const Error& error : config.errors()) report(placed(error, row, settings));
    return std::nullopt;
  }

  /// `error` with the line of the experiment file that it comes from.
  Error placed(Error error, std::size_t row, const std::vector<Setting>& settings) const {
    if (!error.file.empty() && !error.file.starts_with("--")) return error;
    if (changes_.turns && error.key == "run.turns") return {"--turns", 0, "", error.message};
    error.line = error.file == "--robot" || error.key == "robot" ? settings_.robot_line
                                                                 : settings_.row_lines[row];
    for (const Setting& s : settings) {
      if (s.key == error.key) error.line = s.line;
    }
    error.file = experiment_.file.string();
    return error;
  }

  void report(const Error& error) {
    const std::string text = error.to_string();
    const bool known = std::any_of(errors_.begin(), errors_.end(),
                                   [&](const Error& e) { return e.to_string() == text; });
    if (!known) errors_.push_back(error);
  }

  /// The table [trace] chooses by the same words that the settings have; later settings win.
  bool is_traced(const std::vector<Setting>& settings) const {
    return !settings_.trace.empty() &&
           std::all_of(settings_.trace.begin(), settings_.trace.end(), [&](const Setting& wanted) {
             const auto found = std::find_if(settings.rbegin(), settings.rend(),
                                             [&](const Setting& s) { return s.key == wanted.key; });
             return found != settings.rend() && found->value == wanted.value;
           });
  }

  void check_trace_keys() {
    if (!errors_.empty()) return;
    for (const Setting& wanted : settings_.trace) {
      const auto axis = std::find_if(experiment_.axes.begin(), experiment_.axes.end(),
                                     [&](const ExperimentAxis& a) { return a.key == wanted.key; });
      const bool known = axis != experiment_.axes.end() &&
                         std::find(axis->values.begin(), axis->values.end(),
                                   without_quotes(wanted.value)) != axis->values.end();
      if (known) continue;
      report({experiment_.file.string(), wanted.line, "trace." + wanted.key,
              "given " + wanted.value + "; allowed: a value of an axis"});
    }
  }

  Experiment& experiment_;
  const Settings& settings_;
  const ExperimentChanges& changes_;
  Errors& errors_;
};

}  // namespace

std::vector<std::string> known_experiments() { return toml_stems(data_dir() / "experiments"); }

fs::path experiment_path(const std::string& name) {
  return data_dir() / "experiments" / (name + ".toml");
}

Result<Experiment> load_experiment(const fs::path& file, const ExperimentChanges& changes) {
  Errors errors;
  const std::optional<toml::table> table = parse_toml_file(file, errors);
  if (!table) return errors;
  Experiment experiment;
  experiment.file = file;
  experiment.name = file.stem().string();
  Settings settings;
  Reader(experiment, settings, errors).read(*table);
  if (changes.seeds) {
    if (*changes.seeds < 1 || *changes.seeds > kMaxSeeds) {
      errors.push_back({"--seeds", 0, "",
                        "given " + std::to_string(*changes.seeds) + "; allowed: 1 to " +
                            std::to_string(kMaxSeeds)});
    } else {
      experiment.seeds.clear();
      for (std::int64_t seed = 1; seed <= *changes.seeds; ++seed) experiment.seeds.push_back(seed);
    }
  }
  Expansion(experiment, settings, changes, errors).run();
  if (!errors.empty()) {
    std::stable_sort(errors.begin(), errors.end(),
                     [](const Error& a, const Error& b) { return a.line < b.line; });
    return errors;
  }
  return experiment;
}

}  // namespace pirouette
