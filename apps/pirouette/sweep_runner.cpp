#include "sweep_runner.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <utility>
#include <vector>

#include "exit_code.hpp"
#include "interrupt.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/report/report.hpp"
#include "pirouette/report/survival_report.hpp"
#include "pirouette/report/trial_table.hpp"
#include "progress_line.hpp"

namespace pirouette::app {
namespace {

constexpr int kMaxJobs = 1024;
constexpr unsigned kMaxShards = 100000;
constexpr int kMinute = 60;              // s
constexpr std::size_t kShownLines = 20;  // of results that are not used

std::string duration(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  const std::string rest = std::to_string(whole % kMinute) + " s";
  return whole < kMinute ? rest : std::to_string(whole / kMinute) + " min " + rest;
}

/// "fig6: 12 of 140 trials, 3 min 20 s left".
std::string progress_text(const std::string& name, const SweepProgress& p) {
  std::string text =
      name + ": " + std::to_string(p.done) + " of " + std::to_string(p.total) + " trials";
  if (p.done == p.resumed && p.resumed > 0) text += " were there";
  if (p.seconds_left > 0.0) text += ", " + duration(p.seconds_left) + " left";
  return text;
}

void tell_unused_lines(const Errors& lines) {
  const std::size_t shown = std::min(lines.size(), kShownLines);
  for (std::size_t i = 0; i < shown; ++i) {
    std::cerr << "warning: " << lines[i].to_string() << "; left out\n";
  }
  if (lines.size() > shown) {
    std::cerr << "warning: " << lines.size() - shown << " more lines of results are left out\n";
  }
}

struct Tables {
  std::vector<std::pair<std::string, std::string>> files;  ///< name and text
  std::string text;                                        ///< for people
  std::vector<std::string> missed;
};

Tables comparison_tables(const Experiment& experiment, const SweepResult& result) {
  const Report report(experiment, result);
  const std::string& name = experiment.name;
  const std::string text = report.markdown();
  return {{{name + ".md", text}, {name + ".json", report.json()}, {name + ".csv", report.csv()}},
          text,
          report.missed_bounds()};
}

Tables survival_tables(const Experiment& experiment, const SweepResult& result) {
  const SurvivalReport report(experiment, result);
  const std::string text = report.markdown();
  return {{{experiment.name + ".md", text}, {experiment.name + ".json", report.json()}},
          text,
          report.missed_bounds()};
}

}  // namespace

void SweepRunner::add_options(CLI::App& command, const std::string& default_folder) {
  command.add_option("--jobs", jobs_, "Trials at the same time [one for each processor]")
      ->type_name("N");
  command.add_option("--turns", changes_.turns, "Turns of every trial instead of the file's")
      ->type_name("N");
  command
      .add_option("--out", out_,
                  "Folder of results, tables and traces; what is finished there is kept [" +
                      default_folder + "]")
      ->type_name("DIR");
  CLI::Option* fresh =
      command.add_flag("--fresh", fresh_, "Run everything again, as after a change of the code");
  command.add_flag("--resume", resume_, "Run only what is not finished there; the default")
      ->excludes(fresh);
}

void SweepRunner::add_seed_options(CLI::App& command) {
  command.add_option("--seeds", changes_.seeds, "Seeds 1 to N instead of the file's")
      ->type_name("N");
}

void SweepRunner::add_draw_options(CLI::App& command) {
  command.add_option("--trials", changes_.trials, "Number of trials instead of the file's")
      ->type_name("N");
  command.add_option("--seed", changes_.draw_seed, "Of the draws, instead of the file's")
      ->type_name("N");
}

void SweepRunner::add_shard_options(CLI::App& command) {
  own_folder_ = true;
  CLI::Option* shard =
      command
          .add_option("--shard", shard_,
                      "Run every N-th trial from the I-th on, beside the other shards; no tables")
          ->type_name("I/N")
          ->excludes("--fresh");
  CLI::Option* merge =
      command
          .add_flag("--merge", merge_,
                    "Run nothing: write the tables from what the shards have left in the folder")
          ->excludes(shard)
          ->excludes("--fresh");
  command
      .add_flag("--dry-run", dry_run_,
                "Run nothing: check the file, tell how many of its trials are finished")
      ->excludes(shard)
      ->excludes(merge)
      ->excludes("--fresh");
}

Errors SweepRunner::check() const {
  Errors errors;
  if (jobs_ < 0 || jobs_ > kMaxJobs) {
    errors.push_back({"--jobs", 0, "",
                      "given " + std::to_string(jobs_) + "; allowed: 1 to " +
                          std::to_string(kMaxJobs) + ", or 0 for one for each processor"});
  }
  if (shard_ && !shard()) {
    errors.push_back({"--shard", 0, "",
                      "given " + in_quotes(*shard_) + "; allowed: I/N, I from 1 to N, N up to " +
                          std::to_string(kMaxShards)});
  }
  return errors;
}

std::optional<Shard> SweepRunner::shard() const {
  if (!shard_) return std::nullopt;
  Shard shard{0, 0};
  const char* const end = shard_->data() + shard_->size();
  const auto [slash, wrong_index] = std::from_chars(shard_->data(), end, shard.index);
  if (wrong_index != std::errc{} || slash == end || *slash != '/') return std::nullopt;
  const auto [rest, wrong_count] = std::from_chars(slash + 1, end, shard.count);
  const bool good = wrong_count == std::errc{} && rest == end && shard.index >= 1 &&
                    shard.index <= shard.count && shard.count <= kMaxShards;
  return good ? std::optional(shard) : std::nullopt;
}

SweepOptions SweepRunner::options(const std::string& folder, bool fresh) const {
  SweepOptions options;
  options.jobs = static_cast<unsigned>(jobs_);
  options.folder = folder;
  if (!own_folder_) options.beside = known_experiments();
  options.shard = shard();
  options.fresh = fresh;
  options.unused_lines = tell_unused_lines;
  options.stop = [] { return interrupt_signal() != 0; };
  return options;
}

Result<SweepResult> SweepRunner::results(const Experiment& experiment, const std::string& folder,
                                         bool fresh) const {
  SweepOptions options = this->options(folder, fresh);
  if (merge_) return merge_sweep(experiment, options);
  ProgressLine line;
  options.progress = [&](const SweepProgress& p) {
    const double done = static_cast<double>(p.done), total = static_cast<double>(p.total);
    line.update(p.done < p.total ? done / total : 1.0, progress_text(experiment.name, p));
  };
  return run_sweep(experiment, options);
}

int SweepRunner::survey(const Experiment& experiment, const std::string& folder) const {
  const Errors errors = check_sweep(experiment);
  if (!errors.empty()) return report(errors);
  const Result<SweepProgress> progress = survey_sweep(experiment, options(folder, false));
  if (!progress) return report(progress.errors());
  std::cout << progress.value().done << " of " << progress.value().total
            << " trials are finished in " << folder << "\n";
  return kDone;
}

int SweepRunner::run(const Experiment& experiment, const std::string& folder, bool fresh) const {
  if (dry_run_) return survey(experiment, folder);
  watch_interrupts();
  const Result<SweepResult> result = results(experiment, folder, fresh);
  if (!result) return report(result.errors());
  if (result.value().interrupted) {
    std::cerr << "interrupted: finished trials are kept in " << folder
              << ", the same command goes on from there\n";
    return kSignal + interrupt_signal();
  }
  if (shard_) {
    std::cout << "Shard " << *shard_
              << " is finished. When all are, --merge with the same file and "
              << "folder, " << folder << ", writes the tables.\n";
    return kDone;
  }
  return write_tables(experiment, result.value(), folder);
}

int SweepRunner::write_tables(const Experiment& experiment, const SweepResult& result,
                              const std::string& folder) const {
  const Tables tables = experiment.random ? survival_tables(experiment, result)
                                          : comparison_tables(experiment, result);
  std::vector<std::pair<std::string, std::string>> files = tables.files;
  files.emplace_back(own_folder_ ? kTrialTable : experiment.name + "-trials.csv",
                     trial_table(experiment, result));
  for (const auto& [file, text] : files) {
    const auto error = write_atomically(std::filesystem::path(folder) / file, text);
    if (error) return report({*error});
  }
  std::cout << tables.text << "\n" << std::flush;
  for (const std::string& text : tables.missed) std::cerr << "missed: " << text << "\n";
  return tables.missed.empty() ? kDone : kFell;
}

}  // namespace pirouette::app
