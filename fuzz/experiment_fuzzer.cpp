// Experiment files of `pirouette sweep` and `reproduce`.
#include "input_file.hpp"
#include "pirouette/study/experiment_file.hpp"

using pirouette::Experiment;
using pirouette::Result;
using pirouette::fuzz::InputFile;
using pirouette::fuzz::require;
using pirouette::fuzz::require_reasons;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const InputFile file(".toml");
  const Result<Experiment> experiment =
      pirouette::load_experiment(file.write(data, size), {.max_trials = 1000});
  if (experiment) {
    require(!experiment.value().trials.empty(), "an experiment has trials");
    for (const auto& trial : experiment.value().trials) {
      require(trial.row < experiment.value().rows.size(), "every trial belongs to a row");
    }
  } else {
    require_reasons(experiment);
  }
  return 0;
}
