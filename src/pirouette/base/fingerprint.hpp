// Hash of texts.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pirouette {

/// FNV-1a hash, 64 bits, of a sequence of texts; the same on every machine.
class Fingerprint {
 public:
  /// Appends `text` to the sequence.
  void add(std::string_view text) {
    for (const char c : text) mix(static_cast<unsigned char>(c));
    mix(kSeparator);
  }

  std::uint64_t value() const { return value_; }  ///< the hash of all texts so far

  /// The hash in 16 hexadecimal digits.
  std::string hex() const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(value_ >> shift) & 0xf];
    return text;
  }

 private:
  static constexpr std::uint64_t kSeparator = 0x100;  // no byte

  void mix(std::uint64_t byte) { value_ = (value_ ^ byte) * 0x100000001b3; }

  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace pirouette
