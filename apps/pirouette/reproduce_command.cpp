#include "reproduce_command.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "exit_code.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/suggest.hpp"

namespace pirouette::app {
namespace {

namespace fs = std::filesystem;

/// Runs `python -m pirouette.plots FOLDER` of the source tree; false when it did not succeed.
bool run_plots(const fs::path& python, const fs::path& packages, const std::string& folder) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::setenv("PYTHONPATH", packages.c_str(), 1);
    ::execl(python.c_str(), python.c_str(), "-m", "pirouette.plots", folder.c_str(), nullptr);
    ::_exit(kBadUsage);
  }
  int status = 0;
  return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

/// Plots are a bonus: without Python the tables stand by themselves.
void draw(const std::string& folder) {
  const fs::path root = data_dir();
  const fs::path python = root / ".venv" / "bin" / "python";
  const fs::path packages = root / "python";
  if (fs::exists(python) && run_plots(python, packages, folder)) return;
  std::cerr << "no plots: they need the source tree's Python environment (make setup), then\n"
            << "  PYTHONPATH=python .venv/bin/python -m pirouette.plots " << folder << "\n";
}

/// Names of the experiments that repeat somebody's, and of those that are wrong.
std::vector<std::string> with_source() {
  std::vector<std::string> names = known_experiments();
  std::erase_if(names, [](const std::string& name) {
    const Result<Experiment> experiment = load_experiment(experiment_path(name));
    return experiment && experiment.value().source.empty();
  });
  return names;
}

}  // namespace

ReproduceCommand::ReproduceCommand(CLI::App& app) {
  command_ =
      app.add_subcommand("reproduce", "Repeat the paper's experiments, its numbers beside ours");
  command_
      ->add_option("FIGURE", figure_,
                   "all that have a source, or one of: " + joined(known_experiments()))
      ->required();
  runner_.add_options(*command_, "reports");
  runner_.add_seed_options(*command_);
}

Result<std::vector<Experiment>> ReproduceCommand::load() const {
  std::vector<std::string> names = known_experiments();
  if (figure_ != "all") {
    if (std::find(names.begin(), names.end(), figure_) == names.end()) {
      names.emplace_back("all");
      return Error{"reproduce", 0, "", unknown_name(figure_, names)};
    }
    names = {figure_};
  } else {
    names = with_source();
  }
  std::vector<Experiment> experiments;
  Errors errors = runner_.check();
  for (const std::string& name : names) {
    Result<Experiment> experiment = load_experiment(experiment_path(name), runner_.changes());
    if (experiment) {
      experiments.push_back(std::move(experiment).value());
      continue;
    }
    for (const Error& error : experiment.errors()) {
      const bool known = std::any_of(errors.begin(), errors.end(), [&](const Error& e) {
        return e.to_string() == error.to_string();
      });
      if (!known) errors.push_back(error);
    }
  }
  if (!errors.empty()) return errors;
  return experiments;
}

int ReproduceCommand::run() const {
  const Result<std::vector<Experiment>> experiments = load();
  if (!experiments) return report(experiments.errors());
  const std::string folder = runner_.folder("reports");
  int code = kDone;
  bool fresh = runner_.fresh();
  for (const Experiment& experiment : experiments.value()) {
    const int outcome = runner_.run(experiment, folder, fresh);
    if (outcome != kDone && outcome != kFell) return outcome;
    code = std::max(code, outcome);
    fresh = false;  // the experiments share what they have in common
  }
  draw(folder);
  std::cout << "Tables and plots: " << folder << "\n";
  return code;
}

}  // namespace pirouette::app
