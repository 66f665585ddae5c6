#include "pirouette/study/results_log.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <set>
#include <string_view>
#include <utility>

namespace pirouette {
namespace {

namespace fs = std::filesystem;

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

Error unwritable(const fs::path& path) { return {path.string(), 0, "", "cannot be written"}; }

/// Whether `path` is still the file that `file` has open: another process may have replaced it.
bool is_current(const fs::path& path, int file) {
  struct stat opened {
  }, named{};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

/// The file's descriptor; nobody else can lock it until that is closed.
Result<int> open_locked(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return unwritable(path);
  if (::flock(file, LOCK_EX | LOCK_NB) == 0 && is_current(path, file)) return file;
  ::close(file);
  return in_use(path);
}

bool write_all(int file, std::string_view text) {
  return ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

/// Calls visit(line, number, whole) for each line; `whole`: it has its end.
template <class Visit>
void for_each_line(const fs::path& path, Visit&& visit) {
  std::ifstream stream(path, std::ios::binary);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) visit(line, number, !stream.eof());
}

/// Replaces the file, which the caller has locked, by one without those of `lines` that still stand
/// there: it is whole at any moment. The descriptor of the new file, locked.
Result<int> without_lines(const fs::path& path, const NumberedLines& lines) {
  std::string text;
  for_each_line(path, [&](const std::string& line, int number, bool whole) {
    const auto found = lines.find(number);
    const bool rejected = found != lines.end() && found->second == line;
    if (whole && !rejected) text += line + "\n";
  });
  const fs::path part = path.string() + ".part";
  std::error_code error;
  fs::remove(part, error);
  const Result<int> file = open_locked(part);
  if (!file) return file.errors();
  if (write_all(file.value(), text)) {
    fs::rename(part, path, error);
    if (!error) return file.value();
  }
  ::close(file.value());
  fs::remove(part, error);
  return unwritable(path);
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
    if (::ftruncate(log.file_, 0) != 0) return unwritable(log.path_);
    return log;
  }
  for (const fs::path& path : results_files(folder)) log.read_lines(path);
  if (const auto error = log.remove_rejected()) return *error;
  return log;
}

ResultsLog ResultsLog::read(const fs::path& folder) {
  ResultsLog log;
  for (const fs::path& path : results_files(folder)) log.read_lines(path);
  return log;
}

ResultsLog::ResultsLog(ResultsLog&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, -1)),
      entries_(std::move(other.entries_)),
      contradicted_(std::move(other.contradicted_)),
      rejected_(std::move(other.rejected_)),
      rejected_lines_(std::move(other.rejected_lines_)) {}

ResultsLog::~ResultsLog() {
  if (file_ >= 0) ::close(file_);
}

const MetricValues* ResultsLog::find(const std::string& key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? nullptr : &found->second.line.values;
}

std::optional<Error> ResultsLog::append(ResultsLine line) {
  // A trial whose trace was lost has its result already.
  const MetricValues* known = find(line.key);
  if (known != nullptr && *known == line.values) return std::nullopt;
  if (!write_all(file_, to_text(line) + "\n")) {
    return Error{path_.string(), 0, "", "cannot be written: is the disk full?"};
  }
  const std::string key = line.key;
  entries_.insert_or_assign(key, Entry{std::move(line), path_, 0});
  return std::nullopt;
}

/// The last line without its end is what a killed process has left, or, in another's file, what it
/// is just writing.
void ResultsLog::read_lines(const fs::path& path) {
  for_each_line(path, [&](const std::string& text, int number, bool whole) {
    if (!whole) {
      if (path == path_) reject(path, number, text, {"", 0, "", "is cut off, as by a kill"});
      return;
    }
    Result<ResultsLine> line = parse_results_line(text);
    if (line) {
      add(std::move(line).value(), path, number);
    } else {
      reject(path, number, text, line.errors().front());
    }
  });
}

void ResultsLog::add(ResultsLine line, const fs::path& path, int number) {
  const auto found = entries_.find(line.key);
  if (found == entries_.end() && !contradicted_.contains(line.key)) {
    std::string key = line.key;
    entries_.emplace(std::move(key), Entry{std::move(line), path, number});
  } else if (found != entries_.end() && found->second.line.values == line.values) {
    reject(path, number, to_text(line),
           {"", 0, "",
            "is the result at " + found->second.file.string() + ":" +
                std::to_string(found->second.number) + " again"});
  } else {
    reject_contradiction(line, path, number);
    if (found == entries_.end()) return;
    const Entry first = found->second;
    contradicted_.insert(line.key);
    entries_.erase(found);
    reject_contradiction(first.line, first.file, first.number);
  }
}

void ResultsLog::reject_contradiction(const ResultsLine& line, const fs::path& path, int number) {
  reject(path, number, to_text(line),
         {"", 0, "", "has other values than another line for the same trial, " + line.key});
}

void ResultsLog::reject(const fs::path& path, int number, const std::string& text, Error why) {
  why.file = path.string();
  why.line = number;
  rejected_.push_back(std::move(why));
  rejected_lines_[path].emplace(number, text);
}

/// Another process keeps what it has locked, and what may not be written.
std::optional<Error> ResultsLog::remove_rejected() {
  for (const auto& [path, lines] : rejected_lines_) {
    const Result<int> locked = path == path_ ? Result<int>(file_) : open_locked(path);
    if (!locked) continue;
    const Result<int> replaced = without_lines(path, lines);
    ::close(locked.value());
    if (path == path_) file_ = replaced ? replaced.value() : -1;
    if (!replaced && path == path_) return replaced.errors().front();
    if (replaced && path != path_) ::close(replaced.value());
  }
  return std::nullopt;
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
