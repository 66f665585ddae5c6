// Command line that repeats a trial.
#pragma once

#include <string>

namespace pirouette {

struct Config;

/// `text` as one word of a POSIX shell. Control characters become "?".
std::string shell_word(const std::string& text);

/// "pirouette spin --set ...": command line of exactly `config`, with the differences from the
/// defaults of its robot, controller and profile.
std::string repeat_command(const Config& config);

}  // namespace pirouette
