#include "sweep_runner.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <utility>

#include "exit_code.hpp"
#include "interrupt.hpp"
#include "pirouette/experiment/report.hpp"
#include "pirouette/experiment/sweep.hpp"

namespace pirouette::app {
namespace {

constexpr int kMaxJobs = 1024;
constexpr int kMinute = 60;  // s

/// "fig6: 12 of 140 trials, 3 min 20 s left" on stderr: redrawn on a terminal, else a line every
/// tenth of the trials.
class SweepProgressLine {
 public:
  explicit SweepProgressLine(std::string name)
      : name_(std::move(name)), terminal_(::isatty(STDERR_FILENO) == 1) {}
  ~SweepProgressLine() {
    if (terminal_) std::fputs("\r\x1b[K", stderr);
  }
  SweepProgressLine(const SweepProgressLine&) = delete;
  SweepProgressLine& operator=(const SweepProgressLine&) = delete;

  void update(const SweepProgress& p) {
    if (!terminal_ && p.done < next_ && p.done < p.total) return;
    next_ = p.done + std::max<std::size_t>(1, p.total / kLines);
    std::string line =
        name_ + ": " + std::to_string(p.done) + " of " + std::to_string(p.total) + " trials";
    if (p.done == p.resumed && p.resumed > 0) line += " were there";
    if (p.seconds_left > 0.0) line += ", " + duration(p.seconds_left) + " left";
    std::fprintf(stderr, terminal_ ? "\r%s\x1b[K" : "%s\n", line.c_str());
    std::fflush(stderr);
  }

 private:
  static constexpr std::size_t kLines = 10;

  static std::string duration(double seconds) {
    const int whole = static_cast<int>(seconds + 0.5);
    const std::string rest = std::to_string(whole % kMinute) + " s";
    return whole < kMinute ? rest : std::to_string(whole / kMinute) + " min " + rest;
  }

  std::string name_;
  bool terminal_;
  std::size_t next_ = 0;
};

std::optional<Error> write_tables(const Report& report, const std::filesystem::path& folder,
                                  const std::string& name) {
  const std::pair<const char*, std::string> files[] = {{".md", report.markdown()},
                                                       {".json", report.json()},
                                                       {".csv", report.csv()},
                                                       {"-trials.csv", report.trials_csv()}};
  for (const auto& [suffix, text] : files) {
    if (auto error = write_atomically(folder / (name + suffix), text)) return error;
  }
  return std::nullopt;
}

}  // namespace

void SweepRunner::add_options(CLI::App& command, const std::string& default_folder) {
  command.add_option("--jobs", jobs_, "Trials at the same time [one for each processor]")
      ->type_name("N");
  command.add_option("--seeds", changes_.seeds, "Seeds 1 to N instead of the file's")
      ->type_name("N");
  command.add_option("--turns", changes_.turns, "Turns of every trial instead of the file's")
      ->type_name("N");
  command
      .add_option("--out", out_,
                  "Folder of results, tables and traces; what is finished there is kept [" +
                      default_folder + "]")
      ->type_name("DIR");
  command.add_flag("--fresh", fresh_, "Run everything again, as after a change of the code");
}

Errors SweepRunner::check() const {
  if (jobs_ >= 0 && jobs_ <= kMaxJobs) return {};
  return {{"--jobs", 0, "",
           "given " + std::to_string(jobs_) + "; allowed: 1 to " + std::to_string(kMaxJobs) +
               ", or 0 for one for each processor"}};
}

int SweepRunner::run(const Experiment& experiment, const std::string& folder, bool fresh) const {
  watch_interrupts();
  SweepOptions options;
  options.jobs = static_cast<unsigned>(jobs_);
  options.folder = folder;
  options.fresh = fresh;
  options.stop = [] { return interrupt_signal() != 0; };
  Result<SweepResult> result = [&] {
    SweepProgressLine line(experiment.name);
    options.progress = [&line](const SweepProgress& progress) { line.update(progress); };
    return run_sweep(experiment, options);
  }();
  if (!result) return report(result.errors());
  if (result.value().interrupted) {
    std::cerr << "interrupted: finished trials are kept in " << folder
              << ", the same command goes on from there\n";
    return kSignal + interrupt_signal();
  }
  const Report tables(experiment, result.value());
  if (const auto error = write_tables(tables, folder, experiment.name)) return report({*error});
  std::cout << tables.markdown() << "\n" << std::flush;
  const std::vector<std::string> missed = tables.missed_bounds();
  for (const std::string& text : missed) std::cerr << "missed: " << text << "\n";
  return missed.empty() ? kDone : kFell;
}

}  // namespace pirouette::app
