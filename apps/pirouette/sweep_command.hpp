// pirouette sweep and pirouette montecarlo: the trials of an experiment file.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "sweep_runner.hpp"

namespace pirouette::app {

class SweepCommand {
 public:
  /// kMontecarlo: the file draws its parameters, and the report counts survivors.
  enum class Kind { kSweep, kMontecarlo };

  SweepCommand(CLI::App& app, Kind kind);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  Kind kind_;
  CLI::App* command_;
  std::string file_;
  SweepRunner runner_;
};

}  // namespace pirouette::app
