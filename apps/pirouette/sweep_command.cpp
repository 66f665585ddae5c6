#include "sweep_command.hpp"

#include "exit_code.hpp"

namespace pirouette::app {
namespace {

struct Verb {
  const char* name;
  const char* help;
  const char* file_help;
};

Verb verb(SweepCommand::Kind kind) {
  if (kind == SweepCommand::Kind::kSweep) {
    return {"sweep", "Run the trials of an experiment file in parallel",
            "Experiment, such as experiments/fig6.toml"};
  }
  return {"montecarlo", "Run the trials of an experiment file whose parameters are drawn",
          "Experiment with [random], experiments/montecarlo.toml"};
}

std::string default_folder(SweepCommand::Kind kind, const std::string& experiment) {
  return std::string("runs/") + verb(kind).name + "-" + experiment;
}

}  // namespace

SweepCommand::SweepCommand(CLI::App& app, Kind kind) : kind_(kind) {
  const auto [name, help, file_help] = verb(kind);
  command_ = app.add_subcommand(name, help);
  command_->add_option("FILE", file_, file_help)->required();
  runner_.add_options(*command_, default_folder(kind, "NAME"));
  if (kind == Kind::kSweep) {
    runner_.add_seed_options(*command_);
  } else {
    runner_.add_draw_options(*command_);
  }
  runner_.add_shard_options(*command_);
}

int SweepCommand::run() const {
  Errors errors = runner_.check();
  const Result<Experiment> experiment = load_experiment(file_, runner_.changes());
  if (!experiment) {
    errors.insert(errors.end(), experiment.errors().begin(), experiment.errors().end());
  } else if (kind_ == Kind::kMontecarlo && !experiment.value().random) {
    errors.push_back({file_, 0, "trials",
                      "missing: what to draw is in [random], how often in trials; `pirouette "
                      "sweep` runs a file without them"});
  }
  if (!errors.empty()) return report(errors);
  const std::string folder = runner_.folder(default_folder(kind_, experiment.value().name));
  return runner_.run(experiment.value(), folder, runner_.fresh());
}

}  // namespace pirouette::app
