// pirouette robot: look a robot's file over, describe it, list the known robots.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace pirouette::app {

class RobotCommand {
 public:
  explicit RobotCommand(CLI::App& app);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  int check() const;
  /// Draws the robot with the Python package.
  int draw() const;
  int describe() const;
  int list() const;

  CLI::App* command_;
  CLI::App* check_;
  CLI::App* describe_;
  CLI::App* list_;
  std::string robot_;
  bool json_ = false;
  std::string picture_;
};

}  // namespace pirouette::app
