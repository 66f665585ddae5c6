#include "pirouette/study/results_line.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "pirouette/base/fingerprint.hpp"
#include "pirouette/config/suggest.hpp"

namespace pirouette {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kCheck = ",\"check\":\"";
constexpr std::string_view kEnd = "\"}";
constexpr const char* kFell = "fell";
constexpr const char* kFallTime = "fall_time_s";

std::string checksum(std::string_view text) {
  Fingerprint fingerprint;
  fingerprint.add(text);
  return fingerprint.hex();
}

Error wrong(std::string key, std::string message) {
  return {"", 0, std::move(key), std::move(message)};
}

/// The line without its checksum, which fits.
Result<std::string> checked_text(std::string_view line) {
  if (!line.starts_with('{') || !line.ends_with('}')) return wrong("", "is no whole line of JSON");
  const std::size_t at = line.rfind(kCheck);
  if (at == line.npos) return wrong("", "has no checksum, as lines of older versions");
  const std::string text = std::string(line.substr(0, at)) + "}";
  const std::string_view found = line.substr(at + kCheck.size());
  if (found == checksum(text) + std::string(kEnd)) return text;
  return wrong("", "is damaged or edited: its checksum does not fit");
}

/// The text `name` of `entry`; empty when there is none.
std::string text_of(const Json& entry, const char* name) {
  const auto found = entry.find(name);
  return found != entry.end() && found->is_string() ? found->get<std::string>() : "";
}

std::string shown_range(const MetricRange& range) {
  if (range.is_bool) return "0 or 1";
  return range.is_size ? "a finite number from 0 on" : "a finite number";
}

Result<Number> metric_value(const std::string& name, const Json& value) {
  const MetricRange range = metric_range(name);
  if (value.is_null() && !range.is_bool) return Number();
  if (value.is_number() && range.holds(value.get<double>())) return Number(value.get<double>());
  return wrong(name, "given " + value.dump() + "; allowed: " + shown_range(range) +
                         (range.is_bool ? "" : ", or null"));
}

Result<MetricValues> metrics_of(const Json& metrics) {
  MetricValues values;
  for (const std::string& name : metric_names()) {
    const auto found = metrics.find(name);
    if (found == metrics.end()) return wrong(name, "missing");
    const Result<Number> value = metric_value(name, *found);
    if (!value) return value.errors();
    values[name] = value.value();
  }
  for (const auto& [name, value] : metrics.items()) {
    if (!values.contains(name)) return wrong(name, "no such metric");
  }
  if (values.at(kFallTime).has_value() != (values.at(kFell) == 1.0)) {
    return wrong(kFallTime, "given " + metrics[kFallTime].dump() +
                                "; allowed: a time with a fall, null without one");
  }
  return values;
}

}  // namespace

std::string to_text(const ResultsLine& line) {
  Json metrics = Json::object();
  for (const auto& [name, value] : line.values)
    metrics[name] = value ? Json(*value) : Json(nullptr);
  std::string text = Json{
      {"experiment", line.experiment},
      {"row", line.row},
      {"trial", line.key},
      {"metrics",
       metrics}}.dump();
  const std::string check = checksum(text);
  text.pop_back();
  return text.append(kCheck).append(check).append(kEnd);
}

Result<ResultsLine> parse_results_line(std::string_view text) {
  const Result<std::string> checked = checked_text(text);
  if (!checked) return checked.errors();
  const Json entry = Json::parse(checked.value(), nullptr, /*allow_exceptions=*/false);
  if (!entry.is_object()) return wrong("", "is no JSON");
  ResultsLine line{
      text_of(entry, "experiment"), text_of(entry, "row"), text_of(entry, "trial"), {}};
  for (const auto& [name, value] :
       {std::pair("experiment", &line.experiment), {"row", &line.row}, {"trial", &line.key}}) {
    if (value->empty()) return wrong(name, "missing: a text");
  }
  const auto metrics = entry.find("metrics");
  if (metrics == entry.end() || !metrics->is_object()) {
    return wrong("metrics", "missing: a number or null for each metric");
  }
  Result<MetricValues> values = metrics_of(*metrics);
  if (!values) return values.errors();
  line.values = std::move(values).value();
  return line;
}

}  // namespace pirouette
