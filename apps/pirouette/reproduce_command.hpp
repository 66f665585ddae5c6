// pirouette reproduce: the paper's figures, its numbers beside ours.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "sweep_runner.hpp"

namespace pirouette::app {

class ReproduceCommand {
 public:
  explicit ReproduceCommand(CLI::App& app);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  /// The experiments asked for, all of them checked.
  Result<std::vector<Experiment>> load() const;

  CLI::App* command_;
  std::string figure_;
  SweepRunner runner_;
};

}  // namespace pirouette::app
