#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <sstream>

#include "pirouette/base/version.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/metrics/statistics.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/report/report_format.hpp"

namespace pirouette {
namespace {

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
    out_ << "# " << markdown(experiment_.title) << "\n\n";
    out_ << "pirouette " << version() << " (" << commit() << "), MuJoCo " << physics_version()
         << ". Mean ± standard deviation over " << experiment_.seeds.size()
         << (experiment_.seeds.size() == 1 ? " seed" : " seeds");
    if (!experiment_.source.empty()) out_ << "; printed: " << markdown(experiment_.source);
    out_ << ".\n";
    if (!experiment_.note.empty()) out_ << "\n" << without_html(experiment_.note) << "\n";
    for (const std::string& profile : profiles()) write_profile(profile);
    write_bounds();
    return out_.str();
  }

 private:
  std::vector<std::string> profiles() const {
    std::vector<std::string> names;
    for (const ReportEntry& entry : report_.entries) {
      const std::string& name = entry.first->config.profile;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
  }

  void write_profile(const std::string& profile) {
    entries_.clear();
    for (const ReportEntry& entry : report_.entries) {
      if (entry.first->config.profile == profile) entries_.push_back(&entry);
    }
    out_ << "\n## Plant: " << markdown(profile) << "\n\n";
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
      return context.text(entry->first->config) != context.text(entries_.front()->first->config);
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
    std::string common;
    for (const ReportContext& context : report_contexts()) {
      if (varies(context)) {
        columns_.push_back(&context);
        continue;
      }
      common += (common.empty() ? "" : "; ") + without_unit(context.title) + " " +
                markdown(context.text(entries_.front()->first->config)) + unit_of(context.title);
    }
    if (!common.empty()) out_ << "Everywhere: " << common << ".\n\n";
  }

  void write_table() {
    write_contexts();
    std::string head = "| row |";
    std::string rule = "|---|";
    const auto add = [&](const std::string& title) {
      head += " " + markdown(title) + " |";
      rule += "---|";
    };
    for (const ReportContext* context : columns_) add(context->title);
    for (const std::size_t axis : extra_axes()) add(experiment_.axes[axis].key);
    add("falls");
    for (const ExperimentColumn& column : experiment_.columns) {
      add(column.title);
      if (is_printed(column.metric)) add("printed");
    }
    out_ << head << "\n" << rule << "\n";
    for (const ReportEntry* entry : entries_) write_line(*entry);
  }

  void write_line(const ReportEntry& entry) {
    out_ << "| " << markdown(entry.row->label) << " |";
    for (const ReportContext* context : columns_) {
      out_ << " " << markdown(context->text(entry.first->config)) << " |";
    }
    for (const std::size_t axis : extra_axes()) {
      out_ << " " << markdown(experiment_.axes[axis].values[entry.first->levels[axis]]) << " |";
    }
    out_ << " " << entry.falls << " of " << entry.trials << " |";
    for (const ExperimentColumn& column : experiment_.columns) {
      const Spread* spread = find_metric(entry, column.metric);
      out_ << " " << (spread != nullptr ? with_spread(*spread) : "-") << " |";
      if (!is_printed(column.metric)) continue;
      const double* printed = find_printed(entry, column.metric);
      out_ << " " << (printed != nullptr ? short_number(*printed) : "") << " |";
    }
    out_ << "\n";
  }

  void write_falls() {
    std::string falls;
    for (const ReportEntry* entry : entries_) {
      if (entry->falls == 0) continue;
      falls += "- " + place(*entry) + ": " + std::to_string(entry->falls) + " of " +
               std::to_string(entry->trials);
      const Spread* time = find_metric(*entry, kFallTime);
      if (time != nullptr) falls += ", after " + with_spread(*time) + " s";
      falls += "\n";
    }
    out_ << (falls.empty() ? "\nNo trial fell.\n" : "\nFalls:\n\n" + falls);
  }

  void write_comparison() {
    if (std::none_of(entries_.begin(), entries_.end(),
                     [](const ReportEntry* entry) { return entry->printed != nullptr; })) {
      return;
    }
    out_ << "\nAgainst the printed figures:\n\n";
    for (const ReportEntry* entry : entries_) {
      if (entry->printed != nullptr) write_difference(*entry);
    }
  }

  void write_difference(const ReportEntry& entry) {
    out_ << "- " << place(entry) << ": ";
    if (entry.falls == entry.trials) {
      out_ << "every trial fell.\n";
      return;
    }
    const char* separator = "";
    for (const ExperimentColumn& column : experiment_.columns) {
      const double* printed = find_printed(entry, column.metric);
      const Spread* ours = find_metric(entry, column.metric);
      if (printed == nullptr || ours == nullptr) continue;
      out_ << separator << markdown(without_unit(column.title)) << " " << short_number(ours->mean)
           << " vs " << short_number(*printed) << markdown(unit_of(column.title)) << " ("
           << difference(ours->mean, *printed) << ")";
      separator = "; ";
    }
    const Spread* bias = find_metric(entry, kBias);
    const Spread* circle = find_metric(entry, kBiasCircle);
    const Spread* drift = find_metric(entry, kDrift);
    const Spread* odometry = find_metric(entry, kOdometry);
    if (bias != nullptr && circle != nullptr && odometry != nullptr) {
      out_ << ". Body-frame bias " << short_number(bias->mean) << " mm/s, which draws a circle of "
           << short_number(circle->mean) << " mm; position estimate off by "
           << short_number(odometry->mean) << " mm";
    }
    if (drift != nullptr) out_ << "; drift " << short_number(drift->mean) << " mm per turn";
    out_ << ".\n";
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
    out_ << "\nThe source does not say which " << markdown(among.key)
         << " its figures hold for: " << markdown(joined(among.values))
         << ". How far ours is from them, as a factor (geometric mean over what is printed):\n\n";
    std::set<std::string> papers;
    for (const ReportEntry* entry : entries_) {
      if (entry->printed != nullptr && entry->printed->among == among) {
        papers.insert(entry->printed->row);
      }
    }
    for (const std::string& paper : papers) write_factors(among, paper, paper);
    if (papers.size() > 1) write_factors(among, "", "all together");
  }

  void write_factors(const ExperimentAxis& among, const std::string& paper,
                     const std::string& title) {
    std::string list, nearest;
    Number least;
    for (const std::string& value : among.values) {
      const Number off = factor_off(among, value, paper);
      list +=
          (list.empty() ? "" : ", ") + markdown(value) + " " + (off ? short_number(*off) : "fell");
      if (!off || (least && *off >= *least)) continue;
      least = off;
      nearest = markdown(value);
    }
    out_ << "- " << markdown(title) << ": "
         << (nearest.empty() ? "nothing to compare" : "nearest is " + nearest) << " (" << list
         << ").\n";
  }

  static std::string difference(double ours, double printed) {
    if (printed == 0.0) return short_number(ours - printed) + " more";
    const double ratio = ours / printed;
    if (ratio < 0.0) return "opposite sign";
    constexpr double kFactor = 2.0;  // from here on a factor reads better than a percentage
    if (ratio >= kFactor) return short_number(ratio) + " times";
    if (ratio > 0.0 && ratio <= 1.0 / kFactor) return "1/" + short_number(1.0 / ratio);
    char text[32];
    std::snprintf(text, sizeof text, "%+.0f %%", kPercent * (ratio - 1.0));
    return text;
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
    out_ << "\nThe circle that the body-frame bias draws (bias / yaw rate) is "
         << short_number(*middle)
         << " of the radius measured in the median over these rows (quartiles "
         << short_number(*low) << " and " << short_number(*high) << ").\n";
  }

  void write_ladder() {
    if (experiment_.ladder.empty() || experiment_.columns.empty()) return;
    const std::string& metric = experiment_.columns.front().metric;
    const std::string title = column_title(experiment_, metric);
    out_ << "\nThe ladder, " << markdown(title)
         << " (each step should be smaller than the one before):\n\n";
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
    out_ << "- " << (axes.empty() ? "everywhere" : markdown(axes)) << ": ";
    const Spread* before = nullptr;
    std::string broken;
    bool complete = true;
    for (const std::string& label : experiment_.ladder) {
      const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const ReportEntry* e) {
        return e->row->label == label && e->first->levels == levels;
      });
      const Spread* rung = entry == entries_.end() ? nullptr : find_metric(**entry, metric);
      out_ << (label == experiment_.ladder.front() ? "" : " -> ") << markdown(label) << " "
           << (rung != nullptr ? with_spread(*rung) : "fell");
      complete = complete && rung != nullptr;
      if (before != nullptr && rung != nullptr && rung->mean >= before->mean && broken.empty()) {
        broken = markdown(label);
      }
      if (rung != nullptr) before = rung;
    }
    if (!complete) {
      out_ << ": incomplete.\n";
    } else {
      out_ << (broken.empty() ? ": holds.\n" : ": does not hold, " + broken + " is no better.\n");
    }
  }

  void write_bounds() {
    if (experiment_.bounds.empty()) return;
    std::size_t held = 0;
    std::ostringstream table;
    const std::vector<BoundCheck> checks = report_.check_bounds();
    for (const BoundCheck& check : checks) {
      const Spread* spread = find_metric(*check.entry, check.bound->metric);
      table << "| " << place(*check.entry) << " | "
            << markdown(column_title(experiment_, check.bound->metric)) << " | " << allowed(check)
            << " | " << (spread != nullptr ? with_spread(*spread) : "-") << " | "
            << (check.missed.empty() ? "holds" : "**missed**: " + markdown(check.missed)) << " |\n";
      held += check.missed.empty() ? 1 : 0;
    }
    out_ << "\n## Acceptance: " << held << " of " << checks.size() << " bounds hold\n\n"
         << "| row | quantity | allowed | measured | |\n|---|---|---|---|---|\n"
         << table.str();
  }

  static std::string allowed(const BoundCheck& check) {
    const ExperimentBound& bound = *check.bound;
    std::string text;
    if (bound.min) text = ">= " + short_number(*bound.min);
    if (check.max) text += (text.empty() ? "" : ", ") + ("<= " + short_number(*check.max));
    if (bound.relative_to.empty()) return text;
    return text + " (" + (bound.max ? short_number(*bound.max) + " + " : "") +
           short_number(bound.share) + " of " + markdown(bound.relative_to) + ")";
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
