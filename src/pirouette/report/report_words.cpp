#include "pirouette/report/report_words.hpp"

#include <algorithm>

namespace pirouette {

std::string fill(std::string_view text,
                 std::initializer_list<std::pair<std::string_view, std::string>> values) {
  std::string out;
  while (!text.empty()) {
    const std::size_t open = std::min(text.find('{'), text.size());
    out += text.substr(0, open);
    text.remove_prefix(open);
    const std::size_t close = text.find('}');
    if (close == text.npos) break;
    const auto found = std::find_if(values.begin(), values.end(), [&](const auto& value) {
      return value.first == text.substr(1, close - 1);
    });
    out += found != values.end() ? std::string_view(found->second) : text.substr(0, close + 1);
    text.remove_prefix(close + 1);
  }
  return out.append(text);
}

}  // namespace pirouette
