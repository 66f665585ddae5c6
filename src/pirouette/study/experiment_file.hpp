// Experiment as data: what varies, over which seeds, what is measured, and the printed results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/study/experiment_draw.hpp"

namespace pirouette {

struct Config;

/// One configuration of the robot: a controller bundle and what differs from it.
struct ExperimentRow {
  std::string label;       ///< name in tables
  std::string controller;  ///< name of the bundle
  std::string paper;       ///< printed results beside it (PrintedResult::row); empty: none
  std::vector<ExperimentDraw> draws;  ///< of a random experiment, in addition to those of all rows
};

/// Random experiment: its trials take the rows in turn and draw parameters, run.seed among them.
/// Trial i does not depend on the number of trials.
struct RandomPart {
  std::int64_t trials = 1;                ///< number of trials
  std::int64_t seed = 1;                  ///< of the draws
  std::vector<ExperimentDraw> draws;      ///< in every row
  std::optional<std::int64_t> max_falls;  ///< largest accepted number of falls; absent: any
};

/// A parameter that takes each of `values` in turn, over every row.
struct ExperimentAxis {
  std::string key;                  ///< dotted, such as plant.torsional_friction
  std::vector<std::string> values;  ///< as TOML literals without quotes

  /// Same key and values.
  bool operator==(const ExperimentAxis&) const = default;
};

/// One run: a row, a value of each axis, a seed; in a random experiment a row and what was drawn.
struct ExperimentTrial {
  std::size_t row = 0;                   ///< index into Experiment::rows
  std::vector<std::size_t> levels;       ///< index into each axis' values
  std::int64_t seed = 0;                 ///< run.seed
  bool keep_trace = false;               ///< the trace is kept
  std::shared_ptr<const Config> config;  ///< of this trial
};

/// A column of the tables of the experiment.
struct ExperimentColumn {
  std::string metric;  ///< key of metrics.json
  std::string title;   ///< of the column, with the unit
};

/// Printed results for one row: values of `metrics` for trials with `profile`.
struct PrintedResult {
  std::string row;                        ///< as in ExperimentRow::paper
  std::string profile;                    ///< of the plant
  std::map<std::string, double> metrics;  ///< by key of metrics.json
  /// The results are for one of these values of an axis, the source does not say which; empty key:
  /// for all trials.
  ExperimentAxis among;
};

/// Accepted range of the mean of a metric over the seeds.
struct ExperimentBound {
  std::string row;     ///< label; empty: every row
  std::string metric;  ///< key of metrics.json
  /// Smallest accepted mean; absent: no bound.
  std::optional<double> min, max;  ///< largest accepted mean; absent: no bound
  /// Label of a row: `share` times its mean of `metric` is added to max (0 when absent); empty: max
  /// alone.
  std::string relative_to;
  double share = 0.0;  ///< of the mean of `relative_to`
};

/// A loaded experiment file.
struct Experiment {
  std::filesystem::path file;             ///< of the experiment
  std::string name;                       ///< of the file, without its extension
  std::string title;                      ///< of the tables
  std::string source;                     ///< of the printed results; empty: none
  std::string note;                       ///< for readers of the tables; may be empty
  std::vector<ExperimentRow> rows;        ///< configurations of the robot
  std::vector<ExperimentAxis> axes;       ///< varied in every row
  std::vector<std::int64_t> seeds;        ///< run.seed of the trials
  std::vector<ExperimentTrial> trials;    ///< rows, then axes, then seeds; the last varies fastest
  std::vector<ExperimentColumn> columns;  ///< of the tables
  std::vector<PrintedResult> printed;     ///< for comparison
  /// Labels of rows, each of which should be better than the one before.
  std::vector<std::string> ladder;
  std::vector<ExperimentBound> bounds;  ///< acceptance
  /// A random experiment, without seeds, axes, printed results and bounds.
  std::optional<RandomPart> random;

  /// Parameters that some trials draw, sorted.
  std::vector<std::string> random_keys() const;
};

/// Changes of an experiment by the command line.
struct ExperimentChanges {
  std::optional<int> seeds{};     ///< run seeds 1 to this instead of the file's
  std::optional<double> turns{};  ///< run.turns of every trial
  /// Number of trials of a random experiment.
  std::optional<std::int64_t> trials{}, draw_seed{};  ///< seed of its draws
  std::int64_t max_trials = kMaxTrials;               ///< larger experiments are refused
};

/// The experiment with the configuration of each trial, or all of its errors.
Result<Experiment> load_experiment(const std::filesystem::path& file,
                                   const ExperimentChanges& changes = {});

/// Files under experiments/ of the data folder by name, sorted.
std::vector<std::string> known_experiments();
/// Path of the experiment `name` in the data folder.
std::filesystem::path experiment_path(const std::string& name);

}  // namespace pirouette
