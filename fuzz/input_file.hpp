// Fuzzers get bytes; the loaders under test take files.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "pirouette/base/result.hpp"

namespace pirouette::fuzz {

/// A file of this process, in memory where the system has such a folder, rewritten for each input.
class InputFile {
 public:
  explicit InputFile(const std::string& extension) {
    const std::filesystem::path memory = "/dev/shm";
    std::error_code error;
    const auto folder =
        std::filesystem::exists(memory, error) ? memory : std::filesystem::temp_directory_path();
    path_ = folder / ("pirouette_fuzz_" + std::to_string(::getpid()) + extension);
  }
  ~InputFile() { std::remove(path_.c_str()); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::filesystem::path& write(const std::uint8_t* data, std::size_t size) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr || std::fwrite(data, 1, size, file) != size) std::abort();
    std::fclose(file);
    return path_;
  }

 private:
  std::filesystem::path path_;
};

/// Ends the process when `holds` is false, so that the fuzzer keeps the input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// What is refused is refused in words.
template <class T>
void require_reasons(const Result<T>& refused) {
  require(!refused.errors().empty(), "a refusal has a reason");
  for (const Error& error : refused.errors()) require(!error.message.empty(), "errors have words");
}

}  // namespace pirouette::fuzz
