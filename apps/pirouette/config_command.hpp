// pirouette config: check files, show the resolved configuration, print the reference tables.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "config_options.hpp"

namespace pirouette::app {

class ConfigCommand {
 public:
  explicit ConfigCommand(CLI::App& app);

  bool chosen() const { return command_->parsed(); }
  int run() const;

 private:
  int check() const;
  int dump() const;

  CLI::App* command_;
  CLI::App* check_;
  CLI::App* dump_;
  CLI::App* doc_;
  CLI::App* trace_;
  CLI::App* recording_;
  CLI::App* metrics_;
  std::vector<std::string> files_;
  ConfigOptions dump_options_;
};

}  // namespace pirouette::app
