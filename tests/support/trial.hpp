// Closed-loop trials for scenario tests: the shipped configuration plus overrides.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pirouette/config/toml.hpp"
#include "pirouette/study/configured_trial.hpp"

namespace pirouette::test {

/// The configuration that `pirouette spin --set ...` would run.
inline Config spin_config(const std::vector<std::string>& overrides) {
  ConfigSources sources;
  sources.overrides = overrides;
  const Result<Config> config = load_config(sources);
  if (!config.ok()) {
    for (const Error& error : config.errors()) ADD_FAILURE() << error.to_string();
    return Config{};
  }
  return config.value();
}

inline Metrics run(const Config& config) {
  const Result<TrialResult> result = run_trial(config);
  if (!result.ok()) {
    for (const Error& error : result.errors()) ADD_FAILURE() << error.to_string();
    return Metrics{};
  }
  return result.value().metrics;
}

inline Metrics spin(const std::vector<std::string>& overrides) {
  return run(spin_config(overrides));
}

}  // namespace pirouette::test
