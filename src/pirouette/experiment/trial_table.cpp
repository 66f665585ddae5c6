#include "pirouette/experiment/trial_table.hpp"

#include "pirouette/experiment/report_format.hpp"

namespace pirouette {

std::string trial_table(const Experiment& experiment, const SweepResult& result) {
  const std::vector<std::string> names = metric_names();
  std::string out = "trial,key,row";
  for (const ExperimentAxis& axis : experiment.axes) out += "," + csv_cell(axis.key);
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
    out += "," + std::to_string(trial.seed);
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
