// The program `pirouette`: a verb each for what the library does, and `pirouette-<verb>` for the
// rest.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "become_python.hpp"
#include "config_command.hpp"
#include "exit_code.hpp"
#include "pirouette/base/version.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/study/repeat_command.hpp"
#include "replay_command.hpp"
#include "reproduce_command.hpp"
#include "robot_command.hpp"
#include "run_command.hpp"
#include "sweep_command.hpp"

namespace pirouette::app {

int report(const Errors& errors) {
  for (const Error& error : errors) {
    // The parsers of others put line breaks into their messages.
    std::istringstream words(error.to_string());
    std::cerr << "error:";
    for (std::string word; words >> word;) std::cerr << " " << word;
    std::cerr << "\n";
  }
  return kBadUsage;
}

namespace {

/// The arguments as one line that a shell takes again.
std::string shell_line(int argc, char** argv) {
  std::string line = "pirouette";
  for (int i = 1; i < argc; ++i) line += " " + shell_word(argv[i]);
  return line;
}

bool has_verb(const CLI::App& app, const std::string& verb) {
  const auto commands = app.get_subcommands({});
  return std::any_of(commands.begin(), commands.end(),
                     [&](const CLI::App* command) { return command->check_name(verb); });
}

std::string own_path() {
  std::error_code error;
  const std::string path = std::filesystem::read_symlink("/proc/self/exe", error).string();
  return error ? "pirouette" : path;
}

/// Becomes the program `pirouette-<verb>`; returns only when there is none.
int run_external(const CLI::App& app, char** arguments) {
  constexpr std::array kPythonVerbs = {"report", "view", "export", "cluster"};
  const std::string verb = arguments[0];
  const std::string program = "pirouette-" + verb;
  if (verb.find('/') == verb.npos) {
    ::setenv("PIROUETTE", own_path().c_str(), 0);  // for those that run it in turn
    std::string name = program;
    arguments[0] = name.data();
    become_python(verb, arguments);
  }
  if (std::find(kPythonVerbs.begin(), kPythonVerbs.end(), verb) != kPythonVerbs.end()) {
    return report({{"", 0, "",
                    verb + ": no program " + program +
                        " on PATH; it comes with the Python package: run `make setup` or `pip "
                        "install .` in the source tree"}});
  }
  std::string verbs;
  for (const CLI::App* command : app.get_subcommands({})) {
    verbs += (verbs.empty() ? "" : ", ") + command->get_name();
  }
  return report(
      {{"", 0, "",
        "unknown verb \"" + verb + "\": no program " + program + " on PATH; allowed: " + verbs}});
}

int run(int argc, char** argv) {
  CLI::App app{"Accurate blind spinning of quadrupeds, simulated on MuJoCo.", "pirouette"};
  app.footer(
      "pirouette VERB --help explains a verb. Other verbs run the program pirouette-VERB.\n"
      "Exit codes: 0 done; 1 the robot fell or did less than asked, a bound was missed or a replay "
      "differs; 2 bad usage, configuration or files; 128 + N ended by signal N.");
  app.set_version_flag("--version", std::string("pirouette ") + version() + " (" + commit() + ")");
  app.require_subcommand(0, 1);
  const std::string command_line = shell_line(argc, argv);
  const RunCommand spin(app, RunCommand::Kind::kSpin, command_line);
  const RunCommand turn(app, RunCommand::Kind::kTurn, command_line);
  const SweepCommand sweep(app, SweepCommand::Kind::kSweep);
  const SweepCommand montecarlo(app, SweepCommand::Kind::kMontecarlo);
  const ReproduceCommand reproduce(app);
  const ReplayCommand replay(app);
  const ConfigCommand config(app);
  const RobotCommand robot(app);

  if (argc > 1 && argv[1][0] != '-' && !has_verb(app, argv[1])) {
    return run_external(app, argv + 1);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    std::string verb;
    for (const CLI::App* command : app.get_subcommands()) verb += command->get_name() + " ";
    return report({{"", 0, "", error.what() + ("; see pirouette " + verb + "--help")}});
  }
  if (spin.chosen()) return spin.run();
  if (turn.chosen()) return turn.run();
  if (sweep.chosen()) return sweep.run();
  if (montecarlo.chosen()) return montecarlo.run();
  if (reproduce.chosen()) return reproduce.run();
  if (replay.chosen()) return replay.run();
  if (config.chosen()) return config.run();
  if (robot.chosen()) return robot.run();
  std::cout << app.help();
  return kDone;
}

}  // namespace
}  // namespace pirouette::app

int main(int argc, char** argv) {
  try {
    const int code = pirouette::app::run(argc, argv);
    // A full disk or a closed pipe behind standard output shows when it is flushed.
    if (std::cout.flush() && std::fflush(stdout) == 0) return code;
    return pirouette::app::report({{"", 0, "", "standard output cannot be written"}});
  } catch (const std::exception& error) {
    return pirouette::app::report({{"", 0, "", error.what()}});
  }
}
