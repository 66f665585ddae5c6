#include "pirouette/trial/trace_file.hpp"

#include <cstring>
#include <type_traits>

#include "pirouette/trial/npy.hpp"

namespace pirouette {
namespace {

/// NumPy type and shape of a column's value.
struct ColumnType {
  const char* dtype;       ///< such as <f8
  std::vector<int> shape;  ///< such as 4, 3; empty for a scalar

  /// The shape as Python writes a tuple, such as (4,) or (4, 3).
  std::string shape_text() const {
    std::string text = "(";
    for (const int n : shape) text.append(text.size() > 1 ? ", " : "").append(std::to_string(n));
    return text.append(shape.size() == 1 ? ",)" : ")");
  }
};

template <class T>
  requires std::is_arithmetic_v<T>
ColumnType column_type(const T&) {
  if constexpr (std::is_same_v<T, double>) return {"<f8", {}};
  if constexpr (std::is_same_v<T, int>) return {"<i4", {}};
  if constexpr (std::is_same_v<T, bool>) return {"|b1", {}};
}
template <int N>
ColumnType column_type(const Eigen::Matrix<double, N, 1>&) {
  return {"<f8", {N}};
}
template <class T>
ColumnType column_type(const PerLeg<T>& value) {
  ColumnType type = column_type(value[Leg::kFR]);
  type.shape.insert(type.shape.begin(), static_cast<int>(kLegCount));
  return type;
}

template <class T>
void append_bytes(std::vector<char>& out, const T* values, std::size_t count) {
  const std::size_t at = out.size();
  out.resize(at + count * sizeof(T));
  std::memcpy(out.data() + at, values, count * sizeof(T));
}

template <class T>
  requires std::is_arithmetic_v<T>
void append_value(std::vector<char>& out, const T& value) {
  append_bytes(out, &value, 1);
}
template <int N>
void append_value(std::vector<char>& out, const Eigen::Matrix<double, N, 1>& value) {
  append_bytes(out, value.data(), N);
}
template <class T>
void append_value(std::vector<char>& out, const PerLeg<T>& value) {
  for (const T& leg : value) append_value(out, leg);
}

/// Its length does not depend on `rows`, so that it can be written again over itself.
std::string trace_header(std::uint64_t rows) {
  std::string fields;
  const TickTrace tick;
  const PlantTruth truth;
  TraceRow::columns({tick, truth}, [&](const char* name, const char*, const char*,
                                       const auto& value) {
    const ColumnType type = column_type(value);
    fields.append(fields.empty() ? "('" : ", ('").append(name).append("', '").append(type.dtype);
    fields.append("'");
    if (!type.shape.empty()) fields.append(", ").append(type.shape_text());
    fields.append(")");
  });
  constexpr std::size_t kRowDigits = 20;  // of the largest 64-bit number
  const std::string count = std::to_string(rows);
  return npy_header("[" + fields + "]", "(" + count + ",)", kRowDigits - count.size());
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
  std::string out = "| column | type | unit | meaning |\n|---|---|---|---|\n";
  const TickTrace tick;
  const PlantTruth truth;
  TraceRow::columns({tick, truth}, [&](const char* name, const char* unit, const char* meaning,
                                       const auto& value) {
    const ColumnType type = column_type(value);
    out.append("| `").append(name).append("` | ").append(type.dtype + 1);  // without the byte order
    if (!type.shape.empty()) out.append(" ").append(type.shape_text());
    out.append(" | ").append(unit).append(" | ").append(meaning).append(" |\n");
  });
  return out;
}

}  // namespace pirouette
