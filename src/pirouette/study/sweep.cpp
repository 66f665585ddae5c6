#include "pirouette/study/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>
#include <tuple>

#include "pirouette/base/fingerprint.hpp"
#include "pirouette/base/stopwatch.hpp"
#include "pirouette/base/version.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/path_file.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/plant/plant.hpp"
#include "pirouette/study/configured_trial.hpp"
#include "pirouette/trial/trace_file.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Of a trace that is being written. Nobody else writes files with the suffix of our shard.
std::string part_suffix(const std::optional<Shard>& shard) {
  return shard ? ".part-" + shard->name() : ".part";
}

/// Removes what a killed process left of traces.
void remove_parts(const fs::path& folder, const std::optional<Shard>& shard) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / kTracesFolder, ignored)) {
    if (entry.path().string().ends_with(part_suffix(shard))) fs::remove(entry.path(), ignored);
  }
}

/// A trial, for all trials of the experiment that are equal to it.
struct Job {
  std::string key;
  std::string row;  ///< label of the first one's
  const Config* config = nullptr;
  bool keep_trace = false;
};

/// The experiment's different trials in the order of their first; fills in the keys of all.
std::vector<Job> distinct_jobs(const Experiment& experiment, std::vector<std::string>& keys) {
  std::vector<Job> jobs;
  std::map<std::string, std::size_t> places;
  for (const ExperimentTrial& trial : experiment.trials) {
    keys.push_back(trial_key(*trial.config));
    const auto [place, is_new] = places.try_emplace(keys.back(), jobs.size());
    if (is_new) {
      jobs.push_back({keys.back(), experiment.rows[trial.row].label, trial.config.get(), false});
    }
    Job& job = jobs[place->second];
    job.keep_trace = job.keep_trace || trial.keep_trace;
  }
  return jobs;
}

std::vector<Job> part_of(const std::vector<Job>& jobs, const Shard& shard) {
  std::vector<Job> part;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (shard.holds(i)) part.push_back(jobs[i]);
  }
  return part;
}

/// The name, not ours nor in `beside`, of an experiment with results in `log`; empty: there is
/// none.
std::string other_experiment(const ResultsLog& log, const std::string& ours,
                             const std::vector<std::string>& beside) {
  for (const auto& [key, entry] : log.entries()) {
    const std::string& name = entry.line.experiment;
    if (name != ours && std::find(beside.begin(), beside.end(), name) == beside.end()) return name;
  }
  return "";
}

/// Whether all results in `log` are of an experiment of the same name that has neither trials nor
/// rows in common with this one.
bool holds_a_namesake(const ResultsLog& log, const Experiment& experiment,
                      const std::set<std::string>& keys) {
  const auto is_ours = [&](const auto& entry) {
    const ResultsLine& line = entry.second.line;
    return keys.contains(entry.first) ||
           std::any_of(experiment.rows.begin(), experiment.rows.end(),
                       [&](const ExperimentRow& row) { return row.label == line.row; });
  };
  return !log.entries().empty() &&
         std::none_of(log.entries().begin(), log.entries().end(), is_ours);
}

/// Refuses a folder with the results of another experiment.
std::optional<Error> check_folder(const Experiment& experiment,
                                  const std::vector<std::string>& keys, const ResultsLog& log,
                                  const SweepOptions& options) {
  std::string other = other_experiment(log, experiment.name, options.beside);
  const bool namesake = other.empty() && options.beside.empty() && !options.fresh &&
                        holds_a_namesake(log, experiment, {keys.begin(), keys.end()});
  if (namesake) other = experiment.name;
  if (other.empty()) return std::nullopt;
  return Error{options.folder.string(), 0, "",
               "holds results of " + std::string(namesake ? "a different" : "the") +
                   " experiment " + in_quotes(other) + "; allowed for " +
                   in_quotes(experiment.name) + ": a folder of its own, by --out" +
                   (namesake ? ", or --fresh to replace them" : "")};
}

/// What of `log` is not used.
Errors unused_lines(const ResultsLog& log, const std::vector<std::string>& keys,
                    const SweepOptions& options) {
  Errors unused = log.rejected();
  const std::set<std::string> ours(keys.begin(), keys.end());
  for (const auto& [key, entry] : log.entries()) {
    if (!options.beside.empty() || ours.contains(key)) continue;
    unused.push_back({entry.file.string(), entry.number, "",
                      "is of no trial of this experiment: of other options, of the file before it "
                      "was edited or of another version (row " +
                          in_quotes(entry.line.row) + ")"});
  }
  std::sort(unused.begin(), unused.end(), [](const Error& a, const Error& b) {
    return std::tie(a.file, a.line) < std::tie(b.file, b.line);
  });
  return unused;
}

void tell_unused(const ResultsLog& log, const std::vector<std::string>& keys,
                 const SweepOptions& options) {
  if (!options.unused_lines) return;
  const Errors unused = unused_lines(log, keys, options);
  if (!unused.empty()) options.unused_lines(unused);
}

bool is_finished(const Job& job, const ResultsLog& log, const fs::path& folder) {
  std::error_code error;
  return log.find(job.key) != nullptr &&
         (!job.keep_trace || fs::exists(trace_path(folder, job.key), error));
}

void add_values(const ResultsLog& log, SweepResult& result) {
  for (const std::string& key : result.keys) {
    const MetricValues* values = log.find(key);
    result.values.push_back(values != nullptr ? *values : MetricValues{});
  }
}

/// "; shards not finished: 2/4, 3/4", when all shards that have run are of the same number.
std::string unfinished_shards(const fs::path& folder, const std::vector<std::size_t>& missing) {
  const std::vector<unsigned> counts = shard_counts(folder);
  if (counts.size() != 1) return "";
  std::vector<std::string> names;
  for (Shard shard{1, counts.front()}; shard.index <= shard.count; ++shard.index) {
    const bool unfinished = std::any_of(missing.begin(), missing.end(), [&](std::size_t position) {
      return shard.holds(position);
    });
    if (unfinished)
      names.push_back(std::to_string(shard.index) + "/" + std::to_string(shard.count));
  }
  return "; shards not finished: " + joined(names);
}

class Pool {
 public:
  Pool(std::string experiment, std::vector<Job> jobs, std::size_t total,
       const SweepOptions& options, ResultsLog& log)
      : experiment_(std::move(experiment)),
        jobs_(std::move(jobs)),
        total_(total),
        options_(options),
        log_(log) {}

  /// Whether every job has run.
  bool complete() const { return done_ == jobs_.size(); }

  Errors run() {
    report();
    const unsigned wanted = options_.jobs > 0 ? options_.jobs : std::thread::hardware_concurrency();
    const std::size_t count =
        std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(1, jobs_.size()));
    {
      std::vector<std::jthread> workers;
      for (std::size_t i = 0; i < count; ++i) workers.emplace_back([this] { work(); });
    }
    return errors_;
  }

 private:
  bool stopped() const { return failed_ || (options_.stop && options_.stop()); }

  void work() {
    for (std::size_t i = next_++; i < jobs_.size() && !stopped(); i = next_++) {
      Result<MetricValues> values = run_job(jobs_[i]);
      const std::lock_guard lock(mutex_);
      if (!values) {
        failed_ = true;
        errors_.insert(errors_.end(), values.errors().begin(), values.errors().end());
      } else if (!values.value().empty()) {
        finish(jobs_[i], std::move(values).value());
      }
    }
  }

  /// Empty when the trial was stopped.
  Result<MetricValues> run_job(const Job& job) {
    TrialOptions options;
    options.progress = [this](const TrialProgress&) { return !stopped(); };
    const fs::path path = trace_path(options_.folder, job.key);
    const fs::path part = path.string() + part_suffix(options_.shard);
    std::optional<NpyRowsFile> trace;
    if (job.keep_trace) {
      Result<NpyRowsFile> created = create_trace_file(part);
      if (!created) return created.errors();
      options.trace = &trace.emplace(std::move(created).value());
    }
    const Result<TrialResult> result = run_trial(*job.config, options);
    std::error_code error;
    if (!result || result.value().interrupted) {
      if (trace) fs::remove(part, error);
      return result ? Result<MetricValues>(MetricValues{}) : result.errors();
    }
    if (trace) {
      if (const auto unfinished = trace->finish()) return *unfinished;
      fs::rename(part, path, error);
      if (error) return Error{path.string(), 0, "", "cannot be written: " + error.message()};
    }
    return metric_values(result.value().metrics);
  }

  void finish(const Job& job, MetricValues values) {
    if (const auto error = log_.append({experiment_, job.row, job.key, std::move(values)})) {
      failed_ = true;
      errors_.push_back(*error);
      return;
    }
    ++done_;
    report();
  }

  void report() const {
    if (!options_.progress) return;
    const double seconds = watch_.seconds();
    SweepProgress progress;
    progress.resumed = total_ - jobs_.size();
    progress.done = progress.resumed + done_;
    progress.total = total_;
    if (done_ > 0) {
      progress.seconds_left =
          seconds / static_cast<double>(done_) * static_cast<double>(jobs_.size() - done_);
    }
    options_.progress(progress);
  }

  const std::string experiment_;
  const std::vector<Job> jobs_;
  const std::size_t total_;  ///< with those that were finished before
  const SweepOptions& options_;
  ResultsLog& log_;
  const Stopwatch watch_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;  ///< of all that follows, and of log_
  std::size_t done_ = 0;
  Errors errors_;
};

}  // namespace

std::string trial_key(const Config& config) {
  Fingerprint fingerprint;
  for (const ParameterGroup& group : describe(config)) {
    for (const ParameterInfo& parameter : group.parameters) {
      fingerprint.add(parameter.key);
      fingerprint.add(parameter.value);
    }
  }
  if (const Result<RobotDescription> robot = resolve_robot(config)) {
    fingerprint.add(read_text(robot.value().file));
    if (!robot.value().source.empty()) fingerprint.add(read_text(robot.value().source));
  }
  if (!config.run.path.empty()) {
    const Result<fs::path> path = resolve_path(config.run);
    if (path) fingerprint.add(read_text(path.value()));
  }
  for (const std::string& text :
       {std::string(version()), std::string(commit()), physics_version()}) {
    fingerprint.add(text);
  }
  return fingerprint.hex();
}

fs::path trace_path(const fs::path& folder, const std::string& key) {
  return folder / kTracesFolder / (key + ".npy");
}

Errors check_sweep(const Experiment& experiment) {
  Errors errors;
  const std::string file = experiment.file.string();
  const std::vector<std::string> names = metric_names();
  const auto check_metric = [&](const std::string& metric) {
    if (std::find(names.begin(), names.end(), metric) != names.end()) return;
    const std::optional<std::string> meant = nearest(metric, names);
    errors.push_back({file, 0, metric,
                      "no such metric" + (meant ? "; did you mean " + *meant + "?"
                                                : "; `pirouette config metrics` lists them")});
  };
  for (const ExperimentColumn& column : experiment.columns) check_metric(column.metric);
  for (const ExperimentBound& bound : experiment.bounds) check_metric(bound.metric);
  for (const PrintedResult& printed : experiment.printed) {
    for (const auto& entry : printed.metrics) check_metric(entry.first);
  }
  std::set<std::string> texts;
  for (std::size_t i = 0; i < experiment.trials.size(); ++i) {
    const ExperimentTrial& trial = experiment.trials[i];
    const bool first =
        experiment.random ? i < experiment.rows.size() : trial.seed == experiment.seeds.front();
    if (!first) continue;
    for (Error error : check_trial(*trial.config)) {
      if (error.file.empty()) error.file = file;
      if (texts.insert(error.to_string()).second) errors.push_back(std::move(error));
    }
  }
  return errors;
}

Result<SweepResult> run_sweep(const Experiment& experiment, const SweepOptions& options) {
  Errors errors = check_sweep(experiment);
  if (!errors.empty()) return errors;
  SweepResult result;
  std::vector<Job> jobs = distinct_jobs(experiment, result.keys);
  if (const auto other =
          check_folder(experiment, result.keys, ResultsLog::read(options.folder), options)) {
    return *other;
  }
  std::error_code error;
  fs::create_directories(options.folder / kTracesFolder, error);
  if (error) return Error{options.folder.string(), 0, "", "cannot be created: " + error.message()};
  Result<ResultsLog> opened = ResultsLog::open(options.folder, options.shard, options.fresh);
  if (!opened) return opened.errors();
  ResultsLog& log = opened.value();
  remove_parts(options.folder, options.shard);
  tell_unused(log, result.keys, options);

  if (options.shard) jobs = part_of(jobs, *options.shard);
  const std::size_t total = jobs.size();
  std::erase_if(jobs, [&](const Job& job) { return is_finished(job, log, options.folder); });
  Pool pool(experiment.name, std::move(jobs), total, options, log);
  errors = pool.run();
  if (!errors.empty()) return errors;
  result.interrupted = !pool.complete();
  add_values(log, result);
  return result;
}

Result<SweepProgress> survey_sweep(const Experiment& experiment, const SweepOptions& options) {
  std::vector<std::string> keys;
  const std::vector<Job> jobs = distinct_jobs(experiment, keys);
  const ResultsLog log = ResultsLog::read(options.folder);
  if (const auto other = check_folder(experiment, keys, log, options)) return *other;
  tell_unused(log, keys, options);
  SweepProgress progress;
  progress.total = jobs.size();
  progress.done =
      static_cast<std::size_t>(std::count_if(jobs.begin(), jobs.end(), [&](const Job& job) {
        return is_finished(job, log, options.folder);
      }));
  progress.resumed = progress.done;
  return progress;
}

Result<SweepResult> merge_sweep(const Experiment& experiment, const SweepOptions& options) {
  const Errors errors = check_sweep(experiment);
  if (!errors.empty()) return errors;
  SweepResult result;
  const std::vector<Job> jobs = distinct_jobs(experiment, result.keys);
  const ResultsLog log = ResultsLog::read(options.folder);
  if (const auto other = check_folder(experiment, result.keys, log, options)) return *other;
  tell_unused(log, result.keys, options);
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (!is_finished(jobs[i], log, options.folder)) missing.push_back(i);
  }
  if (!missing.empty()) {
    return Error{options.folder.string(), 0, "",
                 "no results of " + std::to_string(missing.size()) + " of " +
                     std::to_string(jobs.size()) + " trials" +
                     unfinished_shards(options.folder, missing)};
  }
  add_values(log, result);
  return result;
}

std::optional<Error> write_atomically(const fs::path& path, const std::string& text) {
  const fs::path part = path.string() + ".part";
  std::ofstream stream(part, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) fs::rename(part, path, error);
  if (stream && !error) return std::nullopt;
  return Error{path.string(), 0, "", "cannot be written"};
}

}  // namespace pirouette
