// Random draws of the trials of an experiment.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pirouette {

inline constexpr std::int64_t kMaxTrials = 1'000'000;                ///< of an experiment
inline constexpr std::int64_t kMaxDrawSeed = 9'000'000'000'000'000;  ///< as of run.seed

/// A parameter that each trial draws anew: one of `values`, or, without any, uniform in [min, max],
/// rounded to four significant digits.
struct ExperimentDraw {
  std::string key;                    ///< dotted, such as plant.friction
  std::vector<std::string> values{};  ///< TOML literals, equally likely
  double min = 0.0;                   ///< smallest value
  double max = 0.0;                   ///< largest value
  bool either_sign = false;           ///< negative in half of the trials
  std::string text{};  ///< "slope:{}": the value is this with the number in place of {}
  int line = 0;        ///< of the experiment file

  /// "0.4 to 1", "flat, slope:10".
  std::string to_string() const;
};

/// The parameter's value in trial `trial` as a TOML literal. It depends on the draw itself, on
/// `seed` and on `trial`, not on what else is drawn.
std::string drawn_value(const ExperimentDraw& draw, std::int64_t seed, std::int64_t trial);

/// run.seed of trial `trial`, from 0 to 2^32 - 1.
std::int64_t drawn_seed(std::int64_t seed, std::int64_t trial);

}  // namespace pirouette
