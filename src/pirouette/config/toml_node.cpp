#include "pirouette/config/toml_node.hpp"

#include <sstream>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/suggest.hpp"

namespace pirouette {

std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const auto* text = node.as_string()) return in_quotes(text->get());
  if (const auto* number = node.as_floating_point()) return toml_literal(number->get());
  std::ostringstream text;
  if (const toml::array* list = node.as_array()) {
    for (const toml::node& element : *list)
      text << (text.str().empty() ? "" : ", ") << shown(element);
    return "[" + text.str() + "]";
  }
  text << toml::toml_formatter{node};
  return text.str();
}

std::optional<toml::table> parse_toml_file(const std::filesystem::path& path, Errors& errors) {
  if (!std::filesystem::is_regular_file(path)) {
    errors.push_back({path.string(), 0, "", "no such file"});
    return std::nullopt;
  }
  toml::parse_result result = toml::parse_file(path.string());
  if (result) return std::move(result).table();
  const toml::parse_error& error = result.error();
  errors.push_back({path.string(), static_cast<int>(error.source().begin.line), "",
                    std::string(error.description())});
  return std::nullopt;
}

}  // namespace pirouette
