// File of rows of a NumPy structured array, written one by one; `numpy.load` reads it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pirouette/base/npy_rows.hpp"
#include "pirouette/base/result.hpp"

namespace pirouette {

/// File that grows by rows. The number of rows in its header is right after finish().
class NpyRowsFile {
 public:
  /// Header of the file for a number of rows; of the same length for any number.
  using Header = std::function<std::string(std::uint64_t)>;

  /// Creates the file `path`. The error names it when it cannot be written.
  static Result<NpyRowsFile> create(const std::filesystem::path& path, Header header);

  /// Appends one row; Row lists its columns (base/npy_rows.hpp).
  template <class Row>
  void append(const Row& row) {
    row_.clear();
    append_row(row_, row);
    stream_.write(row_.data(), static_cast<std::streamsize>(row_.size()));
    ++rows_;
  }

  /// Completes the header and closes the file. Returns the error when anything could not be
  /// written; absent: done.
  std::optional<Error> finish();

 private:
  NpyRowsFile(std::filesystem::path path, Header header);

  std::filesystem::path path_;
  Header header_;
  std::ofstream stream_;
  std::vector<char> row_;
  std::uint64_t rows_ = 0;
};

/// Rows of a file that NpyRowsFile wrote with the columns of Row. An error for any other file.
template <class Row>
Result<std::vector<Row>> read_npy_rows(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return Error{path.string(), 0, "", "cannot be read"};
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  const Row row;
  std::vector<char> example;
  append_row(example, row);
  const std::size_t head = npy_rows_header(row, 0).size();
  const std::size_t rows = text.size() > head ? (text.size() - head) / example.size() : 0;
  const std::string expected = npy_rows_header(row, rows);
  if (!text.starts_with(expected) || text.size() != head + rows * example.size()) {
    return Error{path.string(), 0, "",
                 "is not a complete file of this version's rows; allowed: what this version wrote"};
  }
  std::vector<Row> out(rows);
  const char* at = text.data() + head;
  for (Row& filled : out) {
    Row::columns(filled, [&](const char*, const char*, const char*, auto& value) {
      at = take_value(at, value);
    });
  }
  return out;
}

}  // namespace pirouette
