#include "pirouette/study/experiment_draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "pirouette/base/fingerprint.hpp"
#include "pirouette/base/random.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/suggest.hpp"

namespace pirouette {
namespace {

constexpr const char* kPlace = "{}";

/// 128 random bits of the parameter `key` in trial `trial`.
std::array<std::uint32_t, 4> random_bits(const std::string& key, std::int64_t seed,
                                         std::int64_t trial) {
  Fingerprint name;
  name.add(key);
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto high = [](std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); };
  const auto number = static_cast<std::uint64_t>(trial);
  const auto of_file = static_cast<std::uint64_t>(seed);
  return philox({low(number), high(number), low(name.value()), high(name.value())},
                {low(of_file), high(of_file)});
}

std::string four_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

std::string ExperimentDraw::to_string() const {
  if (!values.empty()) return joined(values);
  const std::string range = four_digits(min) + " to " + four_digits(max);
  if (!text.empty()) return text + ", " + range;
  return range + (either_sign ? ", either sign" : "");
}

std::string drawn_value(const ExperimentDraw& draw, std::int64_t seed, std::int64_t trial) {
  const std::array<std::uint32_t, 4> bits = random_bits(draw.key, seed, trial);
  const double share = unit_interval(std::uint64_t{bits[0]} << 32 | bits[1]);
  if (!draw.values.empty()) {
    return draw.values[static_cast<std::size_t>(share * static_cast<double>(draw.values.size()))];
  }
  const std::string rounded = four_digits(std::lerp(draw.min, draw.max, share));
  double number = std::clamp(std::strtod(rounded.c_str(), nullptr), draw.min, draw.max);
  if (draw.either_sign && (bits[2] & 1U) != 0) number = -number;
  if (draw.text.empty()) return toml_literal(number);
  std::string value = draw.text;
  return in_quotes(
      value.replace(value.find(kPlace), std::string(kPlace).size(), four_digits(number)));
}

std::int64_t drawn_seed(std::int64_t seed, std::int64_t trial) {
  return random_bits("run.seed", seed, trial)[0];
}

}  // namespace pirouette
