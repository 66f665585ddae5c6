#include "pirouette/base/npy_rows_file.hpp"

#include <utility>

namespace pirouette {

NpyRowsFile::NpyRowsFile(std::filesystem::path path, Header header)
    : path_(std::move(path)),
      header_(std::move(header)),
      stream_(path_, std::ios::binary | std::ios::trunc) {
  const std::string head = header_(0);
  stream_.write(head.data(), static_cast<std::streamsize>(head.size()));
  stream_.flush();
}

Result<NpyRowsFile> NpyRowsFile::create(const std::filesystem::path& path, Header header) {
  NpyRowsFile file(path, std::move(header));
  if (!file.stream_) return Error{path.string(), 0, "", "cannot be written"};
  return file;
}

std::optional<Error> NpyRowsFile::finish() {
  const std::string head = header_(rows_);
  stream_.seekp(0);
  stream_.write(head.data(), static_cast<std::streamsize>(head.size()));
  stream_.close();
  if (!stream_) return Error{path_.string(), 0, "", "cannot be written: is the disk full?"};
  return std::nullopt;
}

}  // namespace pirouette
