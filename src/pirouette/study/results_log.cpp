#include "pirouette/study/results_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

namespace pirouette {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kStem = "results";
constexpr const char* kExtension = ".jsonl";

/// results.jsonl and those of the shards.
std::vector<fs::path> results_files(const fs::path& folder) {
  std::set<fs::path> files;  // sorted
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool whole = name == results_file(std::nullopt);
    if (whole || (name.starts_with(std::string(kStem) + "-") && name.ends_with(kExtension))) {
      files.insert(entry.path());
    }
  }
  return {files.begin(), files.end()};
}

Error in_use(const fs::path& path) {
  return {path.string(), 0, "", "is in use: another sweep writes to this folder"};
}

/// The file's descriptor; nobody else can lock it until that is closed.
Result<int> open_locked(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return Error{path.string(), 0, "", "cannot be written"};
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
  ::close(file);
  return in_use(path);
}

/// Cuts off what a killed process left of a line.
bool cut_last_line(const fs::path& path, int file) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  const std::size_t end = text.view().rfind('\n');
  return ::ftruncate(file, end == std::string_view::npos ? 0 : static_cast<off_t>(end + 1)) == 0;
}

std::optional<Error> remove_shards(const fs::path& folder, const fs::path& own) {
  for (const fs::path& path : results_files(folder)) {
    if (path == own) continue;
    const Result<int> file = open_locked(path);
    if (!file) return file.errors().front();
    std::error_code error;
    fs::remove(path, error);
    ::close(file.value());
    if (error) return Error{path.string(), 0, "", "cannot be removed: " + error.message()};
  }
  return std::nullopt;
}

}  // namespace

std::string Shard::name() const { return std::to_string(index) + "of" + std::to_string(count); }

std::string results_file(const std::optional<Shard>& shard) {
  return kStem + (shard ? "-" + shard->name() : "") + kExtension;
}

Result<ResultsLog> ResultsLog::open(const fs::path& folder, const std::optional<Shard>& shard,
                                    bool fresh) {
  ResultsLog log;
  log.path_ = folder / results_file(shard);
  const Result<int> file = open_locked(log.path_);
  if (!file) return file.errors();
  log.file_ = file.value();
  if (fresh) {
    if (const auto error = remove_shards(folder, log.path_)) return *error;
    if (::ftruncate(log.file_, 0) == 0) return log;
  } else if (cut_last_line(log.path_, log.file_)) {
    for (const fs::path& path : results_files(folder)) log.read_lines(path);
    return log;
  }
  return Error{log.path_.string(), 0, "", "cannot be written"};
}

ResultsLog ResultsLog::read(const fs::path& folder) {
  ResultsLog log;
  for (const fs::path& path : results_files(folder)) log.read_lines(path);
  return log;
}

ResultsLog::ResultsLog(ResultsLog&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      finished_(std::move(other.finished_)) {}

ResultsLog::~ResultsLog() {
  if (file_ >= 0) ::close(file_);
}

const MetricValues* ResultsLog::find(const std::string& key) const {
  const auto found = finished_.find(key);
  return found == finished_.end() ? nullptr : &found->second;
}

std::optional<Error> ResultsLog::append(const std::string& key, const MetricValues& values) {
  Json metrics = Json::object();
  for (const auto& [name, value] : values) metrics[name] = value ? Json(*value) : Json(nullptr);
  const std::string line = Json{{"trial", key}, {"metrics", metrics}}.dump() + "\n";
  if (::write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    return Error{path_.string(), 0, "", "cannot be written: is the disk full?"};
  }
  finished_[key] = values;
  return std::nullopt;
}

/// What another process is just writing, the last line without its end, is left out.
void ResultsLog::read_lines(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    const Json entry = Json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (!entry.is_object() || !entry.contains("trial") || !entry["trial"].is_string() ||
        !entry.contains("metrics") || !entry["metrics"].is_object()) {
      continue;
    }
    MetricValues values;
    for (const auto& [name, value] : entry["metrics"].items()) {
      values[name] = value.is_number() ? Number(value.get<double>()) : std::nullopt;
    }
    finished_[entry["trial"].get<std::string>()] = std::move(values);
  }
}

std::vector<unsigned> shard_counts(const fs::path& folder) {
  std::set<unsigned> counts;
  for (const fs::path& path : results_files(folder)) {
    unsigned index = 0, count = 0;
    const int found =
        std::sscanf(path.stem().string().c_str(), "results-%uof%u", &index, &count);  // NOLINT
    if (found == 2 && count > 0) counts.insert(count);
  }
  return {counts.begin(), counts.end()};
}

}  // namespace pirouette
