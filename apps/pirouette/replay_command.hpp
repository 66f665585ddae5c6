// pirouette replay: gives a recorded run to the controller again.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pirouette::app {

class ReplayCommand {
 public:
  explicit ReplayCommand(CLI::App& app);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  CLI::App* command_;
  std::string folder_;
};

}  // namespace pirouette::app
