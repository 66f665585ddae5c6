#include "pirouette/report/survival_report.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "pirouette/base/version.hpp"
#include "pirouette/metrics/statistics.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/report/report_format.hpp"
#include "pirouette/study/repeat_command.hpp"

namespace pirouette {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWorst = 10;
constexpr double kPercent = 100.0;
constexpr double kShares[] = {0.05, 0.5, 0.95, 0.99, 1.0};  // of the quantiles that are shown

Number metric(const MetricValues& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : found->second;
}

bool fell(const MetricValues& values) { return metric(values, "fell") == 1.0; }

void add_trial(const MetricValues& values, SurvivalGroup& group) {
  ++group.trials;
  if (fell(values)) {
    ++group.falls;
    if (const Number delay = metric(values, kStandDownDelay)) {
      group.stand_down_delays.push_back(*delay);
    }
    return;
  }
  for (const auto& [name, value] : values) {
    if (value) group.samples[name].push_back(*value);
  }
}

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", kPercent * share);
  return text;
}

const std::vector<double>& samples_of(const SurvivalGroup& group, const std::string& name) {
  static const std::vector<double> kNone;
  const auto found = group.samples.find(name);
  return found == group.samples.end() ? kNone : found->second;
}

class MarkdownWriter {
 public:
  explicit MarkdownWriter(const SurvivalReport& report)
      : report_(report), experiment_(*report.experiment) {}

  std::string write() {
    out_ << "# " << markdown(experiment_.title) << "\n\n"
         << "pirouette " << version() << " (" << commit() << "), MuJoCo " << physics_version()
         << ". " << experiment_.trials.size() << " trials, seed of the draws "
         << experiment_.random->seed << ".\n";
    if (!experiment_.note.empty()) out_ << "\n" << without_html(experiment_.note) << "\n";
    write_draws();
    write_survival();
    write_quantiles();
    write_worst();
    return out_.str();
  }

 private:
  void write_draws() {
    out_ << "\n## Drawn for each trial\n\n| parameter | rows | values |\n|---|---|---|\n";
    const auto write = [&](const std::vector<ExperimentDraw>& draws, const std::string& rows) {
      for (const ExperimentDraw& draw : draws) {
        out_ << "| " << markdown(draw.key) << " | " << markdown(rows) << " | "
             << markdown(draw.to_string()) << " |\n";
      }
    };
    write(experiment_.random->draws, "all");
    for (const ExperimentRow& row : experiment_.rows) write(row.draws, row.label);
    out_ << "| run.seed | all | of noise, biases and terrain |\n";
  }

  void write_survival() {
    out_ << "\n## Survival\n\n| row | trials | falls | survived | 95 % interval (Wilson) |\n"
         << "|---|---|---|---|---|\n";
    for (const SurvivalGroup& group : report_.groups) {
      const std::size_t stood = group.trials - group.falls;
      const auto interval = wilson_interval(stood, group.trials);
      if (!interval) continue;
      out_ << "| " << markdown(group.label) << " | " << group.trials << " | " << group.falls
           << " | " << percent(static_cast<double>(stood) / static_cast<double>(group.trials))
           << " | " << percent(interval->low) << " to " << percent(interval->high) << " |\n";
    }
    const SurvivalGroup& all = report_.groups.front();
    if (all.falls > 0) {
      const Number latest = quantile(all.stand_down_delays, 1.0);
      out_ << "\nOf " << all.falls << " falls " << all.stand_down_delays.size()
           << " ended in the controller's stand-down"
           << (latest ? ", at most " + short_number(*latest) + " s after the fall" : "") << ".\n";
    }
    if (const auto& allowed = experiment_.random->max_falls) {
      const bool holds = all.falls <= static_cast<std::size_t>(*allowed);
      out_ << "\nAllowed are " << *allowed << " falls: " << (holds ? "holds" : "**missed**")
           << ".\n";
    }
  }

  void write_quantiles() {
    out_ << "\n## Quantiles over the trials without a fall\n\n| quantity | row |";
    for (const double share : kShares) {
      out_ << (share == 1.0 ? " largest |" : " " + short_number(kPercent * share) + " % |");
    }
    out_ << "\n|---|---|---|---|---|---|---|\n";
    for (const ExperimentColumn& column : report_.columns) {
      for (const SurvivalGroup& group : report_.groups) {
        out_ << "| " << markdown(column.title) << " | " << markdown(group.label) << " |";
        for (const double share : kShares) {
          const Number value = quantile(samples_of(group, column.metric), share);
          out_ << " " << (value ? short_number(*value) : "-") << " |";
        }
        out_ << "\n";
      }
    }
  }

  void write_worst() {
    const ExperimentColumn& first = report_.columns.front();
    out_ << "\n## The worst trials, and how to repeat them\n\n"
         << "Falls first, the earliest before the others, then by " << markdown(first.title)
         << ".\n";
    for (const std::size_t i : report_.worst) {
      const ExperimentTrial& trial = experiment_.trials[i];
      const MetricValues& values = report_.result->values[i];
      const Number fall_time = metric(values, kFallTime), size = metric(values, first.metric);
      out_ << "\nTrial " << i << ", " << markdown(experiment_.rows[trial.row].label) << ", seed "
           << trial.seed << ": "
           << (fell(values) ? "fell after " + short_number(fall_time.value_or(0.0)) + " s"
                            : markdown(first.title) + " " + (size ? short_number(*size) : "-"))
           << "\n\n    " << repeat_command(trial.config) << "\n";
    }
  }

  const SurvivalReport& report_;
  const Experiment& experiment_;
  std::ostringstream out_;
};

Json as_json(const SurvivalGroup& group, const std::vector<ExperimentColumn>& columns) {
  const std::size_t stood = group.trials - group.falls;
  Json out = {{"row", group.label},
              {"trials", group.trials},
              {"falls", group.falls},
              {"stood_down", group.stand_down_delays.size()}};
  if (const auto interval = wilson_interval(stood, group.trials)) {
    out["survived"] = static_cast<double>(stood) / static_cast<double>(group.trials);
    out["interval_95"] = {interval->low, interval->high};
  }
  for (const ExperimentColumn& column : columns) {
    for (const double share : kShares) {
      const Number value = quantile(samples_of(group, column.metric), share);
      out["quantiles"][column.metric][csv_cell(share)] = value ? Json(*value) : Json(nullptr);
    }
  }
  return out;
}

}  // namespace

SurvivalReport::SurvivalReport(const Experiment& of, const SweepResult& with)
    : experiment(&of), result(&with), columns(of.columns) {
  if (columns.empty()) {
    columns = {{"com.distance_to_point_mean_mm", "mean distance to the point, mm"},
               {"com.radius_mean_mm", "mean radius, mm"}};
  }
  groups.push_back({.label = "all"});
  if (of.rows.size() > 1) {
    for (const ExperimentRow& row : of.rows) groups.push_back({.label = row.label});
  }
  for (std::size_t i = 0; i < of.trials.size(); ++i) {
    add_trial(with.values[i], groups.front());
    if (of.rows.size() > 1) add_trial(with.values[i], groups[1 + of.trials[i].row]);
    worst.push_back(i);
  }
  // Smallest first: falls by their time, then the others from the largest value, then the number.
  const auto rank = [&](std::size_t i) {
    const MetricValues& values = with.values[i];
    if (fell(values)) return std::tuple(0, metric(values, kFallTime).value_or(0.0), i);
    const Number size = metric(values, columns.front().metric);
    return std::tuple(size ? 1 : 2, -size.value_or(0.0), i);
  };
  const std::size_t count = std::min(kWorst, worst.size());
  std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(count), worst.end(),
                    [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  worst.resize(count);
}

std::string SurvivalReport::markdown() const { return MarkdownWriter(*this).write(); }

std::string SurvivalReport::json() const {
  Json root;
  root["experiment"] = experiment->name;
  root["title"] = experiment->title;
  root["version"] = version();
  root["commit"] = commit();
  root["mujoco"] = physics_version();
  root["seed"] = experiment->random->seed;
  for (const SurvivalGroup& group : groups) root["survival"].push_back(as_json(group, columns));
  root["worst"] = Json::array();
  for (const std::size_t i : worst) {
    const ExperimentTrial& trial = experiment->trials[i];
    root["worst"].push_back({{"trial", i},
                             {"row", experiment->rows[trial.row].label},
                             {"seed", trial.seed},
                             {"fell", fell(result->values[i])},
                             {"replay", repeat_command(trial.config)}});
  }
  root["missed_bounds"] = missed_bounds();
  constexpr int kIndent = 1;
  return root.dump(kIndent) + "\n";
}

std::vector<std::string> SurvivalReport::missed_bounds() const {
  std::vector<std::string> missed;
  const auto& allowed = experiment->random->max_falls;
  const SurvivalGroup& all = groups.front();
  if (allowed && all.falls > static_cast<std::size_t>(*allowed)) {
    missed.push_back(std::to_string(all.falls) + " of " + std::to_string(all.trials) +
                     " trials fell; allowed: " + std::to_string(*allowed));
  }
  if (const std::size_t rest = all.falls - all.stand_down_delays.size(); rest > 0) {
    missed.push_back(std::to_string(rest) + " of " + std::to_string(all.falls) +
                     " falls did not end in the stand-down");
  }
  return missed;
}

}  // namespace pirouette
