#include "pirouette/trial/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "pirouette/base/npy.hpp"
#include "pirouette/plant/terrain.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockFile = "lock";
constexpr const char* kPartSuffix = ".pirouette-part";
constexpr std::string_view kLockText = "part of a run that pirouette writes\n";
constexpr const char* kRecordHead =
    "# What pirouette wrote into this folder. --force replaces these files and nothing else.";

Error out_error(const fs::path& path, std::string message) {
  return {path.string(), 0, "", std::move(message)};
}

Error system_error(const fs::path& path, const char* what) {
  return out_error(path, std::string(what) + ": " + std::strerror(errno));
}

bool may_be_recorded(const std::string& name) {
  return std::find(kRunFiles.begin(), kRunFiles.end(), name) != kRunFiles.end() ||
         std::find(kDerivedFiles.begin(), kDerivedFiles.end(), name) != kDerivedFiles.end();
}

bool is_regular(const fs::path& path) { return fs::is_regular_file(fs::symlink_status(path)); }

bool is_part_name(const std::string& name) {
  return name.starts_with('.') && name.ends_with(kPartSuffix);
}

/// Names in the record of `folder` of files that are there; empty without a record of ours.
std::vector<std::string> recorded_files(const fs::path& folder) {
  std::vector<std::string> names;
  std::ifstream record(folder / kRecordFile);
  std::string line;
  if (!std::getline(record, line) || line != kRecordHead) return names;
  while (std::getline(record, line)) {
    // Another name is not believed, whoever wrote it there.
    if (may_be_recorded(line) && is_regular(folder / line)) names.push_back(line);
  }
  return names;
}

std::string record_text(const std::vector<std::string>& names) {
  std::string text = std::string(kRecordHead) + "\n";
  for (const std::string& name : names) text += name + "\n";
  return text;
}

/// What is wrong with putting a run at `path`, as far as one can see without writing.
std::optional<Error> check_target(const fs::path& path, bool replace) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return std::nullopt;
  if (!fs::is_directory(status)) return out_error(path, "is a file; allowed: a folder for the run");
  const bool empty = fs::is_empty(path, error);
  if (error) return out_error(path, error.message());
  if (empty) return std::nullopt;
  const std::vector<std::string> ours = recorded_files(path);
  if (ours.empty()) {
    return out_error(path, std::string("is a folder with other things in it; allowed: a new or "
                                       "empty folder, or with --force one whose ") +
                               kRecordFile + " lists the files of an earlier run");
  }
  if (!replace) {
    return out_error(path,
                     "holds an earlier run; allowed: a new or empty folder, or --force to replace "
                     "the files of that run");
  }
  for (const char* name : kRunFiles) {
    const bool listed = std::find(ours.begin(), ours.end(), name) != ours.end();
    if (!listed && fs::exists(fs::symlink_status(path / name))) {
      return out_error(path / name, std::string("is no file of the earlier run: ") + kRecordFile +
                                        " does not list it; move it away first");
    }
  }
  return std::nullopt;
}

std::optional<Error> check_space(const fs::path& folder, std::uintmax_t size) {
  std::error_code error;
  const fs::space_info space = fs::space(folder.parent_path(), error);
  if (error || space.available >= size) return std::nullopt;
  constexpr double kMegabyte = 1e6;
  const auto megabytes = [](std::uintmax_t bytes) {
    return std::to_string(static_cast<std::int64_t>(static_cast<double>(bytes) / kMegabyte)) +
           " MB";
  };
  return out_error(folder, "the disk has " + megabytes(space.available) +
                               " left, and the run needs " + megabytes(size) +
                               "; run.trace_rate and run.turns make it smaller");
}

/// `path` as an absolute one with links followed; the error when it is a link to nothing.
Result<fs::path> final_place(const fs::path& path) {
  if (path.empty()) return Error{"", 0, "", "the run folder has no name"};
  std::error_code error;
  fs::path place = fs::absolute(path, error).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  if (error) return out_error(path, error.message());
  for (fs::path p = place; p.has_relative_path(); p = p.parent_path()) {
    if (fs::is_symlink(fs::symlink_status(p, error)) && !fs::exists(p, error)) {
      return out_error(p,
                       "is a link to nothing; allowed: a folder, or a name that is not there yet");
    }
  }
  place = fs::weakly_canonical(place, error);
  if (error) return out_error(path, error.message());
  if (is_part_name(place.filename().string())) {
    return out_error(place, "is a name of unfinished runs, which are cleaned up; allowed: another");
  }
  return place;
}

/// True when this product made the part folder `part`: its lock says so, or nothing but an empty
/// lock is in it. A link, or a folder that only has the name, is somebody else's.
bool is_ours(const fs::path& part) {
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(part, error))) return false;
  if (is_regular(part / kLockFile)) {
    std::ifstream lock(part / kLockFile, std::ios::binary);
    const std::string text((std::istreambuf_iterator<char>(lock)), {});
    if (text == kLockText) return true;
    if (!text.empty()) return false;
  }
  const fs::directory_iterator entries(part, error);
  return !error && std::all_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return entry.path().filename() == kLockFile && is_regular(entry.path());
  });
}

fs::path part_of(const fs::path& path) {
  return path.parent_path() / ("." + path.filename().string() + kPartSuffix);
}

/// File descriptor of the lock of the existing folder `part`; -1 with errno when there is none to
/// be had: EWOULDBLOCK when a living process holds it.
int take_lock(const fs::path& part) {
  const std::string file = part / kLockFile;
  const int lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (lock < 0) return lock;
  struct stat held {
  }, there{};
  if (::flock(lock, LOCK_EX | LOCK_NB) == 0 && ::fstat(lock, &held) == 0 &&
      ::stat(file.c_str(), &there) == 0) {
    const bool same = held.st_ino == there.st_ino && held.st_dev == there.st_dev;
    if (same && is_ours(part) && ::ftruncate(lock, 0) == 0 &&
        ::pwrite(lock, kLockText.data(), kLockText.size(), 0) ==
            static_cast<ssize_t>(kLockText.size())) {
      return lock;
    }
    // ENOENT: its owner moved the folder to its place meanwhile.
    errno = same ? EEXIST : ENOENT;
  }
  const int why = errno;
  ::close(lock);
  errno = why;
  return -1;
}

/// Removes what this product writes into a part folder; the lock stays.
void clear_part(const fs::path& part) {
  std::error_code ignored;
  for (const char* name : kRunFiles) fs::remove(part / name, ignored);
}

/// Removes the part folder whose lock is held, unless there are things of others in it.
void remove_part(const fs::path& part) {
  std::error_code ignored;
  clear_part(part);
  fs::remove(part / kLockFile, ignored);
  fs::remove(part, ignored);
}

/// Removes the part folders in `parent` of processes that were killed.
void clean_left_overs(const fs::path& parent) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, error)) {
    const std::string name = entry.path().filename().string();
    if (!is_part_name(name) || !is_ours(entry.path()) || !is_regular(entry.path() / kLockFile)) {
      continue;
    }
    const int lock = take_lock(entry.path());
    if (lock < 0) continue;
    remove_part(entry.path());
    ::close(lock);
  }
}

/// Creates the part folder of `path` and takes its lock.
Result<int> lock_part(const fs::path& path) {
  const fs::path part = part_of(path);
  for (;;) {
    if (::mkdir(part.c_str(), 0777) != 0 && errno != EEXIST) {
      return system_error(path, "cannot be created");
    }
    if (fs::exists(fs::symlink_status(part)) && !is_ours(part)) {
      return out_error(part, "is in the way and was not made by pirouette; move it away first");
    }
    const int lock = take_lock(part);
    if (lock >= 0) return lock;
    if (errno == EWOULDBLOCK) {
      return out_error(path, "is being written by another process; allowed: another folder");
    }
    if (errno != ENOENT) return system_error(path, "cannot be created");
  }
}

}  // namespace

Result<RunFolder> RunFolder::open(const fs::path& path, const RunFolderOptions& options) {
  const Result<fs::path> place = final_place(path);
  if (!place) return place.errors();
  RunFolder folder;
  folder.path_ = place.value();
  folder.options_ = options;
  if (const auto wrong = check_target(folder.path_, options.replace)) return *wrong;

  std::error_code error;
  const fs::path parent = folder.path_.parent_path();
  for (fs::path p = parent; !p.empty() && !fs::exists(p, error); p = p.parent_path()) {
    folder.created_parents_.push_back(p);
  }
  fs::create_directories(parent, error);
  if (error) return out_error(folder.path_, "cannot be created: " + error.message());
  clean_left_overs(parent);
  const Result<int> lock = lock_part(folder.path_);
  if (!lock) return lock.errors();
  folder.lock_ = lock.value();
  folder.part_ = part_of(folder.path_);
  clear_part(folder.part_);
  if (const auto wrong = check_space(folder.path_, options.size)) return *wrong;
  // A folder that is there stays, with its owner and permissions, and gets the files.
  struct stat own {
  }, beside{};
  if (::stat(folder.path_.c_str(), &own) == 0 && ::stat(folder.part_.c_str(), &beside) == 0 &&
      own.st_dev != beside.st_dev) {
    return out_error(folder.path_, "is a disk of its own; allowed: a folder in it");
  }
  if (fs::exists(folder.path_, error) && ::access(folder.path_.c_str(), W_OK | X_OK) != 0) {
    return system_error(folder.path_, "cannot be written");
  }
  return folder;
}

Result<RunFolder> RunFolder::open_next(const fs::path& path, const RunFolderOptions& options) {
  constexpr int kMostRuns = 10000;  // of one name: nobody has as many
  for (int number = 1;; ++number) {
    const fs::path name =
        number == 1 ? path : fs::path(path.string() + "-" + std::to_string(number));
    std::error_code error;
    const bool taken =
        fs::exists(fs::symlink_status(name, error)) || fs::exists(part_of(name), error);
    Result<RunFolder> folder = open(name, options);
    // Where nothing is in the way the next name fails as well.
    if (folder || !taken || number == kMostRuns) return folder;
  }
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)),
      part_(std::exchange(other.part_, {})),
      created_parents_(std::exchange(other.created_parents_, {})),
      options_(other.options_),
      lock_(std::exchange(other.lock_, -1)) {}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!part_.empty()) remove_part(part_);
  if (lock_ >= 0) ::close(lock_);
  for (const fs::path& parent : created_parents_) fs::remove(parent, ignored);  // only when empty
}

std::optional<Error> RunFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream stream(file(name), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) return out_error(file(name), "cannot be written: is the disk full?");
  return std::nullopt;
}

std::optional<Error> RunFolder::commit() {
  // It may have changed meanwhile.
  if (const auto wrong = check_target(path_, options_.replace)) return wrong;
  std::vector<std::string> names;
  for (const char* name : kRunFiles) {
    if (is_regular(part_ / name) || name == std::string_view(kRecordFile)) names.emplace_back(name);
  }
  if (auto error = write(kRecordFile, record_text(names))) return error;

  std::error_code error;
  if (!fs::exists(path_, error)) {
    fs::rename(part_, path_, error);
    if (error) return out_error(path_, "cannot be written: " + error.message());
    fs::remove(path_ / kLockFile, error);
    part_.clear();
  } else if (auto failed = replace_files(names)) {
    return failed;
  }
  created_parents_.clear();
  return std::nullopt;
}

/// Puts the files `names` of the part folder in the place of those of the earlier run. A process
/// that is killed meanwhile leaves whole files, all of them in the record.
std::optional<Error> RunFolder::replace_files(const std::vector<std::string>& names) const {
  const std::vector<std::string> before = recorded_files(path_);
  std::vector<std::string> all = names;
  std::copy_if(before.begin(), before.end(), std::back_inserter(all), [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) == names.end();
  });
  const auto set_record = [&](const std::vector<std::string>& listed) -> std::optional<Error> {
    if (auto error = write(kRecordFile, record_text(listed))) return error;
    std::error_code error;
    fs::rename(part_ / kRecordFile, path_ / kRecordFile, error);
    if (error) return out_error(path_, "cannot be written: " + error.message());
    return std::nullopt;
  };
  if (auto error = set_record(all)) return error;
  std::error_code error;
  for (const std::string& name : names) {
    if (name != kRecordFile) fs::rename(part_ / name, path_ / name, error);
    if (error) return out_error(path_ / name, "cannot be written: " + error.message());
  }
  for (const std::string& name : before) {
    if (std::find(names.begin(), names.end(), name) == names.end()) fs::remove(path_ / name, error);
  }
  return set_record(names);
}

std::optional<Error> write_terrain(const RunFolder& folder, const std::string& text,
                                   std::uint64_t seed) {
  const Result<TerrainSpec> spec = parse_terrain(text);
  if (!spec) return spec.errors().front();
  const Terrain terrain(spec.value(), seed);

  const int half = static_cast<int>(std::lround(kTerrainHalfExtent / kTerrainPitch));
  const std::string side = std::to_string(2 * half + 1);
  std::string file = npy_header("'<f4'", "(" + side + ", " + side + ")");
  for (int row = -half; row <= half; ++row) {
    for (int column = -half; column <= half; ++column) {
      const auto height = static_cast<float>(terrain.height(kTerrainPitch * Vec2(column, row)));
      const auto bytes = std::bit_cast<std::array<char, sizeof height>>(height);
      file.append(bytes.data(), bytes.size());
    }
  }
  return folder.write(kTerrainFile, file);
}

}  // namespace pirouette
