// pirouette montecarlo: trials whose parameters are drawn, and how many of them survive.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "sweep_runner.hpp"

namespace pirouette::app {

class MontecarloCommand {
 public:
  explicit MontecarloCommand(CLI::App& app);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::string file_;
  SweepRunner runner_;
};

}  // namespace pirouette::app
