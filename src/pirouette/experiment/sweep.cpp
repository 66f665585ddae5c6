#include "pirouette/experiment/sweep.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>
#include <thread>
#include <type_traits>

#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/path_file.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/config/validate.hpp"
#include "pirouette/experiment/trace_file.hpp"
#include "pirouette/experiment/trial.hpp"
#include "pirouette/plant/plant.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string read_text(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// FNV-1a, 64 bits: the same on every machine.
class Fingerprint {
 public:
  void add(std::string_view text) {
    for (const char c : text) mix(static_cast<unsigned char>(c));
    mix(kSeparator);
  }

  std::string hex() const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(value_ >> shift) & 0xf];
    return text;
  }

 private:
  static constexpr std::uint64_t kSeparator = 0x100;  // no byte

  void mix(std::uint64_t byte) { value_ = (value_ ^ byte) * 0x100000001b3; }

  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// The finished trials on disk: one line of JSON each, appended in one write.
class ResultsLog {
 public:
  static Result<ResultsLog> open(const fs::path& path, bool fresh) {
    ResultsLog log;
    log.path_ = path;
    log.file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (log.file_ < 0) return Error{path.string(), 0, "", "cannot be written"};
    if (::flock(log.file_, LOCK_EX | LOCK_NB) != 0) {
      return Error{path.string(), 0, "", "is in use: another sweep writes to this folder"};
    }
    if (const auto error = fresh ? log.truncate(0) : log.read()) return *error;
    return log;
  }

  ResultsLog(ResultsLog&& other) noexcept
      : path_(std::move(other.path_)),
        file_(std::exchange(other.file_, -1)),
        finished_(std::move(other.finished_)) {}
  ResultsLog& operator=(ResultsLog&&) = delete;
  ~ResultsLog() {
    if (file_ >= 0) ::close(file_);
  }

  const MetricValues* find(const std::string& key) const {
    const auto found = finished_.find(key);
    return found == finished_.end() ? nullptr : &found->second;
  }

  std::optional<Error> append(const std::string& key, const MetricValues& values) {
    Json metrics = Json::object();
    for (const auto& [name, value] : values) metrics[name] = value ? Json(*value) : Json(nullptr);
    const std::string line = Json{{"trial", key}, {"metrics", metrics}}.dump() + "\n";
    if (::write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
      return Error{path_.string(), 0, "", "cannot be written: is the disk full?"};
    }
    finished_[key] = values;
    return std::nullopt;
  }

 private:
  ResultsLog() = default;

  std::optional<Error> truncate(std::size_t size) {
    if (::ftruncate(file_, static_cast<off_t>(size)) == 0) return std::nullopt;
    return Error{path_.string(), 0, "", "cannot be written"};
  }

  /// Reads the whole lines and cuts off what a killed process left of one.
  std::optional<Error> read() {
    const std::string text = read_text(path_);
    std::size_t begin = 0;
    for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n', begin)) {
      read_line(std::string_view(text).substr(begin, end - begin));
      begin = end + 1;
    }
    return truncate(begin);
  }

  void read_line(std::string_view line) {
    const Json entry = Json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (!entry.is_object() || !entry.contains("trial") || !entry["trial"].is_string() ||
        !entry.contains("metrics") || !entry["metrics"].is_object()) {
      return;
    }
    MetricValues values;
    for (const auto& [name, value] : entry["metrics"].items()) {
      values[name] = value.is_number() ? Number(value.get<double>()) : std::nullopt;
    }
    finished_[entry["trial"].get<std::string>()] = std::move(values);
  }

  fs::path path_;
  int file_ = -1;
  std::map<std::string, MetricValues> finished_;
};

/// A trial that must run, for all trials of the experiment that are equal to it.
struct Job {
  std::string key;
  const Config* config = nullptr;
  bool keep_trace = false;
};

class Pool {
 public:
  Pool(std::vector<Job> jobs, std::size_t total, const SweepOptions& options, ResultsLog& log)
      : jobs_(std::move(jobs)), total_(total), options_(options), log_(log) {}

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
        finish(jobs_[i].key, values.value());
      }
    }
  }

  /// Empty when the trial was stopped.
  Result<MetricValues> run_job(const Job& job) {
    TrialOptions options;
    options.progress = [this](const TrialProgress&) { return !stopped(); };
    const fs::path path = trace_path(options_.folder, job.key);
    const fs::path part = path.string() + ".part";
    std::optional<TraceFile> trace;
    if (job.keep_trace) {
      Result<TraceFile> created = TraceFile::create(part);
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

  void finish(const std::string& key, const MetricValues& values) {
    if (const auto error = log_.append(key, values)) {
      failed_ = true;
      errors_.push_back(*error);
      return;
    }
    ++done_;
    report();
  }

  void report() const {
    if (!options_.progress) return;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
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

  const std::vector<Job> jobs_;
  const std::size_t total_;  ///< different trials of the experiment
  const SweepOptions& options_;
  ResultsLog& log_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> failed_ = false;
  std::mutex mutex_;  ///< of all that follows, and of log_
  std::size_t done_ = 0;
  Errors errors_;
};

}  // namespace

MetricValues metric_values(const Metrics& metrics) {
  MetricValues values;
  Metrics::fields(metrics, [&](const auto& value, const char* key, const char*, const char*) {
    const std::string_view name = key;
    if (name.starts_with("timing.") || name.starts_with("context.")) return;
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<T, bool>) {
      values[key] = value ? 1.0 : 0.0;
    } else if constexpr (std::is_same_v<T, Number>) {
      values[key] = value && std::isfinite(*value) ? value : std::nullopt;
    } else if constexpr (std::is_same_v<T, double>) {
      values[key] = std::isfinite(value) ? Number(value) : std::nullopt;
    }
  });
  return values;
}

std::vector<std::string> metric_names() {
  const Metrics metrics;
  const MetricValues values = metric_values(metrics);
  std::vector<std::string> names;
  Metrics::fields(metrics, [&](const auto&, const char* key, const char*, const char*) {
    if (values.contains(key)) names.emplace_back(key);
  });
  return names;
}

std::string trial_key(const Config& config) {
  Fingerprint fingerprint;
  for (const ParameterGroup& group : describe(config)) {
    for (const ParameterInfo& parameter : group.parameters) {
      fingerprint.add(parameter.key);
      fingerprint.add(parameter.value);
    }
  }
  if (const Result<std::string> robot = resolve_robot(config)) {
    fingerprint.add(read_text(robot.value()));
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
  for (const ExperimentTrial& trial : experiment.trials) {
    if (trial.seed != experiment.seeds.front()) continue;
    for (Error error : check_trial(trial.config)) {
      if (error.file.empty()) error.file = file;
      if (texts.insert(error.to_string()).second) errors.push_back(std::move(error));
    }
  }
  return errors;
}

Result<SweepResult> run_sweep(const Experiment& experiment, const SweepOptions& options) {
  Errors errors = check_sweep(experiment);
  if (!errors.empty()) return errors;
  std::error_code error;
  fs::create_directories(options.folder / kTracesFolder, error);
  if (error) return Error{options.folder.string(), 0, "", "cannot be created: " + error.message()};
  Result<ResultsLog> log = ResultsLog::open(options.folder / kResultsFile, options.fresh);
  if (!log) return log.errors();

  SweepResult result;
  std::map<std::string, Job> distinct;
  for (const ExperimentTrial& trial : experiment.trials) {
    result.keys.push_back(trial_key(trial.config));
    Job& job = distinct[result.keys.back()];
    job = {result.keys.back(), &trial.config, job.keep_trace || trial.keep_trace};
  }
  std::vector<Job> pending;
  for (const std::string& key : result.keys) {
    const auto found = distinct.find(key);
    if (found->second.config == nullptr) continue;  // taken already
    const bool finished =
        log.value().find(key) != nullptr &&
        (!found->second.keep_trace || fs::exists(trace_path(options.folder, key), error));
    if (!finished) pending.push_back(found->second);
    found->second.config = nullptr;
  }

  errors = Pool(std::move(pending), distinct.size(), options, log.value()).run();
  if (!errors.empty()) return errors;
  for (const std::string& key : result.keys) {
    const MetricValues* values = log.value().find(key);
    result.values.push_back(values != nullptr ? *values : MetricValues{});
    result.interrupted = result.interrupted || values == nullptr;
  }
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
