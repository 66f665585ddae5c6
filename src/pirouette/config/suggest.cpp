#include "pirouette/config/suggest.hpp"

#include <algorithm>

namespace pirouette {
namespace {

/// Levenshtein: the least number of insertions, deletions and replacements from `a` to `b`.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replace, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string_view last_part(std::string_view key) { return key.substr(key.rfind('.') + 1); }

}  // namespace

std::optional<std::string> nearest(std::string_view given,
                                   const std::vector<std::string>& candidates) {
  std::size_t best = std::max<std::size_t>(2, given.size() / 4) + 1;
  std::optional<std::string> answer;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = std::min(
        edit_distance(given, candidate), edit_distance(last_part(given), last_part(candidate)) + 1);
    if (distance < best) {
      best = distance;
      answer = candidate;
    }
  }
  return answer;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string in_quotes(std::string_view text) { return "\"" + std::string(text) + "\""; }

std::string without_quotes(const std::string& literal) {
  const bool quoted = literal.size() > 1 && literal.front() == '"';
  return quoted ? literal.substr(1, literal.size() - 2) : literal;
}

std::string unknown_name(std::string_view given, const std::vector<std::string>& known) {
  const std::optional<std::string> meant = nearest(given, known);
  return "given " + in_quotes(given) + "; allowed: " + joined(known) +
         (meant ? "; did you mean " + *meant + "?" : "");
}

}  // namespace pirouette
