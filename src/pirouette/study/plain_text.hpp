// Texts that can stand in a line of a report and on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace pirouette {

/// Whether `text` is valid UTF-8.
bool is_utf8(std::string_view text);

/// Whether the UTF-8 text `text` has a control character (U+0000 to U+001F, U+007F to U+009F) that
/// is not in `but`.
bool has_control_character(std::string_view text, std::string_view but = "");

/// `text` with each byte of a control character, and each that is no UTF-8, as \xHH.
std::string visible(std::string_view text);

}  // namespace pirouette
