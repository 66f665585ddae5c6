#include "sweep_command.hpp"

#include "exit_code.hpp"

namespace pirouette::app {

SweepCommand::SweepCommand(CLI::App& app) {
  command_ = app.add_subcommand("sweep", "Run the trials of an experiment file in parallel");
  command_->add_option("FILE", file_, "Experiment, such as experiments/fig6.toml")->required();
  runner_.add_options(*command_, "runs/sweep-NAME");
  runner_.add_seed_options(*command_);
  runner_.add_shard_options(*command_);
}

int SweepCommand::run() const {
  Errors errors = runner_.check();
  const Result<Experiment> experiment = load_experiment(file_, runner_.changes());
  if (!experiment) {
    errors.insert(errors.end(), experiment.errors().begin(), experiment.errors().end());
  }
  if (!errors.empty()) return report(errors);
  const std::string folder = runner_.folder("runs/sweep-" + experiment.value().name);
  return runner_.run(experiment.value(), folder, runner_.fresh());
}

}  // namespace pirouette::app
