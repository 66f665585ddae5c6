#include "pirouette/study/plain_text.hpp"

#include <cstddef>
#include <cstdio>

namespace pirouette {
namespace {

struct Character {
  std::size_t length = 1;  ///< bytes
  char32_t code = 0;
  bool valid = false;
};

/// The first character of `text`, which is not empty; one byte when that is no UTF-8.
Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return {1, lead, true};
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return {};
  char32_t code = lead & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return {};
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr char32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};  // of each length
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kSmallest[length] || code > 0x10ffff || surrogate) return {};
  return {length, code, true};
}

bool is_control(const Character& c) {
  return c.valid && (c.code < 0x20 || (c.code >= 0x7f && c.code < 0xa0));
}

/// Calls visit(character, bytes) for each character.
template <class Visit>
void for_each_character(std::string_view text, Visit&& visit) {
  while (!text.empty()) {
    const Character character = first_character(text);
    visit(character, text.substr(0, character.length));
    text.remove_prefix(character.length);
  }
}

}  // namespace

bool is_utf8(std::string_view text) {
  bool valid = true;
  for_each_character(text, [&](const Character& c, std::string_view) { valid = valid && c.valid; });
  return valid;
}

bool has_control_character(std::string_view text, std::string_view but) {
  bool found = false;
  for_each_character(text, [&](const Character& c, std::string_view bytes) {
    found = found || (is_control(c) && but.find(bytes) == but.npos);
  });
  return found;
}

std::string visible(std::string_view text) {
  std::string out;
  for_each_character(text, [&](const Character& c, std::string_view bytes) {
    if (c.valid && !is_control(c)) {
      out += bytes;
      return;
    }
    for (const char byte : bytes) {
      char shown[8];
      std::snprintf(shown, sizeof shown, "\\x%02x", static_cast<unsigned char>(byte));
      out += shown;
    }
  });
  return out;
}

}  // namespace pirouette
