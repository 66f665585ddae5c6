// A value, or every reason why there is none. Load-time errors travel in it; nothing here throws.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pirouette {

/// One thing wrong with an input: where it is, which key, and what is allowed instead.
struct Error {
  std::string file;     ///< file name, or "--set", "--terrain" ...; may be empty
  int line = 0;         ///< 1-based; 0: no line
  std::string key;      ///< dotted key, such as gait.period; may be empty
  std::string message;  ///< what was given and what is allowed

  /// "file:line: key: message", leaving out what is empty.
  std::string to_string() const {
    std::string out;
    if (!file.empty()) out += file + (line > 0 ? ":" + std::to_string(line) : "") + ": ";
    if (!key.empty()) out += key + ": ";
    return out + message;
  }
};

using Errors = std::vector<Error>;

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}              // NOLINT(google-explicit-constructor)
  Result(Errors errors) : state_(std::move(errors)) {}       // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(Errors{std::move(error)}) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }
  T& value() & { return std::get<T>(state_); }
  const T& value() const& { return std::get<T>(state_); }
  T&& value() && { return std::get<T>(std::move(state_)); }
  const Errors& errors() const { return std::get<Errors>(state_); }

 private:
  std::variant<T, Errors> state_;
};

}  // namespace pirouette
