#include "pirouette/trial/trace_file.hpp"

#include <utility>

#include "pirouette/base/npy_rows.hpp"

namespace pirouette {
namespace {

std::string trace_header(std::uint64_t rows) {
  const TickTrace tick;
  const PlantTruth truth;
  return npy_rows_header(TraceRow{tick, truth}, rows);
}

}  // namespace

TraceFile::TraceFile(std::filesystem::path path)
    : path_(std::move(path)), stream_(path_, std::ios::binary | std::ios::trunc) {
  const std::string header = trace_header(0);
  stream_.write(header.data(), static_cast<std::streamsize>(header.size()));
  stream_.flush();
}

Result<TraceFile> TraceFile::create(const std::filesystem::path& path) {
  TraceFile file(path);
  if (!file.stream_) return Error{path.string(), 0, "", "cannot be written"};
  return file;
}

void TraceFile::append(const TraceRow& row) {
  row_.clear();
  TraceRow::columns(row, [&](const char*, const char*, const char*, const auto& value) {
    append_value(row_, value);
  });
  stream_.write(row_.data(), static_cast<std::streamsize>(row_.size()));
  ++rows_;
}

std::optional<Error> TraceFile::finish() {
  const std::string header = trace_header(rows_);
  stream_.seekp(0);
  stream_.write(header.data(), static_cast<std::streamsize>(header.size()));
  stream_.close();
  if (!stream_) return Error{path_.string(), 0, "", "cannot be written: is the disk full?"};
  return std::nullopt;
}

std::string trace_markdown() {
  const TickTrace tick;
  const PlantTruth truth;
  return npy_rows_markdown(TraceRow{tick, truth});
}

}  // namespace pirouette
