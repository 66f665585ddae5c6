#include "pirouette/report/trial_table.hpp"

#include <algorithm>
#include <map>

#include "pirouette/config/config.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/report/report_format.hpp"

namespace pirouette {
namespace {

/// Cells of the parameters `keys`, which are sorted, each with a comma before it.
std::string drawn_cells(const Config& config, const std::vector<std::string>& keys) {
  if (keys.empty()) return "";
  std::map<std::string, std::string> values;
  for (const ParameterGroup& group : describe(config)) {
    for (const ParameterInfo& parameter : group.parameters) {
      if (std::binary_search(keys.begin(), keys.end(), parameter.key)) {
        values[parameter.key] = without_quotes(parameter.value);
      }
    }
  }
  std::string cells;
  for (const std::string& key : keys) cells += "," + csv_cell(values[key]);
  return cells;
}

}  // namespace

std::string trial_table(const Experiment& experiment, const SweepResult& result) {
  const std::vector<std::string> names = metric_names();
  std::string out = "trial,key,row";
  for (const ExperimentAxis& axis : experiment.axes) out += "," + csv_cell(axis.key);
  const std::vector<std::string> drawn = experiment.random_keys();
  for (const std::string& key : drawn) out += "," + csv_cell(key);
  out += ",seed";
  for (const std::string& name : names) out += "," + name;
  out += "\n";
  for (std::size_t i = 0; i < experiment.trials.size(); ++i) {
    const ExperimentTrial& trial = experiment.trials[i];
    out +=
        std::to_string(i) + "," + result.keys[i] + "," + csv_cell(experiment.rows[trial.row].label);
    for (std::size_t axis = 0; axis < experiment.axes.size(); ++axis) {
      out += "," + csv_cell(experiment.axes[axis].values[trial.levels[axis]]);
    }
    out += drawn_cells(*trial.config, drawn) + "," + std::to_string(trial.seed);
    for (const std::string& name : names) {
      const auto found = result.values[i].find(name);
      const bool known = found != result.values[i].end() && found->second;
      out += known ? "," + csv_cell(*found->second) : ",";
    }
    out += "\n";
  }
  return out;
}

}  // namespace pirouette
