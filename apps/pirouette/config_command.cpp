#include "config_command.hpp"

#include <iostream>

#include "exit_code.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/toml.hpp"
#include "pirouette/metrics/metrics.hpp"
#include "pirouette/runtime/recording.hpp"
#include "pirouette/study/configured_trial.hpp"
#include "pirouette/trial/trace_file.hpp"

namespace pirouette::app {

ConfigCommand::ConfigCommand(CLI::App& app) {
  command_ = app.add_subcommand("config", "Check, show and document the parameters");
  command_->require_subcommand(0, 1);
  check_ =
      command_->add_subcommand("check", "Say everything that is wrong with configuration files");
  check_->add_option("FILE", files_, "TOML files")->required();
  dump_ = command_->add_subcommand("dump", "Print the resolved configuration as TOML");
  dump_options_.add_run(*dump_);
  dump_options_.add_common(*dump_);
  doc_ = command_->add_subcommand("doc", "Print the table of all parameters (Markdown)");
  trace_ = command_->add_subcommand("trace", "Print the table of trace.npy's columns (Markdown)");
  recording_ = command_->add_subcommand("recording",
                                        "Print the table of recording.npy's columns (Markdown)");
  metrics_ =
      command_->add_subcommand("metrics", "Print the table of metrics.json's keys (Markdown)");
}

int ConfigCommand::check() const {
  Errors errors;
  for (const std::string& file : files_) {
    ConfigSources sources;
    sources.file = file;
    const Result<Config> config = load_config(sources);
    Errors found = config ? check_trial(config.value()) : config.errors();
    if (found.empty()) std::cout << file << ": ok\n";
    for (Error& error : found) {
      if (error.file.empty()) error.file = file;
      errors.push_back(std::move(error));
    }
  }
  return errors.empty() ? kDone : report(errors);
}

int ConfigCommand::dump() const {
  const Result<Config> config = dump_options_.load();
  if (!config) return report(config.errors());
  std::cout << dump_toml(config.value());
  return kDone;
}

int ConfigCommand::run() const {
  if (check_->parsed()) return check();
  if (dump_->parsed()) return dump();
  if (doc_->parsed()) {
    std::cout << config_markdown();
  } else if (trace_->parsed()) {
    std::cout << trace_markdown();
  } else if (recording_->parsed()) {
    std::cout << npy_rows_markdown(RecordedTick{});
  } else if (metrics_->parsed()) {
    std::cout << metrics_markdown();
  } else {
    return report({{"config", 0, "", "needs one of check, dump, doc, trace, recording, metrics"}});
  }
  return kDone;
}

}  // namespace pirouette::app
