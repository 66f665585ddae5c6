// An experiment is data: what varies, over which seeds, what is read off, and what the paper
// printed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/study/experiment_draw.hpp"

namespace pirouette {

/// One way to run the robot: a controller bundle and what differs from it.
struct ExperimentRow {
  std::string label;
  std::string controller;
  std::string paper;                  ///< whose printed figures stand beside it; empty: nobody's
  std::vector<ExperimentDraw> draws;  ///< of a random experiment, above those of all rows
};

/// Of an experiment whose trials take the rows in turn and draw parameters, run.seed among them:
/// trial i is the same however many there are.
struct RandomPart {
  std::int64_t trials = 1;
  std::int64_t seed = 1;                  ///< of the draws
  std::vector<ExperimentDraw> draws;      ///< in every row
  std::optional<std::int64_t> max_falls;  ///< acceptance
};

/// A parameter that takes each of `values` in turn, over every row.
struct ExperimentAxis {
  std::string key;                  ///< dotted, such as plant.torsional_friction
  std::vector<std::string> values;  ///< as TOML literals without quotes

  bool operator==(const ExperimentAxis&) const = default;
};

/// One run: a row, a value of each axis, a seed; in a random experiment a row and what was drawn.
struct ExperimentTrial {
  std::size_t row = 0;
  std::vector<std::size_t> levels;  ///< index into each axis' values
  std::int64_t seed = 0;
  bool keep_trace = false;
  Config config;
};

/// A quantity that the experiment's tables show: a key of metrics.json.
struct ExperimentColumn {
  std::string metric;
  std::string title;  ///< with its unit
};

/// What somebody printed for one row: the values of `metrics`, for trials with `profile`.
struct PrintedResult {
  std::string row;  ///< as in ExperimentRow::paper
  std::string profile;
  std::map<std::string, double> metrics;
  /// They hold for one of these values of an axis, and the source does not say which; no key: for
  /// all trials.
  ExperimentAxis among;
};

/// Acceptance: the mean of `metric` over the seeds, in `row` or, empty, everywhere.
struct ExperimentBound {
  std::string row;
  std::string metric;
  std::optional<double> min, max;
  /// The largest allowed is max, or 0, plus `share` times the mean of `metric` in the row
  /// `relative_to`; empty: max alone.
  std::string relative_to;
  double share = 0.0;
};

struct Experiment {
  std::filesystem::path file;
  std::string name;  ///< the file's, without its extension
  std::string title;
  std::string source;  ///< of the printed results; empty: nobody's
  std::string note;    ///< what a reader of the tables must know; may be empty
  std::vector<ExperimentRow> rows;
  std::vector<ExperimentAxis> axes;
  std::vector<std::int64_t> seeds;
  std::vector<ExperimentTrial> trials;  ///< rows, then axes, then seeds; the last varies fastest
  std::vector<ExperimentColumn> columns;
  std::vector<PrintedResult> printed;
  std::vector<std::string> ladder;  ///< labels of rows of which each should better the one before
  std::vector<ExperimentBound> bounds;
  std::optional<RandomPart> random;  ///< without seeds, axes, printed figures and bounds

  /// Parameters that some trials draw, sorted.
  std::vector<std::string> random_keys() const;
};

/// What the command line changes in an experiment.
struct ExperimentChanges {
  std::optional<int> seeds{};                         ///< run seeds 1 to this instead of the file's
  std::optional<double> turns{};                      ///< run.turns of every trial
  std::optional<std::int64_t> trials{}, draw_seed{};  ///< of a random experiment
  std::int64_t max_trials = kMaxTrials;               ///< an experiment of more is refused
};

/// The experiment with the configuration of each trial, or everything that is wrong with it at
/// once.
Result<Experiment> load_experiment(const std::filesystem::path& file,
                                   const ExperimentChanges& changes = {});

/// Files under experiments/ of the data folder by name, sorted.
std::vector<std::string> known_experiments();
std::filesystem::path experiment_path(const std::string& name);

}  // namespace pirouette
