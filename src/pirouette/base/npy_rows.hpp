// Rows of a NumPy structured array, from and to structs that list their columns.
//
// Such a struct has a static `columns(self, visit)` that calls visit(name, unit, meaning, value)
// for each column. A value is a double, int, bool, column vector of doubles, or a PerLeg of one of
// them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/npy.hpp"

namespace pirouette {

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

/// Type of a number.
template <class T>
  requires std::is_arithmetic_v<T>
ColumnType column_type(const T&) {
  if constexpr (std::is_same_v<T, double>) return {"<f8", {}};
  if constexpr (std::is_same_v<T, int>) return {"<i4", {}};
  if constexpr (std::is_same_v<T, bool>) return {"|b1", {}};
}
/// Type of a column vector.
template <int N>
ColumnType column_type(const Eigen::Matrix<double, N, 1>&) {
  return {"<f8", {N}};
}
/// Type of a value for each leg.
template <class T>
ColumnType column_type(const PerLeg<T>& value) {
  ColumnType type = column_type(value[Leg::kFR]);
  type.shape.insert(type.shape.begin(), static_cast<int>(kLegCount));
  return type;
}

/// Appends the bytes of a number, as they lie in memory, to `out`.
template <class T>
  requires std::is_arithmetic_v<T>
void append_value(std::vector<char>& out, const T& value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  std::memcpy(out.data() + at, &value, sizeof(T));
}
/// Appends the elements of a column vector to `out`.
template <int N>
void append_value(std::vector<char>& out, const Eigen::Matrix<double, N, 1>& value) {
  for (const double element : value) append_value(out, element);
}
/// Appends the values of FR, FL, RR and RL to `out`.
template <class T>
void append_value(std::vector<char>& out, const PerLeg<T>& value) {
  for (const T& leg : value) append_value(out, leg);
}

/// Sets `value` from the bytes at `from`; returns where the next value begins.
template <class T>
  requires std::is_arithmetic_v<T>
const char* take_value(const char* from, T& value) {
  std::memcpy(&value, from, sizeof(T));
  return from + sizeof(T);
}
/// The same for a column vector.
template <int N>
const char* take_value(const char* from, Eigen::Matrix<double, N, 1>& value) {
  for (double& element : value) from = take_value(from, element);
  return from;
}
/// The same for the values of FR, FL, RR and RL.
template <class T>
const char* take_value(const char* from, PerLeg<T>& value) {
  for (T& leg : value) from = take_value(from, leg);
  return from;
}

/// Appends the bytes of every column to `out`.
template <class Row>
void append_row(std::vector<char>& out, const Row& row) {
  Row::columns(row, [&](const char*, const char*, const char*, const auto& value) {
    append_value(out, value);
  });
}

/// Header of a file of `rows` rows like `row`. Its length does not depend on `rows`, so that it can
/// be overwritten in place.
template <class Row>
std::string npy_rows_header(const Row& row, std::uint64_t rows) {
  std::string fields;
  Row::columns(row, [&](const char* name, const char*, const char*, const auto& value) {
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

/// Table of every column of `row` with its NumPy type, unit and meaning, in Markdown.
template <class Row>
std::string npy_rows_markdown(const Row& row) {
  std::string out = "| column | type | unit | meaning |\n|---|---|---|---|\n";
  Row::columns(row, [&](const char* name, const char* unit, const char* meaning,
                        const auto& value) {
    const ColumnType type = column_type(value);
    out.append("| `").append(name).append("` | ").append(type.dtype + 1);  // without the byte order
    if (!type.shape.empty()) out.append(" ").append(type.shape_text());
    out.append(" | ").append(unit).append(" | ").append(meaning).append(" |\n");
  });
  return out;
}

}  // namespace pirouette
