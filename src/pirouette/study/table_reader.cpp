#include "pirouette/study/table_reader.hpp"

#include <algorithm>
#include <cmath>

#include "pirouette/config/suggest.hpp"
#include "pirouette/study/plain_text.hpp"

namespace pirouette {
namespace {

constexpr const char* kText = "a text in quotes";
constexpr std::string_view kLayout = "\n\t\r";

void flatten(const toml::table& table, const std::string& prefix, Lists lists,
             std::vector<ExperimentSetting>& out) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    const toml::array* list = node.as_array();
    if (const toml::table* below = node.as_table()) {
      flatten(*below, path + ".", lists, out);
    } else if (list != nullptr && lists == Lists::kAlternatives) {
      for (const toml::node& value : *list) out.push_back({path, shown(value), line_of(value)});
    } else {
      out.push_back({path, shown(node), line_of(node)});
    }
  }
}

void check_text(const toml::node& node, const std::string& key, const std::string& free,
                const TableReader& reader) {
  if (const toml::table* table = node.as_table()) {
    for (const auto& [name, below] : *table) {
      const std::string path = (key.empty() ? "" : key + ".") + visible(name.str());
      if (has_control_character(name.str())) {
        reader.report(below, path, "a key; allowed: one without control characters");
      }
      check_text(below, path, free, reader);
    }
  } else if (const toml::array* list = node.as_array()) {
    for (const toml::node& element : *list) check_text(element, key, free, reader);
  } else if (const auto* text = node.as_string()) {
    const bool is_free = key == free;
    if (!has_control_character(text->get(), is_free ? kLayout : "")) return;
    reader.report(node, key,
                  "given " + in_quotes(visible(text->get())) +
                      "; allowed: a text without control characters" +
                      (is_free ? " other than line breaks and tabs" : ", on one line"));
  }
}

}  // namespace

Errors check_texts(const toml::table& table, const std::string& file, const std::string& free) {
  Errors errors;
  check_text(table, "", free, TableReader(file, errors));
  return errors;
}

int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

void TableReader::report(const toml::node& node, const std::string& key,
                         std::string message) const {
  errors_.push_back({file_, line_of(node), key, std::move(message)});
}

void TableReader::allow_keys(const toml::table& table, const std::string& prefix,
                             const std::vector<std::string>& names) const {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::optional<std::string> meant = nearest(name, names);
    report(node, prefix + name,
           "unknown key; " +
               (meant ? "did you mean " + *meant + "?" : "allowed here: " + joined(names)));
  }
}

std::optional<std::string> TableReader::text(const toml::table& table, const std::string& prefix,
                                             const char* name) const {
  const toml::node* node = table.get(name);
  if (node == nullptr) return std::nullopt;
  if (node->is_string()) return node->as_string()->get();
  report(*node, prefix + name, "given " + shown(*node) + "; allowed: " + kText);
  return std::nullopt;
}

std::string TableReader::needed_text(const toml::table& table, const std::string& prefix,
                                     const char* name) const {
  if (table.get(name) == nullptr) report(table, prefix + name, std::string("missing: ") + kText);
  return text(table, prefix, name).value_or("");
}

std::optional<double> TableReader::number(const toml::node& node, const std::string& key) const {
  const std::optional<double> value = node.value<double>();
  if (!node.is_boolean() && value && std::isfinite(*value)) return value;
  report(node, key, "given " + shown(node) + "; allowed: a finite number");
  return std::nullopt;
}

std::optional<std::int64_t> TableReader::count(const toml::table& table, const char* name,
                                               std::int64_t min, std::int64_t max) const {
  const toml::node* node = table.get(name);
  if (node == nullptr) return std::nullopt;
  const auto* whole = node->as_integer();
  if (whole != nullptr && whole->get() >= min && whole->get() <= max) return whole->get();
  report(*node, name,
         "given " + shown(*node) + "; allowed: a whole number from " + std::to_string(min) +
             " to " + std::to_string(max));
  return std::nullopt;
}

void TableReader::numbers(const toml::table& table, const std::string& prefix,
                          std::map<std::string, double>& out) const {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (const toml::table* below = node.as_table()) {
      numbers(*below, path + ".", out);
    } else if (const std::optional<double> value = number(node, path)) {
      out[path] = *value;
    }
  }
}

std::vector<ExperimentSetting> TableReader::settings(const toml::table& table,
                                                     const std::string& prefix, const char* name,
                                                     Lists lists) const {
  std::vector<ExperimentSetting> out;
  const toml::node* node = table.get(name);
  if (node == nullptr) return out;
  if (const toml::table* values = node->as_table()) {
    flatten(*values, "", lists, out);
  } else {
    report(*node, prefix + name, "given " + shown(*node) + "; allowed: a table of parameters");
  }
  std::stable_sort(
      out.begin(), out.end(),
      [](const ExperimentSetting& a, const ExperimentSetting& b) { return a.line < b.line; });
  return out;
}

}  // namespace pirouette
