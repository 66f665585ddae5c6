#include "pirouette/report/report.hpp"

#include <algorithm>
#include <cmath>

#include "pirouette/config/config.hpp"
#include "pirouette/metrics/statistics.hpp"
#include "pirouette/report/report_format.hpp"
#include "pirouette/report/report_words.hpp"

namespace pirouette {
namespace {

namespace text = report_words::comparison;

/// Whether what was printed may hold for a trial at `levels`.
bool applies(const PrintedResult& printed, const Experiment& experiment,
             const std::vector<std::size_t>& levels) {
  const ExperimentAxis& among = printed.among;
  for (std::size_t axis = 0; axis < levels.size(); ++axis) {
    if (experiment.axes[axis].key != among.key) continue;
    const std::string& value = experiment.axes[axis].values[levels[axis]];
    return std::find(among.values.begin(), among.values.end(), value) != among.values.end();
  }
  return true;
}

const PrintedResult* printed_for(const Experiment& experiment, const ExperimentRow& row,
                                 const ExperimentTrial& trial) {
  if (row.paper.empty()) return nullptr;
  for (const PrintedResult& printed : experiment.printed) {
    if (printed.row == row.paper && printed.profile == trial.config->profile &&
        applies(printed, experiment, trial.levels)) {
      return &printed;
    }
  }
  return nullptr;
}

/// The largest value allowed; absent when the row that it depends on gives none.
std::optional<double> limit(const ExperimentBound& bound, const Spread* other) {
  if (bound.relative_to.empty()) return bound.max;
  if (other == nullptr) return std::nullopt;
  return bound.max.value_or(0.0) + bound.share * other->mean;
}

std::string why_missed(const BoundCheck& check) {
  const ExperimentBound& bound = *check.bound;
  const ReportEntry& entry = *check.entry;
  if (entry.falls > 0 && !is_of_falls(bound.metric)) {
    return fill(
        text::kTrialsFell,
        {{"falls", fill(text::kFallsOfTrials, {{"falls", std::to_string(entry.falls)},
                                               {"trials", std::to_string(entry.trials)}})}});
  }
  const Spread* spread = find_metric(entry, bound.metric);
  if (spread == nullptr) return text::kIsAbsent;
  if (!bound.relative_to.empty() && !check.max) {
    return fill(text::kOtherAbsent, {{"row", bound.relative_to}});
  }
  if (bound.min && !(spread->mean >= *bound.min)) {
    return fill(text::kBelow,
                {{"value", short_number(spread->mean)}, {"limit", short_number(*bound.min)}});
  }
  if (check.max && !(spread->mean <= *check.max)) {
    return fill(text::kAbove,
                {{"value", short_number(spread->mean)}, {"limit", short_number(*check.max)}});
  }
  return "";
}

}  // namespace

Report::Report(const Experiment& of, const SweepResult& with) : experiment(&of), result(&with) {
  const std::size_t seeds = of.seeds.size();
  for (std::size_t begin = 0; begin < of.trials.size(); begin += seeds) {
    ReportEntry entry;
    entry.first = &of.trials[begin];
    entry.row = &of.rows[entry.first->row];
    entry.printed = printed_for(of, *entry.row, *entry.first);
    std::map<std::string, std::vector<double>> samples;
    for (std::size_t i = begin; i < begin + seeds; ++i) {
      if (of.trials[i].keep_trace) {
        entry.trace = trace_path("", with.keys[i]).string();
      }
      const MetricValues& values = with.values[i];
      if (values.empty()) continue;
      ++entry.trials;
      const bool fell = values.at("fell") == 1.0;
      entry.falls += fell ? 1 : 0;
      for (const auto& [name, value] : values) {
        if (value && (!fell || is_of_falls(name))) samples[name].push_back(*value);
      }
    }
    for (const auto& [name, x] : samples) {
      entry.metrics[name] = {mean(x).value_or(0.0), std::sqrt(variance(x).value_or(0.0)), x.size()};
    }
    entries.push_back(std::move(entry));
  }
}

std::vector<BoundCheck> Report::check_bounds() const {
  std::vector<BoundCheck> checks;
  for (const ExperimentBound& bound : experiment->bounds) {
    for (const ReportEntry& entry : entries) {
      if (!bound.row.empty() && bound.row != entry.row->label) continue;
      const auto other = std::find_if(entries.begin(), entries.end(), [&](const ReportEntry& e) {
        return e.row->label == bound.relative_to && e.first->levels == entry.first->levels;
      });
      BoundCheck check{&bound, &entry, std::nullopt, ""};
      check.max =
          limit(bound, other == entries.end() ? nullptr : find_metric(*other, bound.metric));
      check.missed = why_missed(check);
      checks.push_back(std::move(check));
    }
  }
  return checks;
}

std::vector<std::string> Report::missed_bounds() const {
  std::vector<std::string> missed;
  for (const BoundCheck& check : check_bounds()) {
    if (check.missed.empty()) continue;
    missed.push_back(fill(text::kMissedBound, {{"place", place_text(*experiment, *check.entry)},
                                               {"profile", check.entry->first->config->profile},
                                               {"metric", check.bound->metric},
                                               {"why", check.missed}}));
  }
  return missed;
}

}  // namespace pirouette
