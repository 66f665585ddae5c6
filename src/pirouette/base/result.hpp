// A value or the errors that prevented it, for load-time errors.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace pirouette {

/// One error in an input: where it is, which key, and what is allowed instead.
struct Error {
  std::string file;     ///< file name, or "--set", "--terrain" ...; may be empty
  int line = 0;         ///< 1-based; 0: no line
  std::string key;      ///< dotted key, such as gait.period; may be empty
  std::string message;  ///< what was given and what is allowed

  /// "file:line: key: message", without the empty parts.
  std::string to_string() const {
    std::string out;
    if (!file.empty()) out += file + (line > 0 ? ":" + std::to_string(line) : "") + ": ";
    if (!key.empty()) out += key + ": ";
    return out + message;
  }
};

/// All errors of an input; empty: none.
using Errors = std::vector<Error>;

/// A T, or at least one Error.
template <class T>
class [[nodiscard]] Result {
 public:
  /// Of a value.
  Result(T value) : state_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
  /// Of at least one error.
  Result(Errors errors) : state_(std::move(errors)) {}  // NOLINT(google-explicit-constructor)
  /// Of one error.
  Result(Error error) : state_(Errors{std::move(error)}) {}  // NOLINT(google-explicit-constructor)

  /// True: there is a value.
  bool ok() const { return std::holds_alternative<T>(state_); }
  /// Same as ok().
  explicit operator bool() const { return ok(); }
  /// The value; std::bad_variant_access when there is none.
  T& value() & { return std::get<T>(state_); }
  const T& value() const& { return std::get<T>(state_); }    ///< as above
  T&& value() && { return std::get<T>(std::move(state_)); }  ///< as above
  /// The errors; std::bad_variant_access when there is a value.
  const Errors& errors() const { return std::get<Errors>(state_); }

 private:
  std::variant<T, Errors> state_;
};

}  // namespace pirouette
