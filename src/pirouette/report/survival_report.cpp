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
#include "pirouette/report/report_words.hpp"
#include "pirouette/study/repeat_command.hpp"

namespace pirouette {
namespace {

namespace text = report_words::survival;

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
    out_ << fill(
        report_words::kTitle,
        {{"title", markdown(experiment_.title)},
         {"version", version()},
         {"commit", commit()},
         {"mujoco", physics_version()},
         {"size", fill(text::kSize, {{"trials", std::to_string(experiment_.trials.size())},
                                     {"seed", std::to_string(experiment_.random->seed)}})}});
    if (!experiment_.note.empty()) {
      out_ << fill(report_words::kNote, {{"note", without_html(experiment_.note)}});
    }
    write_draws();
    write_survival();
    write_quantiles();
    write_worst();
    return out_.str();
  }

 private:
  void write_draws() {
    std::string list;
    const auto add = [&](const std::vector<ExperimentDraw>& draws, const std::string& rows) {
      for (const ExperimentDraw& draw : draws) {
        list += fill(text::kDraw, {{"key", markdown(draw.key)},
                                   {"rows", markdown(rows)},
                                   {"values", markdown(draw.to_string())}});
      }
    };
    add(experiment_.random->draws, text::kAll);
    for (const ExperimentRow& row : experiment_.rows) add(row.draws, row.label);
    out_ << fill(text::kDrawn, {{"draws", list}});
  }

  void write_survival() {
    out_ << text::kSurvival;
    for (const SurvivalGroup& group : report_.groups) {
      const std::size_t stood = group.trials - group.falls;
      const auto interval = wilson_interval(stood, group.trials);
      if (!interval) continue;
      const double share = static_cast<double>(stood) / static_cast<double>(group.trials);
      out_ << fill(text::kGroup, {{"row", markdown(group.label)},
                                  {"trials", std::to_string(group.trials)},
                                  {"falls", std::to_string(group.falls)},
                                  {"survived", percent(share)},
                                  {"low", percent(interval->low)},
                                  {"high", percent(interval->high)}});
    }
    const SurvivalGroup& all = report_.groups.front();
    if (all.falls > 0) write_stand_downs(all);
    if (const auto& allowed = experiment_.random->max_falls) {
      const bool holds = all.falls <= static_cast<std::size_t>(*allowed);
      out_ << fill(text::kAllowed, {{"falls", std::to_string(*allowed)},
                                    {"verdict", holds ? report_words::kHolds : text::kMissed}});
    }
  }

  void write_stand_downs(const SurvivalGroup& all) {
    const Number latest = quantile(all.stand_down_delays, 1.0);
    out_ << fill(
        text::kStoodDown,
        {{"falls", std::to_string(all.falls)},
         {"stood_down", std::to_string(all.stand_down_delays.size())},
         {"latest", latest ? fill(text::kLatest, {{"delay", short_number(*latest)}}) : ""}});
  }

  void write_quantiles() {
    std::string shares;
    for (const double share : kShares) {
      shares += share == 1.0 ? text::kLargest
                             : fill(text::kShare, {{"percent", short_number(kPercent * share)}});
    }
    out_ << fill(text::kQuantiles, {{"shares", shares}});
    for (const ExperimentColumn& column : report_.columns) {
      for (const SurvivalGroup& group : report_.groups) write_quantities(column, group);
    }
  }

  void write_quantities(const ExperimentColumn& column, const SurvivalGroup& group) {
    std::string values;
    for (const double share : kShares) {
      const Number value = quantile(samples_of(group, column.metric), share);
      values += fill(text::kQuantile, {{"value", value ? short_number(*value) : text::kAbsent}});
    }
    out_ << fill(
        text::kQuantity,
        {{"quantity", markdown(column.title)}, {"row", markdown(group.label)}, {"values", values}});
  }

  void write_worst() {
    const std::string quantity = markdown(report_.columns.front().title);
    out_ << fill(text::kWorst, {{"quantity", quantity}});
    for (const std::size_t i : report_.worst) {
      const ExperimentTrial& trial = experiment_.trials[i];
      out_ << fill(text::kTrial, {{"number", std::to_string(i)},
                                  {"row", markdown(experiment_.rows[trial.row].label)},
                                  {"seed", std::to_string(trial.seed)},
                                  {"outcome", outcome(report_.result->values[i], quantity)},
                                  {"command", repeat_command(*trial.config)}});
    }
  }

  std::string outcome(const MetricValues& values, const std::string& quantity) const {
    if (fell(values)) {
      const double time = metric(values, kFallTime).value_or(0.0);
      return fill(text::kFell, {{"time", short_number(time)}});
    }
    const Number size = metric(values, report_.columns.front().metric);
    return fill(text::kSizeOfTrial,
                {{"quantity", quantity}, {"value", size ? short_number(*size) : text::kAbsent}});
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
  groups.push_back({.label = text::kAll});
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
                             {"replay", repeat_command(*trial.config)}});
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
    missed.push_back(fill(text::kTooManyFell, {{"falls", std::to_string(all.falls)},
                                               {"trials", std::to_string(all.trials)},
                                               {"allowed", std::to_string(*allowed)}}));
  }
  if (const std::size_t rest = all.falls - all.stand_down_delays.size(); rest > 0) {
    missed.push_back(fill(text::kNotStoodDown,
                          {{"rest", std::to_string(rest)}, {"falls", std::to_string(all.falls)}}));
  }
  return missed;
}

}  // namespace pirouette
