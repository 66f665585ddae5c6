// pirouette sweep: the trials of an experiment file.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "sweep_runner.hpp"

namespace pirouette::app {

class SweepCommand {
 public:
  explicit SweepCommand(CLI::App& app);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::string file_;
  SweepRunner runner_;
};

}  // namespace pirouette::app
