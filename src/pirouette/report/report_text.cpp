#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "pirouette/base/version.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/metrics/statistics.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/report/report_format.hpp"
#include "pirouette/report/report_words.hpp"

namespace pirouette {
namespace {

namespace text = report_words::comparison;

constexpr const char* kBias = "com.body_bias_mm_s";
constexpr const char* kBiasCircle = "com.bias_circle_mm";
constexpr const char* kRadius = "com.radius_mean_mm";
constexpr const char* kDrift = "com.drift_per_turn_mm";
constexpr const char* kOdometry = "estimator.position_error_mm";
constexpr double kPercent = 100.0;

std::string column_title(const Experiment& experiment, const std::string& metric) {
  for (const ExperimentColumn& column : experiment.columns) {
    if (column.metric == metric) return column.title;
  }
  return metric;
}

/// "radius, mm" -> "radius"
std::string without_unit(const std::string& title) { return title.substr(0, title.rfind(',')); }
/// "radius, mm" -> " mm"
std::string unit_of(const std::string& title) {
  const std::size_t comma = title.rfind(',');
  return comma == title.npos ? "" : title.substr(comma + 1);
}

class MarkdownWriter {
 public:
  explicit MarkdownWriter(const Report& report)
      : report_(report), experiment_(*report.experiment) {}

  std::string write() {
    out_ << fill(report_words::kTitle, {{"title", markdown(experiment_.title)},
                                        {"version", version()},
                                        {"commit", commit()},
                                        {"mujoco", physics_version()},
                                        {"size", size()}});
    if (!experiment_.note.empty()) {
      out_ << fill(report_words::kNote, {{"note", without_html(experiment_.note)}});
    }
    for (const std::string& profile : profiles()) write_profile(profile);
    write_bounds();
    return out_.str();
  }

 private:
  std::string size() const {
    const std::string& source = experiment_.source;
    return fill(
        experiment_.seeds.size() == 1 ? text::kOneSeed : text::kSeeds,
        {{"seeds", std::to_string(experiment_.seeds.size())},
         {"source", source.empty() ? "" : fill(text::kSource, {{"source", markdown(source)}})}});
  }

  std::vector<std::string> profiles() const {
    std::vector<std::string> names;
    for (const ReportEntry& entry : report_.entries) {
      const std::string& name = entry.first->config->profile;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
  }

  void write_profile(const std::string& profile) {
    entries_.clear();
    for (const ReportEntry& entry : report_.entries) {
      if (entry.first->config->profile == profile) entries_.push_back(&entry);
    }
    out_ << fill(text::kProfile, {{"profile", markdown(profile)}});
    write_table();
    write_falls();
    write_comparison();
    for (const ExperimentAxis& among : unnamed_values()) write_nearest(among);
    write_bias();
    write_ladder();
  }

  std::string place(const ReportEntry& entry) const {
    return markdown(place_text(experiment_, entry));
  }

  bool is_printed(const std::string& metric) const {
    return std::any_of(entries_.begin(), entries_.end(), [&](const ReportEntry* entry) {
      return find_printed(*entry, metric) != nullptr;
    });
  }

  bool varies(const ReportContext& context) const {
    return std::any_of(entries_.begin(), entries_.end(), [&](const ReportEntry* entry) {
      return context.text(*entry->first->config) != context.text(*entries_.front()->first->config);
    });
  }

  /// Axes other than those that stand beside every table anyway.
  std::vector<std::size_t> extra_axes() const {
    std::vector<std::size_t> axes;
    for (std::size_t i = 0; i < experiment_.axes.size(); ++i) {
      const std::string& key = experiment_.axes[i].key;
      const auto contexts = report_contexts();
      const bool known = std::any_of(contexts.begin(), contexts.end(),
                                     [&](const ReportContext& c) { return key == c.key; });
      if (key != "profile" && !known) axes.push_back(i);
    }
    return axes;
  }

  /// What all rows have in common becomes a sentence, the rest columns.
  void write_contexts() {
    columns_.clear();
    std::vector<std::string> common;
    for (const ReportContext& context : report_contexts()) {
      if (varies(context)) {
        columns_.push_back(&context);
        continue;
      }
      common.push_back(
          fill(text::kContext, {{"name", without_unit(context.title)},
                                {"value", markdown(context.text(*entries_.front()->first->config))},
                                {"unit", unit_of(context.title)}}));
    }
    if (!common.empty()) {
      out_ << fill(text::kEverywhere, {{"values", joined_by("; ", common)}});
    }
  }

  void write_table() {
    write_contexts();
    std::string head = "|", rule = "|";
    const auto add = [&](const std::string& title) {
      head += " " + markdown(title) + " |";
      rule += "---|";
    };
    add(text::kRow);
    for (const ReportContext* context : columns_) add(context->title);
    for (const std::size_t axis : extra_axes()) add(experiment_.axes[axis].key);
    add(text::kFalls);
    for (const ExperimentColumn& column : experiment_.columns) {
      add(column.title);
      if (is_printed(column.metric)) add(text::kPrinted);
    }
    out_ << head << "\n" << rule << "\n";
    for (const ReportEntry* entry : entries_) write_line(*entry);
  }

  void write_line(const ReportEntry& entry) {
    out_ << "| " << markdown(entry.row->label) << " |";
    for (const ReportContext* context : columns_) {
      out_ << " " << markdown(context->text(*entry.first->config)) << " |";
    }
    for (const std::size_t axis : extra_axes()) {
      out_ << " " << markdown(experiment_.axes[axis].values[entry.first->levels[axis]]) << " |";
    }
    out_ << " " << falls_of_trials(entry) << " |";
    for (const ExperimentColumn& column : experiment_.columns) {
      const Spread* spread = find_metric(entry, column.metric);
      out_ << " " << (spread != nullptr ? with_spread(*spread) : text::kAbsent) << " |";
      if (!is_printed(column.metric)) continue;
      const double* printed = find_printed(entry, column.metric);
      out_ << " " << (printed != nullptr ? short_number(*printed) : "") << " |";
    }
    out_ << "\n";
  }

  static std::string falls_of_trials(const ReportEntry& entry) {
    return fill(text::kFallsOfTrials,
                {{"falls", std::to_string(entry.falls)}, {"trials", std::to_string(entry.trials)}});
  }

  void write_falls() {
    std::string falls;
    for (const ReportEntry* entry : entries_) {
      if (entry->falls == 0) continue;
      falls +=
          fill(text::kFall, {{"place", place(*entry)},
                             {"falls", falls_of_trials(*entry)},
                             {"after", with_metric(text::kFallTime, "time", *entry, kFallTime)}});
    }
    out_ << (falls.empty() ? text::kNoTrialFell : text::kFallsTitle + falls);
  }

  /// `words` with the metric as its value `name`; empty where the metric is absent.
  static std::string with_metric(const char* words, const char* name, const ReportEntry& entry,
                                 const char* metric) {
    const Spread* spread = find_metric(entry, metric);
    return spread != nullptr ? fill(words, {{name, with_spread(*spread)}}) : "";
  }

  void write_comparison() {
    if (std::none_of(entries_.begin(), entries_.end(),
                     [](const ReportEntry* entry) { return entry->printed != nullptr; })) {
      return;
    }
    out_ << text::kAgainstPrinted;
    for (const ReportEntry* entry : entries_) {
      if (entry->printed != nullptr) write_difference(*entry);
    }
  }

  void write_difference(const ReportEntry& entry) {
    if (entry.falls == entry.trials) {
      out_ << fill(text::kEveryTrialFell, {{"place", place(entry)}});
      return;
    }
    std::vector<std::string> differences;
    for (const ExperimentColumn& column : experiment_.columns) {
      const double* printed = find_printed(entry, column.metric);
      const Spread* ours = find_metric(entry, column.metric);
      if (printed == nullptr || ours == nullptr) continue;
      differences.push_back(
          fill(text::kDifference, {{"quantity", markdown(without_unit(column.title))},
                                   {"ours", short_number(ours->mean)},
                                   {"printed", short_number(*printed)},
                                   {"unit", markdown(unit_of(column.title))},
                                   {"difference", difference(ours->mean, *printed)}}));
    }
    const Spread* drift = find_metric(entry, kDrift);
    out_ << fill(
        text::kDifferences,
        {{"place", place(entry)},
         {"differences", joined_by("; ", differences)},
         {"bias", bias_text(entry)},
         {"drift",
          drift != nullptr ? fill(text::kDrift, {{"drift", short_number(drift->mean)}}) : ""}});
  }

  static std::string bias_text(const ReportEntry& entry) {
    const Spread* bias = find_metric(entry, kBias);
    const Spread* circle = find_metric(entry, kBiasCircle);
    const Spread* odometry = find_metric(entry, kOdometry);
    if (bias == nullptr || circle == nullptr || odometry == nullptr) return "";
    return fill(text::kBias, {{"bias", short_number(bias->mean)},
                              {"circle", short_number(circle->mean)},
                              {"odometry", short_number(odometry->mean)}});
  }

  /// The axes, with values, of which the source does not say which value it had.
  std::vector<ExperimentAxis> unnamed_values() const {
    std::vector<ExperimentAxis> found;
    for (const ReportEntry* entry : entries_) {
      if (entry->printed == nullptr || entry->printed->among.key.empty()) continue;
      const ExperimentAxis& among = entry->printed->among;
      if (std::find(found.begin(), found.end(), among) == found.end()) found.push_back(among);
    }
    return found;
  }

  /// exp(mean |ln(ours / printed)|) over the metrics printed for `paper`, or for everybody when
  /// empty, at `value` of the axis; absent where nothing can be compared.
  Number factor_off(const ExperimentAxis& among, const std::string& value,
                    const std::string& paper) const {
    std::vector<double> logarithms;
    for (const ReportEntry* entry : entries_) {
      const PrintedResult* printed = entry->printed;
      if (printed == nullptr || printed->among != among) continue;
      if (!paper.empty() && printed->row != paper) continue;
      if (axis_value(*entry, among.key) != value) continue;
      for (const auto& [metric, figure] : printed->metrics) {
        const Spread* ours = find_metric(*entry, metric);
        if (ours == nullptr || !(ours->mean * figure > 0.0)) continue;
        logarithms.push_back(std::abs(std::log(ours->mean / figure)));
      }
    }
    const Number off = mean(logarithms);
    return off ? Number(std::exp(*off)) : std::nullopt;
  }

  std::string axis_value(const ReportEntry& entry, const std::string& key) const {
    for (std::size_t axis = 0; axis < experiment_.axes.size(); ++axis) {
      const ExperimentAxis& a = experiment_.axes[axis];
      if (a.key == key) return a.values[entry.first->levels[axis]];
    }
    return "";
  }

  void write_nearest(const ExperimentAxis& among) {
    out_ << fill(text::kNotSaid,
                 {{"key", markdown(among.key)}, {"values", markdown(joined(among.values))}});
    std::set<std::string> papers;
    for (const ReportEntry* entry : entries_) {
      if (entry->printed != nullptr && entry->printed->among == among) {
        papers.insert(entry->printed->row);
      }
    }
    for (const std::string& paper : papers) write_factors(among, paper, paper);
    if (papers.size() > 1) write_factors(among, "", text::kAllTogether);
  }

  void write_factors(const ExperimentAxis& among, const std::string& paper,
                     const std::string& title) {
    std::vector<std::string> factors;
    std::string nearest;
    Number least;
    for (const std::string& value : among.values) {
      const Number off = factor_off(among, value, paper);
      factors.push_back(markdown(value) + " " + (off ? short_number(*off) : text::kFell));
      if (!off || (least && *off >= *least)) continue;
      least = off;
      nearest = fill(text::kNearest, {{"value", markdown(value)}});
    }
    out_ << fill(text::kFactors, {{"paper", markdown(title)},
                                  {"nearest", nearest.empty() ? text::kNothingToCompare : nearest},
                                  {"factors", joined_by(", ", factors)}});
  }

  static std::string difference(double ours, double printed) {
    if (printed == 0.0) {
      return fill(text::kMore, {{"number", short_number(ours - printed)}});
    }
    const double ratio = ours / printed;
    if (ratio < 0.0) return text::kOppositeSign;
    constexpr double kFactor = 2.0;  // from here on a factor reads better than a percentage
    if (ratio >= kFactor) return fill(text::kTimes, {{"number", short_number(ratio)}});
    if (ratio > 0.0 && ratio <= 1.0 / kFactor) {
      return fill(text::kPart, {{"number", short_number(1.0 / ratio)}});
    }
    char percent[32];
    std::snprintf(percent, sizeof percent, "%+.0f %%", kPercent * (ratio - 1.0));
    return percent;
  }

  /// How much of the radii the bias explains, where the experiment looks at it.
  void write_bias() {
    if (std::none_of(experiment_.columns.begin(), experiment_.columns.end(),
                     [](const ExperimentColumn& c) { return c.metric == kBiasCircle; })) {
      return;
    }
    std::vector<double> shares;
    for (const ReportEntry* entry : entries_) {
      const Spread* radius = find_metric(*entry, kRadius);
      const Spread* circle = find_metric(*entry, kBiasCircle);
      if (radius != nullptr && circle != nullptr && radius->mean > 0.0) {
        shares.push_back(circle->mean / radius->mean);
      }
    }
    const Number low = quantile(shares, 0.25), middle = quantile(shares, 0.5),
                 high = quantile(shares, 0.75);
    if (!low || !middle || !high) return;
    out_ << fill(text::kBiasShare, {{"middle", short_number(*middle)},
                                    {"low", short_number(*low)},
                                    {"high", short_number(*high)}});
  }

  void write_ladder() {
    if (experiment_.ladder.empty() || experiment_.columns.empty()) return;
    const std::string& metric = experiment_.columns.front().metric;
    const std::string title = column_title(experiment_, metric);
    out_ << fill(text::kLadder, {{"quantity", markdown(title)}});
    std::vector<std::string> done;
    for (const ReportEntry* at : entries_) {
      const std::string axes = axes_text(experiment_, *at->first);
      if (std::find(done.begin(), done.end(), axes) != done.end()) continue;
      done.push_back(axes);
      write_rungs(at->first->levels, axes, metric);
    }
  }

  void write_rungs(const std::vector<std::size_t>& levels, const std::string& axes,
                   const std::string& metric) {
    const Spread* before = nullptr;
    std::vector<std::string> rungs;
    std::string verdict = report_words::kHolds;
    bool complete = true;
    for (const std::string& label : experiment_.ladder) {
      const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const ReportEntry* e) {
        return e->row->label == label && e->first->levels == levels;
      });
      const Spread* rung = entry == entries_.end() ? nullptr : find_metric(**entry, metric);
      rungs.push_back(markdown(label) + " " + (rung != nullptr ? with_spread(*rung) : text::kFell));
      complete = complete && rung != nullptr;
      if (before != nullptr && rung != nullptr && rung->mean >= before->mean &&
          verdict == report_words::kHolds) {
        verdict = fill(text::kDoesNotHold, {{"row", markdown(label)}});
      }
      if (rung != nullptr) before = rung;
    }
    out_ << fill(text::kRungs, {{"place", axes.empty() ? text::kEveryPlace : markdown(axes)},
                                {"rungs", joined_by(" -> ", rungs)},
                                {"verdict", complete ? verdict : text::kIncomplete}});
  }

  void write_bounds() {
    if (experiment_.bounds.empty()) return;
    std::size_t held = 0;
    std::string table;
    const std::vector<BoundCheck> checks = report_.check_bounds();
    for (const BoundCheck& check : checks) {
      const Spread* spread = find_metric(*check.entry, check.bound->metric);
      const bool holds = check.missed.empty();
      table += fill(text::kBound,
                    {{"place", place(*check.entry)},
                     {"quantity", markdown(column_title(experiment_, check.bound->metric))},
                     {"allowed", allowed(check)},
                     {"measured", spread != nullptr ? with_spread(*spread) : text::kAbsent},
                     {"verdict", holds ? report_words::kHolds
                                       : fill(text::kMissed, {{"why", markdown(check.missed)}})}});
      held += holds ? 1 : 0;
    }
    out_ << fill(text::kAcceptance,
                 {{"held", std::to_string(held)}, {"bounds", std::to_string(checks.size())}})
         << table;
  }

  static std::string allowed(const BoundCheck& check) {
    const ExperimentBound& bound = *check.bound;
    std::vector<std::string> limits;
    if (bound.min) limits.push_back(fill(text::kMin, {{"min", short_number(*bound.min)}}));
    if (check.max) limits.push_back(fill(text::kMax, {{"max", short_number(*check.max)}}));
    const std::string all = joined_by(", ", limits);
    if (bound.relative_to.empty()) return all;
    return all +
           fill(text::kShare,
                {{"base", bound.max ? fill(text::kBase, {{"max", short_number(*bound.max)}}) : ""},
                 {"share", short_number(bound.share)},
                 {"row", markdown(bound.relative_to)}});
  }

  const Report& report_;
  const Experiment& experiment_;
  std::vector<const ReportEntry*> entries_;    ///< of the profile at hand
  std::vector<const ReportContext*> columns_;  ///< that differ between them
  std::ostringstream out_;
};

}  // namespace

std::string Report::markdown() const { return MarkdownWriter(*this).write(); }

}  // namespace pirouette
