// The command-line options that make a configuration.
#pragma once

#include <CLI/CLI.hpp>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/result.hpp"

namespace pirouette {
struct Config;
}

namespace pirouette::app {

/// Options bound to a subcommand; must outlive the parsing.
class ConfigOptions {
 public:
  /// --config, --set, --robot, --controller and --profile.
  void add_common(CLI::App& command);
  /// Short names of what a run changes most often: --rate, --terrain, --seed ...
  void add_run(CLI::App& command);
  /// What the robot is to walk along: --radius, --speed or --path, with their details. After
  /// add_run.
  void add_turn(CLI::App& command);

  Result<Config> load() const;

  /// Errors about a parameter that was given by an option of its own, naming that option.
  Errors in_typed_words(Errors errors) const;

 private:
  /// An option that stands for a parameter.
  struct Shortcut {
    std::string option;
    std::string key;
    bool is_pair = false;  ///< X,Y on the command line, a list in TOML
    std::optional<std::string> text{};
  };

  CLI::Option* add_shortcut(CLI::App& command, Shortcut shortcut, const std::string& placeholder,
                            const std::string& help);
  bool is_given(const std::string& option) const;
  std::vector<std::string> overrides(Errors& errors) const;
  /// Overrides that --radius, --speed and --heading-offset-deg mean on top of `config`.
  std::vector<std::string> turn_overrides(const Config& config) const;
  Result<Config> load_with(const std::vector<std::string>& overrides) const;

  std::optional<std::string> robot_, controller_, profile_, file_, sensors_, aid_;
  bool is_turn_ = false;
  std::optional<double> radius_, speed_, heading_offset_deg_;
  std::vector<std::string> sets_;
  std::list<Shortcut> shortcuts_;  // CLI11 keeps references to the elements
};

}  // namespace pirouette::app
