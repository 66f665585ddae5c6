#include "pirouette/report/report_format.hpp"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>

#include "pirouette/config/config.hpp"
#include "pirouette/config/config_doc.hpp"

namespace pirouette {
namespace {

constexpr const char* kTorsionalFriction = "plant.torsional_friction";

std::string duty_text(const Config& c) {
  const std::string duty = toml_literal(c.gait.duty);
  const bool adapts = c.gait.adapt && c.gait.step_duty > c.gait.duty && c.plant.terrain != "flat";
  return adapts ? duty + ", on steps " + toml_literal(c.gait.step_duty) : duty;
}

const ReportContext kContexts[] = {
    {"terrain", "plant.terrain", [](const Config& c) { return c.plant.terrain; }},
    {"torsional friction, m", kTorsionalFriction,
     [](const Config& c) { return toml_literal(c.plant.torsional_friction); }},
    {"yaw rate, rad/s", "run.rate", [](const Config& c) { return toml_literal(c.run.rate); }},
    {"turns", "run.turns", [](const Config& c) { return toml_literal(c.run.turns); }},
    {"duty", "gait.duty", duty_text},
    {"foot", "foot.model", [](const Config& c) { return std::string(enum_name(c.foot.model)); }},
    {"reference", "path.reference",
     [](const Config& c) { return std::string(enum_name(c.path.reference)); }},
    {"tracker", "path.tracker",
     [](const Config& c) { return std::string(enum_name(c.path.tracker)); }},
    {"estimator", "estimation.source",
     [](const Config& c) { return std::string(enum_name(c.estimation.source)); }},
};

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0; }

/// Whether the character at `i` means something in Markdown: an underscore within a word and a
/// bracket without a link do not.
bool is_markup(const std::string& text, std::size_t i) {
  const auto is_word_at = [&](std::size_t at) { return at < text.size() && is_word(text[at]); };
  if (text[i] == '_') return i == 0 || !is_word_at(i - 1) || !is_word_at(i + 1);
  if (text[i] == ']') return i + 1 < text.size() && (text[i + 1] == '(' || text[i + 1] == '[');
  const bool before_space = i + 1 < text.size() && text[i + 1] == ' ';
  if (i == 0 && (text[i] == '-' || text[i] == '+')) return before_space;
  if (i == 0 && (text[i] == '#' || text[i] == '>')) return true;
  return std::string_view("\\`*|~").find(text[i]) != std::string_view::npos;
}

}  // namespace

std::span<const ReportContext> report_contexts() { return kContexts; }

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string markdown(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      if (is_markup(text, i)) out += '\\';
      out += c;
    }
  }
  return out;
}

std::string without_html(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : std::string(1, c);
  return out;
}

std::string csv_cell(double value) { return nlohmann::json(value).dump(); }

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) >= 1000.0 ? "%.0f" : "%.3g", value);
  return text;
}

std::string with_spread(const Spread& s) {
  if (s.count < 2) return short_number(s.mean);
  char deviation[32];
  std::snprintf(deviation, sizeof deviation, "%.2g", s.deviation);
  return short_number(s.mean) + " ± " + deviation;
}

const Spread* find_metric(const ReportEntry& entry, const std::string& metric) {
  const auto found = entry.metrics.find(metric);
  return found == entry.metrics.end() ? nullptr : &found->second;
}

const double* find_printed(const ReportEntry& entry, const std::string& metric) {
  if (entry.printed == nullptr) return nullptr;
  const auto found = entry.printed->metrics.find(metric);
  return found == entry.printed->metrics.end() ? nullptr : &found->second;
}

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

}  // namespace pirouette
