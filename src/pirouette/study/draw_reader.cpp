#include "pirouette/study/draw_reader.hpp"

#include <algorithm>

namespace pirouette {
namespace {

constexpr const char* kAllowed =
    "a table {uniform = [MIN, MAX]}, with either_sign = true or text = \"...{}...\" where wanted, "
    "or {choice = [VALUES]}";

bool is_draw(const toml::table& table) {
  return table.contains("uniform") || table.contains("choice");
}

class DrawReader {
 public:
  explicit DrawReader(const TableReader& reader) : reader_(reader) {}

  /// Everything below `table`, whose own key is `path`.
  void read(const toml::table& table, const std::string& prefix, const std::string& path) {
    for (const auto& [name, node] : table) {
      const std::string key = path + std::string(name.str());
      const toml::table* below = node.as_table();
      if (below == nullptr || below->empty()) {
        reader_.report(node, prefix + key, "given " + shown(node) + "; allowed: " + kAllowed);
      } else if (is_draw(*below)) {
        read_draw(*below, prefix, key);
      } else {
        read(*below, prefix, key + ".");
      }
    }
  }

  std::vector<ExperimentDraw> draws;

 private:
  void read_draw(const toml::table& table, const std::string& prefix, const std::string& key) {
    const std::string here = prefix + key;
    reader_.allow_keys(table, here + ".", {"uniform", "choice", "either_sign", "text"});
    ExperimentDraw draw;
    draw.key = key;
    draw.line = line_of(table);
    if (key == "run.seed") {
      reader_.report(table, here, "is drawn for every trial anyway");
    } else if (table.contains("choice")) {
      read_choice(table, here, draw);
    } else {
      read_uniform(table, here, draw);
    }
    draws.push_back(std::move(draw));
  }

  void read_choice(const toml::table& table, const std::string& key, ExperimentDraw& draw) {
    const toml::array* list = table.get("choice")->as_array();
    if (list == nullptr || list->empty() || table.size() > 1) {
      reader_.report(table, key, std::string("allowed: ") + kAllowed);
      return;
    }
    for (const toml::node& value : *list) draw.values.push_back(shown(value));
  }

  void read_uniform(const toml::table& table, const std::string& key, ExperimentDraw& draw) {
    const toml::node& node = *table.get("uniform");
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() != 2) {
      reader_.report(node, key, "given " + shown(node) + "; allowed: [MIN, MAX]");
      return;
    }
    draw.min = reader_.number((*list)[0], key + ".uniform").value_or(0.0);
    draw.max = reader_.number((*list)[1], key + ".uniform").value_or(draw.min);
    if (draw.min > draw.max) {
      reader_.report(node, key, "given " + shown(node) + "; allowed: MIN up to MAX");
    }
    draw.text = reader_.text(table, key + ".", "text").value_or("");
    if (!draw.text.empty() && draw.text.find("{}") == std::string::npos) {
      reader_.report(table, key + ".text",
                     "given " + shown(*table.get("text")) + "; allowed: a text with {} in it");
      draw.text.clear();
    }
    const toml::node* either = table.get("either_sign");
    if (either == nullptr) return;
    if (!either->is_boolean()) {
      reader_.report(*either, key + ".either_sign",
                     "given " + shown(*either) + "; allowed: true, false");
    }
    draw.either_sign = either->value_or(false);
  }

  const TableReader& reader_;
};

}  // namespace

std::vector<ExperimentDraw> read_draws(const TableReader& reader, const toml::table& table,
                                       const std::string& prefix) {
  const toml::node* node = table.get("random");
  if (node == nullptr) return {};
  const toml::table* random = node->as_table();
  if (random == nullptr) {
    reader.report(*node, prefix + "random",
                  "given " + shown(*node) + "; allowed: a table of draws");
    return {};
  }
  DrawReader draws(reader);
  draws.read(*random, prefix + "random.", "");
  std::stable_sort(
      draws.draws.begin(), draws.draws.end(),
      [](const ExperimentDraw& a, const ExperimentDraw& b) { return a.line < b.line; });
  return std::move(draws.draws);
}

}  // namespace pirouette
