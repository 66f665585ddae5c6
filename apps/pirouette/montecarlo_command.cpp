#include "montecarlo_command.hpp"

#include "exit_code.hpp"

namespace pirouette::app {

MontecarloCommand::MontecarloCommand(CLI::App& app) {
  command_ = app.add_subcommand("montecarlo",
                                "Run the trials of an experiment file whose parameters are drawn");
  command_->add_option("FILE", file_, "Experiment with [random], experiments/montecarlo.toml")
      ->required();
  runner_.add_options(*command_, "runs/montecarlo-NAME");
  runner_.add_draw_options(*command_);
  runner_.add_shard_options(*command_);
}

int MontecarloCommand::run() const {
  Errors errors = runner_.check();
  const Result<Experiment> experiment = load_experiment(file_, runner_.changes());
  if (!experiment) {
    errors.insert(errors.end(), experiment.errors().begin(), experiment.errors().end());
  } else if (!experiment.value().random) {
    errors.push_back({file_, 0, "trials",
                      "missing: what to draw is in [random], how often in trials; `pirouette "
                      "sweep` runs a file without them"});
  }
  if (!errors.empty()) return report(errors);
  const std::string folder = runner_.folder("runs/montecarlo-" + experiment.value().name);
  return runner_.run(experiment.value(), folder, runner_.fresh());
}

}  // namespace pirouette::app
