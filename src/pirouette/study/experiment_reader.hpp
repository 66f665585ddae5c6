// Content of an experiment file before it is expanded into trials; for this folder only.
#pragma once

#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/config/toml_node.hpp"
#include "pirouette/study/experiment_file.hpp"

namespace pirouette {

/// A parameter's value in the experiment file, and where it stands.
struct ExperimentSetting {
  std::string key;
  std::string value;  ///< TOML
  int line = 0;
};

/// The parameters of an experiment's rows and axes, beside what Experiment says of them.
struct ExperimentSettings {
  std::string robot;
  int robot_line = 0;
  std::vector<ExperimentSetting> common;
  std::vector<std::vector<ExperimentSetting>> rows;
  std::vector<int> row_lines;
  std::vector<std::vector<ExperimentSetting>> axes;  ///< one for each value
  std::vector<ExperimentSetting> trace;  ///< a key may occur twice: either value is right
};

/// Fills `experiment`, whose file and name are set, but for its trials.
void read_experiment(const toml::table& table, Experiment& experiment, ExperimentSettings& settings,
                     Errors& errors);

}  // namespace pirouette
