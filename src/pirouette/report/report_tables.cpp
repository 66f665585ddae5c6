#include <nlohmann/json.hpp>
#include <sstream>

#include "pirouette/base/version.hpp"
#include "pirouette/config/config.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/plant/terrain.hpp"
#include "pirouette/report/report_format.hpp"

namespace pirouette {
namespace {

using Json = nlohmann::ordered_json;

/// x, y, z in the world, of the terrain's overall plane.
std::vector<double> ground_normal(const Config& config) {
  const Result<TerrainSpec> spec = parse_terrain(config.plant.terrain);
  if (!spec) return {};  // run_sweep() has refused it
  const Vec3 normal = Terrain(spec.value(), static_cast<std::uint64_t>(config.run.seed)).normal();
  return {normal.x(), normal.y(), normal.z()};
}

}  // namespace

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
    const Config& config = *entry.first->config;
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
    out["terrain"] = config.plant.terrain;
    out["ground_normal"] = ground_normal(config);
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
  for (const ReportContext& context : report_contexts()) out << "," << csv_cell(context.title);
  for (const ExperimentAxis& axis : experiment->axes) out << "," << csv_cell(axis.key);
  out << ",trials,falls";
  for (const ExperimentColumn& column : experiment->columns) {
    out << "," << column.metric << "," << column.metric << ".deviation," << column.metric
        << ".printed";
  }
  out << "\n";
  for (const ReportEntry& entry : entries) {
    const Config& config = *entry.first->config;
    out << csv_cell(entry.row->label) << "," << config.profile;
    for (const ReportContext& context : report_contexts())
      out << "," << csv_cell(context.text(config));
    for (std::size_t axis = 0; axis < experiment->axes.size(); ++axis) {
      out << "," << csv_cell(experiment->axes[axis].values[entry.first->levels[axis]]);
    }
    out << "," << entry.trials << "," << entry.falls;
    for (const ExperimentColumn& column : experiment->columns) {
      const Spread* spread = find_metric(entry, column.metric);
      const double* printed = find_printed(entry, column.metric);
      out << "," << (spread != nullptr ? csv_cell(spread->mean) : "") << ","
          << (spread != nullptr ? csv_cell(spread->deviation) : "") << ","
          << (printed != nullptr ? csv_cell(*printed) : "");
    }
    out << "\n";
  }
  return out.str();
}

}  // namespace pirouette
