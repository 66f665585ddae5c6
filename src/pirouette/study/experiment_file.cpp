#include "pirouette/study/experiment_file.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/config/toml.hpp"
#include "pirouette/config/toml_node.hpp"
#include "pirouette/plant/terrain.hpp"
#include "pirouette/study/configured_trial.hpp"
#include "pirouette/study/experiment_reader.hpp"
#include "pirouette/study/plain_text.hpp"
#include "pirouette/study/table_reader.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSeeds = 10000;

/// Expands rows, axes and seeds, and loads the configuration of each.
class Expansion {
 public:
  Expansion(Experiment& experiment, const ExperimentSettings& settings,
            const ExperimentChanges& changes, Errors& errors)
      : experiment_(experiment), settings_(settings), changes_(changes), errors_(errors) {}

  void run() {
    if (experiment_.rows.empty() || too_many()) return;
    if (experiment_.random) {
      draw_trials(*experiment_.random);
      return;
    }
    for (std::size_t row = 0; row < experiment_.rows.size(); ++row) {
      std::vector<std::size_t> levels(experiment_.axes.size(), 0);
      do {
        add_trials(row, levels);
      } while (next(levels));
    }
    check_trace_keys();
  }

 private:
  bool too_many() {
    double trials = static_cast<double>(experiment_.rows.size() * experiment_.seeds.size());
    for (const ExperimentAxis& axis : experiment_.axes) {
      trials *= static_cast<double>(axis.values.size());
    }
    if (experiment_.random) trials = static_cast<double>(experiment_.random->trials);
    if (trials <= static_cast<double>(changes_.max_trials)) return false;
    char text[32];
    std::snprintf(text, sizeof text, "%.7g", trials);
    report({experiment_.file.string(), 0, "",
            "makes " + std::string(text) + " trials; allowed: at most " +
                std::to_string(changes_.max_trials)});
    return true;
  }

  /// The next combination of axis values, the last axis varying fastest; false after the last one.
  bool next(std::vector<std::size_t>& levels) const {
    for (std::size_t axis = levels.size(); axis-- > 0;) {
      if (++levels[axis] < experiment_.axes[axis].values.size()) return true;
      levels[axis] = 0;
    }
    return false;
  }

  void add_trials(std::size_t row, const std::vector<std::size_t>& levels) {
    std::vector<ExperimentSetting> settings = settings_.common;
    const auto& own = settings_.rows[row];
    settings.insert(settings.end(), own.begin(), own.end());
    for (std::size_t axis = 0; axis < levels.size(); ++axis) {
      settings.push_back(settings_.axes[axis][levels[axis]]);
    }
    const std::optional<Config> config = load(row, settings);
    if (!config) return;
    const bool traced = is_traced(settings);
    for (const std::int64_t seed : experiment_.seeds) {
      Config of_seed = *config;
      of_seed.run.seed = seed;
      experiment_.trials.push_back({row, levels, seed, traced && seed == experiment_.seeds.front(),
                                    std::make_shared<const Config>(std::move(of_seed))});
    }
  }

  /// Ranges that hold more than is allowed, whether or not a trial draws it.
  void check_ends(const std::vector<ExperimentDraw>& draws) {
    for (const ExperimentDraw& draw : draws) {
      if (!draw.values.empty()) continue;
      Error error{experiment_.file.string(), draw.line, draw.key, ""};
      const std::optional<Range> range = parameter_range(draw.key);
      const double lowest = draw.either_sign ? -draw.max : draw.min;
      if (range && draw.text.empty() && (lowest < range->min || draw.max > range->max)) {
        error.message = "given [" + toml_literal(lowest) + ", " + toml_literal(draw.max) +
                        "]; allowed: " + toml_literal(range->min) + " to " +
                        toml_literal(range->max);
        report(error);
      }
      if (draw.key != "plant.terrain") continue;
      for (const double end : {draw.min, draw.max}) {
        ExperimentDraw only = draw;
        only.min = only.max = end;
        const Result<TerrainSpec> terrain = parse_terrain(without_quotes(drawn_value(only, 0, 0)));
        if (terrain) continue;
        error.message = terrain.errors().front().message;
        report(error);
      }
    }
  }

  void draw_trials(const RandomPart& random) {
    check_ends(random.draws);
    for (const ExperimentRow& row : experiment_.rows) check_ends(row.draws);
    if (!errors_.empty()) return;
    const std::size_t rows = experiment_.rows.size();
    for (std::int64_t number = 0; number < random.trials; ++number) {
      const std::size_t row = static_cast<std::size_t>(number) % rows;
      if (row == 0 && !errors_.empty()) return;
      std::vector<ExperimentSetting> settings = settings_.common;
      const auto add_draws = [&](const std::vector<ExperimentDraw>& draws) {
        for (const ExperimentDraw& draw : draws) {
          settings.push_back({draw.key, drawn_value(draw, random.seed, number), draw.line});
        }
      };
      add_draws(random.draws);
      const auto& own = settings_.rows[row];
      settings.insert(settings.end(), own.begin(), own.end());
      add_draws(experiment_.rows[row].draws);
      std::optional<Config> config = load(row, settings);
      if (!config) continue;
      config->run.seed = drawn_seed(random.seed, number);
      const std::int64_t seed = config->run.seed;
      experiment_.trials.push_back(
          {row, {}, seed, false, std::make_shared<const Config>(*std::move(config))});
    }
  }

  std::optional<Config> load(std::size_t row, const std::vector<ExperimentSetting>& settings) {
    ConfigSources sources;
    if (!settings_.robot.empty()) sources.robot = settings_.robot;
    sources.controller = experiment_.rows[row].controller;
    for (const ExperimentSetting& s : settings) sources.overrides.push_back(s.key + "=" + s.value);
    if (changes_.turns) {
      sources.overrides.push_back("run.turns=" + toml_literal(*changes_.turns));
    }
    const Result<Config> config = load_config(sources);
    const Errors errors = config ? check_settings(config.value()) : config.errors();
    for (const Error& error : errors) report(placed(error, row, settings));
    if (!errors.empty()) return std::nullopt;
    return config.value();
  }

  /// `error` with the line of the experiment file that it comes from.
  Error placed(Error error, std::size_t row, const std::vector<ExperimentSetting>& settings) const {
    if (!error.file.empty() && !error.file.starts_with("--")) return error;
    if (changes_.turns && error.key == "run.turns") return {"--turns", 0, "", error.message};
    error.line = error.file == "--robot" || error.key == "robot" ? settings_.robot_line
                                                                 : settings_.row_lines[row];
    for (const ExperimentSetting& s : settings) {
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
  bool is_traced(const std::vector<ExperimentSetting>& settings) const {
    const auto holds = [&](const ExperimentSetting& wanted) {
      const auto found =
          std::find_if(settings.rbegin(), settings.rend(),
                       [&](const ExperimentSetting& s) { return s.key == wanted.key; });
      return found != settings.rend() && std::any_of(settings_.trace.begin(), settings_.trace.end(),
                                                     [&](const ExperimentSetting& alternative) {
                                                       return alternative.key == wanted.key &&
                                                              alternative.value == found->value;
                                                     });
    };
    return !settings_.trace.empty() &&
           std::all_of(settings_.trace.begin(), settings_.trace.end(), holds);
  }

  void check_trace_keys() {
    if (!errors_.empty()) return;
    for (const ExperimentSetting& wanted : settings_.trace) {
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
  const ExperimentSettings& settings_;
  const ExperimentChanges& changes_;
  Errors& errors_;
};

void change_seeds(const ExperimentChanges& changes, Experiment& experiment, Errors& errors) {
  const std::string file = experiment.file.string();
  if (changes.trials || changes.draw_seed) {
    errors.push_back({file, 0, "trials", "missing: pirouette sweep runs what is not drawn"});
  }
  if (!changes.seeds) return;
  if (*changes.seeds < 1 || *changes.seeds > kMaxSeeds) {
    errors.push_back({"--seeds", 0, "",
                      "given " + std::to_string(*changes.seeds) + "; allowed: 1 to " +
                          std::to_string(kMaxSeeds)});
    return;
  }
  experiment.seeds.clear();
  for (std::int64_t seed = 1; seed <= *changes.seeds; ++seed) experiment.seeds.push_back(seed);
}

void change_draws(const ExperimentChanges& changes, Experiment& experiment, Errors& errors) {
  if (changes.seeds) {
    errors.push_back({"--seeds", 0, "",
                      "given " + std::to_string(*changes.seeds) +
                          " for an experiment that draws "
                          "its seeds; allowed: pirouette montecarlo with --trials and --seed"});
  }
  const auto change = [&](const char* option, const std::optional<std::int64_t>& value,
                          std::int64_t min, std::int64_t max, std::int64_t& out) {
    if (!value) return;
    if (*value >= min && *value <= max) {
      out = *value;
      return;
    }
    errors.push_back({option, 0, "",
                      "given " + std::to_string(*value) + "; allowed: " + std::to_string(min) +
                          " to " + std::to_string(max)});
  };
  change("--trials", changes.trials, 1, changes.max_trials, experiment.random->trials);
  change("--seed", changes.draw_seed, 0, kMaxDrawSeed, experiment.random->seed);
}

}  // namespace

std::vector<std::string> known_experiments() { return toml_stems(data_dir() / "experiments"); }

fs::path experiment_path(const std::string& name) {
  return data_dir() / "experiments" / (name + ".toml");
}

std::vector<std::string> Experiment::random_keys() const {
  std::set<std::string> keys;
  if (random) {
    for (const ExperimentDraw& draw : random->draws) keys.insert(draw.key);
  }
  for (const ExperimentRow& row : rows) {
    for (const ExperimentDraw& draw : row.draws) keys.insert(draw.key);
  }
  return {keys.begin(), keys.end()};
}

Result<Experiment> load_experiment(const fs::path& file, const ExperimentChanges& changes) {
  Errors errors;
  const std::optional<toml::table> table = parse_toml_file(file, errors);
  if (!table) return errors;
  if (!is_utf8(file.stem().string()) || has_control_character(file.stem().string())) {
    return Error{visible(file.string()), 0, "",
                 "names the experiment, for tables and messages; allowed: a file name in UTF-8 "
                 "without control characters"};
  }
  errors = check_texts(*table, file.string(), "note");
  if (!errors.empty()) return errors;
  Experiment experiment;
  experiment.file = file;
  experiment.name = file.stem().string();
  ExperimentSettings settings;
  read_experiment(*table, experiment, settings, errors);
  if (experiment.random) {
    change_draws(changes, experiment, errors);
  } else {
    change_seeds(changes, experiment, errors);
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
