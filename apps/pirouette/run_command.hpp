// pirouette spin and pirouette turn: one simulated run.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "config_options.hpp"
#include "pirouette/trial/run_folder.hpp"

namespace pirouette::app {

class RunCommand {
 public:
  enum class Kind { kSpin, kTurn };

  /// Adds the subcommand to `app`; `command_line` goes into run.toml.
  RunCommand(CLI::App& app, Kind kind, std::string command_line);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  std::string default_folder(const Config& config) const;
  Result<RunFolder> open_folder(const Config& config) const;

  Kind kind_;
  std::string command_line_;
  CLI::App* command_;
  ConfigOptions config_options_;
  std::optional<std::string> out_;
  bool force_ = false;
  bool json_ = false;
  bool quiet_ = false;
  bool realtime_ = false;
  bool record_ = false;
};

}  // namespace pirouette::app
