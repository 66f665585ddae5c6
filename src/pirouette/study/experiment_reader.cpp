#include "pirouette/study/experiment_reader.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "pirouette/config/suggest.hpp"
#include "pirouette/study/draw_reader.hpp"
#include "pirouette/study/table_reader.hpp"

namespace pirouette {
namespace {

class Reader : private TableReader {
 public:
  Reader(Experiment& experiment, ExperimentSettings& settings, Errors& errors)
      : TableReader(experiment.file.string(), errors),
        experiment_(experiment),
        settings_(settings) {}

  void read(const toml::table& table) {
    const bool random = table.contains("trials") || table.contains("random");
    if (random) {
      allow_keys(table, "",
                 {"title", "note", "robot", "trials", "seed", "max_falls", "common", "random",
                  "rows", "columns"});
      read_random(table);
    } else {
      allow_keys(table, "",
                 {"title", "source", "note", "robot", "robots", "seeds", "ladder", "common", "rows",
                  "axes", "trace", "columns", "paper", "bounds"});
    }
    experiment_.title = text(table, "", "title").value_or(experiment_.name);
    experiment_.source = text(table, "", "source").value_or("");
    experiment_.note = text(table, "", "note").value_or("");
    settings_.robot = text(table, "", "robot").value_or("");
    if (const toml::node* robot = table.get("robot")) settings_.robot_line = line_of(*robot);
    settings_.common = settings(table, "", "common");
    settings_.trace = settings(table, "", "trace", Lists::kAlternatives);
    read_seeds(table);
    read_robots(table);
    for_each(table, "rows", [&](const toml::table& row) { read_row(row); });
    for_each(table, "axes", [&](const toml::table& axis) { read_axis(axis); });
    for_each(table, "columns", [&](const toml::table& column) { read_column(column); });
    for_each(table, "paper", [&](const toml::table& printed) { read_printed(printed); });
    for_each(table, "bounds", [&](const toml::table& bound) { read_bound(bound); });
    if (experiment_.rows.empty()) report(table, "rows", "none given; an experiment needs [[rows]]");
    read_ladder(table);
  }

 private:
  void read_random(const toml::table& table) {
    RandomPart& random = experiment_.random.emplace();
    if (!table.contains("trials")) {
      report(table, "trials", "missing: how many trials draw from [random]");
    }
    random.trials = count(table, "trials", 1, kMaxTrials).value_or(1);
    random.seed = count(table, "seed", 0, kMaxDrawSeed).value_or(random.seed);
    random.max_falls = count(table, "max_falls", 0, kMaxTrials);
    random.draws = read_draws(*this, table, "");
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

  /// The first axis, which varies slowest.
  void read_robots(const toml::table& table) {
    const toml::node* node = table.get("robots");
    if (node == nullptr) return;
    if (table.contains("robot")) {
      report(*node, "robots", "given beside robot; allowed: one of them");
      return;
    }
    const toml::array* list = node->as_array();
    const bool good = list != nullptr && !list->empty() && list->is_homogeneous<std::string>();
    if (!good) {
      report(*node, "robots",
             "given " + shown(*node) + "; allowed: a list of names under robots/ or MJCF files");
      return;
    }
    add_axis("robot", *list);
  }

  void read_row(const toml::table& table) {
    if (experiment_.random) {
      allow_keys(table, "rows.", {"label", "controller", "set", "random"});
    } else {
      allow_keys(table, "rows.", {"label", "controller", "paper", "set", "max"});
    }
    ExperimentRow row;
    row.label = needed_text(table, "rows.", "label");
    row.controller = needed_text(table, "rows.", "controller");
    row.paper = text(table, "rows.", "paper").value_or("");
    row.draws = read_draws(*this, table, "rows.");
    const bool taken = std::any_of(experiment_.rows.begin(), experiment_.rows.end(),
                                   [&](const ExperimentRow& r) { return r.label == row.label; });
    if (taken) report(table, "rows.label", in_quotes(row.label) + " stands there twice");
    read_row_bounds(table, row.label);
    experiment_.rows.push_back(std::move(row));
    settings_.rows.push_back(settings(table, "rows.", "set"));
    settings_.row_lines.push_back(line_of(table));
  }

  /// `max` of a row is short for [[bounds]] with that row.
  void read_row_bounds(const toml::table& table, const std::string& label) {
    const toml::node* node = table.get("max");
    if (node == nullptr) return;
    if (!node->is_table()) {
      report(*node, "rows.max", "given " + shown(*node) + "; allowed: a table of metrics");
      return;
    }
    std::map<std::string, double> limits;
    numbers(*node->as_table(), "", limits);
    for (const auto& [metric, limit] : limits) {
      ExperimentBound bound;
      bound.row = label;
      bound.metric = metric;
      bound.max = limit;
      experiment_.bounds.push_back(std::move(bound));
    }
  }

  void read_axis(const toml::table& table) {
    allow_keys(table, "axes.", {"key", "values"});
    const std::string key = needed_text(table, "axes.", "key");
    if (key == "run.seed") report(table, "axes.key", "seeds are given by the list `seeds`");
    if (key == "robot") report(table, "axes.key", "robots are given by the list `robots`");
    const toml::node* node = table.get("values");
    const toml::array* list = node != nullptr ? node->as_array() : nullptr;
    if (list == nullptr || list->empty()) {
      report(node != nullptr ? *node : table, "axes.values", "allowed: a list of values");
      return;
    }
    add_axis(key, *list);
  }

  void add_axis(const std::string& key, const toml::array& values) {
    ExperimentAxis axis{key, {}};
    std::vector<ExperimentSetting> settings;
    for (const toml::node& value : values) {
      settings.push_back({key, shown(value), line_of(value)});
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
    allow_keys(table, "paper.", {"row", "profile", "metrics", "axis", "among"});
    PrintedResult printed;
    printed.row = needed_text(table, "paper.", "row");
    printed.profile = needed_text(table, "paper.", "profile");
    const bool known = std::any_of(experiment_.rows.begin(), experiment_.rows.end(),
                                   [&](const ExperimentRow& r) { return r.paper == printed.row; });
    if (!known) report(table, "paper.row", "no row has paper = " + in_quotes(printed.row));
    read_among(table, printed.among);
    const toml::node* metrics = table.get("metrics");
    if (metrics == nullptr || !metrics->is_table()) {
      report(table, "paper.metrics", "missing: a table of printed values");
      return;
    }
    numbers(*metrics->as_table(), "", printed.metrics);
    experiment_.printed.push_back(std::move(printed));
  }

  /// Of an axis, the values of which one holds.
  void read_among(const toml::table& table, ExperimentAxis& among) {
    const toml::node* node = table.get("among");
    if (node == nullptr && table.get("axis") == nullptr) return;
    among.key = needed_text(table, "paper.", "axis");
    const auto axis = std::find_if(experiment_.axes.begin(), experiment_.axes.end(),
                                   [&](const ExperimentAxis& a) { return a.key == among.key; });
    if (axis == experiment_.axes.end()) {
      report(table, "paper.axis", "given " + in_quotes(among.key) + "; allowed: key of an axis");
      return;
    }
    const toml::array* list = node != nullptr ? node->as_array() : nullptr;
    if (list == nullptr || list->empty()) {
      report(node != nullptr ? *node : table, "paper.among", "allowed: a list of its values");
      return;
    }
    for (const toml::node& value : *list) {
      among.values.push_back(without_quotes(shown(value)));
      if (std::find(axis->values.begin(), axis->values.end(), among.values.back()) !=
          axis->values.end()) {
        continue;
      }
      report(value, "paper.among", "given " + shown(value) + "; allowed: " + joined(axis->values));
    }
  }

  void read_bound(const toml::table& table) {
    allow_keys(table, "bounds.", {"row", "metric", "min", "max", "share", "of"});
    ExperimentBound bound;
    bound.row = text(table, "bounds.", "row").value_or("");
    bound.metric = needed_text(table, "bounds.", "metric");
    if (!bound.row.empty()) check_label(table, "bounds.row", bound.row);
    if (const toml::node* min = table.get("min")) bound.min = number(*min, "bounds.min");
    if (const toml::node* max = table.get("max")) bound.max = number(*max, "bounds.max");
    bound.relative_to = text(table, "bounds.", "of").value_or("");
    if (!bound.relative_to.empty()) check_label(table, "bounds.of", bound.relative_to);
    if (const toml::node* share = table.get("share")) {
      bound.share = number(*share, "bounds.share").value_or(0.0);
    }
    if ((table.get("share") != nullptr) != (table.get("of") != nullptr)) {
      report(table, "bounds", "share and of go together");
    } else if (!table.get("min") && !table.get("max") && !table.get("share")) {
      report(table, "bounds", "needs min, max, or share and of");
    }
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
  ExperimentSettings& settings_;
};

}  // namespace

void read_experiment(const toml::table& table, Experiment& experiment, ExperimentSettings& settings,
                     Errors& errors) {
  Reader(experiment, settings, errors).read(table);
}

}  // namespace pirouette
