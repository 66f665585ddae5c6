#include "pirouette/experiment/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/experiment/statistics.hpp"
#include "pirouette/experiment/trial.hpp"
#include "pirouette/plant/plant.hpp"

namespace pirouette {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kBias = "com.body_bias_mm_s";
constexpr const char* kBiasCircle = "com.bias_circle_mm";
constexpr const char* kRadius = "com.radius_mean_mm";
constexpr const char* kFallTime = "fall_time_s";
constexpr const char* kDrift = "com.drift_per_turn_mm";
constexpr const char* kOdometry = "estimator.position_error_mm";
constexpr double kPercent = 100.0;

/// Three significant digits.
std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) >= 1000.0 ? "%.0f" : "%.3g", value);
  return text;
}

std::string exact(double value) { return Json(value).dump(); }

std::string with_spread(const Spread& s) {
  if (s.count < 2) return short_number(s.mean);
  char deviation[32];
  std::snprintf(deviation, sizeof deviation, "%.2g", s.deviation);
  return short_number(s.mean) + " ± " + deviation;
}

const Spread* find(const ReportEntry& entry, const std::string& metric) {
  const auto found = entry.metrics.find(metric);
  return found == entry.metrics.end() ? nullptr : &found->second;
}

const double* find_printed(const ReportEntry& entry, const std::string& metric) {
  if (entry.printed == nullptr) return nullptr;
  const auto found = entry.printed->metrics.find(metric);
  return found == entry.printed->metrics.end() ? nullptr : &found->second;
}

/// What a reader must know to compare a number; the same for every table.
struct Context {
  const char* title;
  std::string (*text)(const Config&);
};
const Context kContexts[] = {
    {"torsional friction, m",
     [](const Config& c) { return toml_literal(c.plant.torsional_friction); }},
    {"duty", [](const Config& c) { return toml_literal(c.gait.duty); }},
    {"foot", [](const Config& c) { return std::string(enum_name(c.foot.model)); }},
    {"reference", [](const Config& c) { return std::string(enum_name(c.path.reference)); }},
    {"tracker", [](const Config& c) { return std::string(enum_name(c.path.tracker)); }},
    {"estimator", [](const Config& c) { return std::string(enum_name(c.estimation.source)); }},
};

constexpr const char* kTorsionalFriction = "plant.torsional_friction";

/// "plant.friction 0.4, com.planner psp": the axes' values, without the profile.
std::string axes_text(const Experiment& experiment, const ExperimentTrial& trial) {
  std::string text;
  for (std::size_t axis = 0; axis < experiment.axes.size(); ++axis) {
    const ExperimentAxis& a = experiment.axes[axis];
    if (a.key == "profile") continue;
    const std::string key = a.key == kTorsionalFriction ? "torsional friction" : a.key;
    text += (text.empty() ? "" : ", ") + key + " " + a.values[trial.levels[axis]];
  }
  return text;
}

std::string place_text(const Experiment& experiment, const ReportEntry& entry) {
  const std::string axes = axes_text(experiment, *entry.first);
  return entry.row->label + (axes.empty() ? "" : ", " + axes);
}

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
    out_ << "# " << experiment_.title << "\n\n";
    out_ << "pirouette " << version() << " (" << commit() << "), MuJoCo " << physics_version()
         << ". Mean ± standard deviation over " << experiment_.seeds.size()
         << (experiment_.seeds.size() == 1 ? " seed" : " seeds");
    if (!experiment_.source.empty()) out_ << "; printed: " << experiment_.source;
    out_ << ".\n";
    for (const std::string& profile : profiles()) write_profile(profile);
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
    out_ << "\n## Plant: " << profile << "\n\n";
    write_table();
    write_falls();
    write_comparison();
    write_bias();
    write_ladder();
  }

  bool is_printed(const std::string& metric) const {
    return std::any_of(entries_.begin(), entries_.end(), [&](const ReportEntry* entry) {
      return find_printed(*entry, metric) != nullptr;
    });
  }

  /// Axes other than those that a context column shows anyway.
  std::vector<std::size_t> extra_axes() const {
    std::vector<std::size_t> axes;
    for (std::size_t i = 0; i < experiment_.axes.size(); ++i) {
      const std::string& key = experiment_.axes[i].key;
      if (key != "profile" && key != kTorsionalFriction) axes.push_back(i);
    }
    return axes;
  }

  void write_table() {
    std::string head = "| row |";
    std::string rule = "|---|";
    const auto add = [&](const std::string& title) {
      head += " " + title + " |";
      rule += "---|";
    };
    for (const Context& context : kContexts) add(context.title);
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
    out_ << "| " << entry.row->label << " |";
    for (const Context& context : kContexts) {
      out_ << " " << context.text(entry.first->config) << " |";
    }
    for (const std::size_t axis : extra_axes()) {
      out_ << " " << experiment_.axes[axis].values[entry.first->levels[axis]] << " |";
    }
    out_ << " " << entry.falls << " of " << entry.trials << " |";
    for (const ExperimentColumn& column : experiment_.columns) {
      const Spread* spread = find(entry, column.metric);
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
      falls += "- " + place_text(experiment_, *entry) + ": " + std::to_string(entry->falls) +
               " of " + std::to_string(entry->trials);
      const Spread* time = find(*entry, kFallTime);
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
    out_ << "- " << place_text(experiment_, entry) << ": ";
    if (entry.falls == entry.trials) {
      out_ << "every trial fell.\n";
      return;
    }
    const char* separator = "";
    for (const ExperimentColumn& column : experiment_.columns) {
      const double* printed = find_printed(entry, column.metric);
      const Spread* ours = find(entry, column.metric);
      if (printed == nullptr || ours == nullptr) continue;
      out_ << separator << without_unit(column.title) << " " << short_number(ours->mean) << " vs "
           << short_number(*printed) << unit_of(column.title) << " ("
           << difference(ours->mean, *printed) << ")";
      separator = "; ";
    }
    const Spread* bias = find(entry, kBias);
    const Spread* circle = find(entry, kBiasCircle);
    const Spread* drift = find(entry, kDrift);
    const Spread* odometry = find(entry, kOdometry);
    if (bias != nullptr && circle != nullptr && odometry != nullptr) {
      out_ << ". Body-frame bias " << short_number(bias->mean) << " mm/s, which draws a circle of "
           << short_number(circle->mean) << " mm; position estimate off by "
           << short_number(odometry->mean) << " mm";
    }
    if (drift != nullptr) out_ << "; drift " << short_number(drift->mean) << " mm per turn";
    out_ << ".\n";
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

  /// How much of the radii the bias explains.
  void write_bias() {
    std::vector<double> shares;
    for (const ReportEntry* entry : entries_) {
      const Spread* radius = find(*entry, kRadius);
      const Spread* circle = find(*entry, kBiasCircle);
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
    out_ << "\nThe ladder, " << title << " (each step should be smaller than the one before):\n\n";
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
    out_ << "- " << (axes.empty() ? "everywhere" : axes) << ": ";
    const Spread* before = nullptr;
    std::string broken;
    bool complete = true;
    for (const std::string& label : experiment_.ladder) {
      const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const ReportEntry* e) {
        return e->row->label == label && e->first->levels == levels;
      });
      const Spread* rung = entry == entries_.end() ? nullptr : find(**entry, metric);
      out_ << (label == experiment_.ladder.front() ? "" : " -> ") << label << " "
           << (rung != nullptr ? with_spread(*rung) : "fell");
      complete = complete && rung != nullptr;
      if (before != nullptr && rung != nullptr && rung->mean >= before->mean && broken.empty()) {
        broken = label;
      }
      if (rung != nullptr) before = rung;
    }
    if (!complete) {
      out_ << ": incomplete.\n";
    } else {
      out_ << (broken.empty() ? ": holds.\n" : ": does not hold, " + broken + " is no better.\n");
    }
  }

  const Report& report_;
  const Experiment& experiment_;
  std::vector<const ReportEntry*> entries_;
  std::ostringstream out_;
};

/// A cell of CSV.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

const PrintedResult* printed_for(const Experiment& experiment, const ExperimentRow& row,
                                 const Config& config) {
  if (row.paper.empty()) return nullptr;
  for (const PrintedResult& printed : experiment.printed) {
    if (printed.row == row.paper && printed.profile == config.profile) return &printed;
  }
  return nullptr;
}

}  // namespace

Report::Report(const Experiment& of, const SweepResult& with) : experiment(&of), result(&with) {
  const std::size_t seeds = of.seeds.size();
  for (std::size_t begin = 0; begin < of.trials.size(); begin += seeds) {
    ReportEntry entry;
    entry.first = &of.trials[begin];
    entry.row = &of.rows[entry.first->row];
    entry.printed = printed_for(of, *entry.row, entry.first->config);
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
        if (value && (!fell || name == kFallTime)) samples[name].push_back(*value);
      }
    }
    for (const auto& [name, x] : samples) {
      entry.metrics[name] = {mean(x).value_or(0.0), std::sqrt(variance(x).value_or(0.0)), x.size()};
    }
    entries.push_back(std::move(entry));
  }
}

std::string Report::markdown() const { return MarkdownWriter(*this).write(); }

std::string Report::json() const {
  Json root;
  root["experiment"] = experiment->name;
  root["title"] = experiment->title;
  root["source"] = experiment->source;
  root["version"] = version();
  root["commit"] = commit();
  root["mujoco"] = physics_version();
  root["seeds"] = experiment->seeds;
  root["ladder"] = experiment->ladder;
  root["columns"] = Json::array();
  for (const ExperimentColumn& column : experiment->columns) {
    root["columns"].push_back({{"metric", column.metric}, {"title", column.title}});
  }
  root["entries"] = Json::array();
  for (const ReportEntry& entry : entries) {
    const Config& config = entry.first->config;
    Json out;
    out["label"] = entry.row->label;
    out["paper"] = entry.row->paper;
    out["controller"] = config.controller;
    out["profile"] = config.profile;
    out["torsional_friction"] = config.plant.torsional_friction;
    out["duty"] = config.gait.duty;
    out["foot_model"] = enum_name(config.foot.model);
    out["reference"] = enum_name(config.path.reference);
    out["tracker"] = enum_name(config.path.tracker);
    out["com_planner"] = enum_name(config.com.planner);
    out["estimator"] = enum_name(config.estimation.source);
    out["yaw_rate"] = config.run.rate;
    out["record_start_s"] = config.gait.stand_time + config.run.settle_time;
    out["axes"] = Json::object();
    for (std::size_t axis = 0; axis < experiment->axes.size(); ++axis) {
      const ExperimentAxis& a = experiment->axes[axis];
      out["axes"][a.key] = a.values[entry.first->levels[axis]];
    }
    out["trials"] = entry.trials;
    out["falls"] = entry.falls;
    out["metrics"] = Json::object();
    for (const auto& [name, s] : entry.metrics) {
      out["metrics"][name] = {{"mean", s.mean}, {"deviation", s.deviation}, {"count", s.count}};
    }
    out["printed"] = entry.printed != nullptr ? Json(entry.printed->metrics) : Json(nullptr);
    out["trace"] = entry.trace.empty() ? Json(nullptr) : Json(entry.trace);
    root["entries"].push_back(std::move(out));
  }
  root["missed_bounds"] = missed_bounds();
  constexpr int kIndent = 1;
  return root.dump(kIndent) + "\n";
}

std::string Report::csv() const {
  std::ostringstream out;
  out << "row,profile";
  for (const Context& context : kContexts) out << "," << quoted(context.title);
  for (const ExperimentAxis& axis : experiment->axes) out << "," << quoted(axis.key);
  out << ",trials,falls";
  for (const ExperimentColumn& column : experiment->columns) {
    out << "," << column.metric << "," << column.metric << ".deviation," << column.metric
        << ".printed";
  }
  out << "\n";
  for (const ReportEntry& entry : entries) {
    const Config& config = entry.first->config;
    out << quoted(entry.row->label) << "," << config.profile;
    for (const Context& context : kContexts) out << "," << context.text(config);
    for (std::size_t axis = 0; axis < experiment->axes.size(); ++axis) {
      out << "," << quoted(experiment->axes[axis].values[entry.first->levels[axis]]);
    }
    out << "," << entry.trials << "," << entry.falls;
    for (const ExperimentColumn& column : experiment->columns) {
      const Spread* spread = find(entry, column.metric);
      const double* printed = find_printed(entry, column.metric);
      out << "," << (spread != nullptr ? exact(spread->mean) : "") << ","
          << (spread != nullptr ? exact(spread->deviation) : "") << ","
          << (printed != nullptr ? exact(*printed) : "");
    }
    out << "\n";
  }
  return out.str();
}

std::string Report::trials_csv() const {
  const std::vector<std::string> names = metric_names();
  std::ostringstream out;
  out << "trial,key,row";
  for (const ExperimentAxis& axis : experiment->axes) out << "," << quoted(axis.key);
  out << ",seed";
  for (const std::string& name : names) out << "," << name;
  out << "\n";
  for (std::size_t i = 0; i < experiment->trials.size(); ++i) {
    const ExperimentTrial& trial = experiment->trials[i];
    out << i << "," << result->keys[i] << "," << quoted(experiment->rows[trial.row].label);
    for (std::size_t axis = 0; axis < experiment->axes.size(); ++axis) {
      out << "," << quoted(experiment->axes[axis].values[trial.levels[axis]]);
    }
    out << "," << trial.seed;
    for (const std::string& name : names) {
      const auto found = result->values[i].find(name);
      const bool known = found != result->values[i].end() && found->second;
      out << "," << (known ? exact(*found->second) : "");
    }
    out << "\n";
  }
  return out.str();
}

std::vector<std::string> Report::missed_bounds() const {
  std::vector<std::string> missed;
  for (const ExperimentBound& bound : experiment->bounds) {
    for (const ReportEntry& entry : entries) {
      if (!bound.row.empty() && bound.row != entry.row->label) continue;
      const std::string place = place_text(*experiment, entry) + " (" +
                                entry.first->config.profile + "): " + bound.metric + " ";
      const Spread* spread = find(entry, bound.metric);
      if (entry.falls > 0 && bound.metric != kFallTime) {
        missed.push_back(place + "counts as missed, " + std::to_string(entry.falls) + " of " +
                         std::to_string(entry.trials) + " trials fell");
      } else if (spread == nullptr) {
        missed.push_back(place + "is absent");
      } else if (bound.min && !(spread->mean >= *bound.min)) {
        missed.push_back(place + short_number(spread->mean) + ", below " +
                         short_number(*bound.min));
      } else if (bound.max && !(spread->mean <= *bound.max)) {
        missed.push_back(place + short_number(spread->mean) + ", above " +
                         short_number(*bound.max));
      }
    }
  }
  return missed;
}

}  // namespace pirouette
