// Reader of the tables of an experiment file that collects their errors; for this folder only.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pirouette/config/toml_node.hpp"
#include "pirouette/study/experiment_reader.hpp"

namespace pirouette {

/// Meaning of a list: the value of one parameter, or values of which any will do.
enum class Lists { kValues, kAlternatives };

int line_of(const toml::node& node);

/// An error for every text below `table`, and every key, that holds a control character: reports
/// are tables of one line each, and go to terminals. The text `free` may have line breaks and tabs.
Errors check_texts(const toml::table& table, const std::string& file, const std::string& free);

/// Keys in errors are `prefix` and the name in the table.
class TableReader {
 public:
  TableReader(std::string file, Errors& errors) : file_(std::move(file)), errors_(errors) {}

  void report(const toml::node& node, const std::string& key, std::string message) const;

  void allow_keys(const toml::table& table, const std::string& prefix,
                  const std::vector<std::string>& names) const;

  /// The text `name`; absent when it is missing or not a text, which is an error.
  std::optional<std::string> text(const toml::table& table, const std::string& prefix,
                                  const char* name) const;
  /// The text `name`; missing, it is an error and the result is empty.
  std::string needed_text(const toml::table& table, const std::string& prefix,
                          const char* name) const;
  std::optional<double> number(const toml::node& node, const std::string& key) const;
  /// The whole number `name` in [min, max]; absent when it is missing or another value, which is an
  /// error.
  std::optional<std::int64_t> count(const toml::table& table, const char* name, std::int64_t min,
                                    std::int64_t max) const;

  /// The numbers below `table` with dotted keys.
  void numbers(const toml::table& table, const std::string& prefix,
               std::map<std::string, double>& out) const;
  /// The parameters below the table `name` with dotted keys, in the order of the file.
  std::vector<ExperimentSetting> settings(const toml::table& table, const std::string& prefix,
                                          const char* name, Lists lists = Lists::kValues) const;

  /// Calls `visit` for each table of the array of tables `name`.
  template <class Visit>
  void for_each(const toml::table& table, const char* name, Visit&& visit) const {
    const toml::node* node = table.get(name);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      report(*node, name, std::string("allowed: tables, each headed [[") + name + "]]");
      return;
    }
    for (const toml::node& element : *list) {
      if (const toml::table* entry = element.as_table()) {
        visit(*entry);
      } else {
        report(element, name, "given " + shown(element) + "; allowed: a table");
      }
    }
  }

 private:
  std::string file_;
  Errors& errors_;
};

}  // namespace pirouette
