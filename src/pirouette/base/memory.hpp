// State of objects as bytes and back, for snapshots.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pirouette/base/legs.hpp"

namespace pirouette {

/// True for a class that lists its state in
///
///   template <class Self, class Visit>
///   static void memory(Self& self, Visit&& visit) {
///     auto& [config, mean, weight] = self;  // names every member, or does not compile
///     visit(mean, weight);
///   }
///
/// Members may be numbers, bool, enums, Eigen matrices and quaternions of fixed size;
/// std::optional, std::variant, std::vector, std::array and PerLeg of what may be a member; classes
/// that list their state; and plain structs of up to twelve members, none optional, which need no
/// list.
template <class T>
concept ListsMemory = requires(T& value, void (*visit)()) { T::memory(value, visit); };

namespace detail {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsVariant = false;
template <class... T>
inline constexpr bool kIsVariant<std::variant<T...>> = true;
template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t N>
inline constexpr bool kIsArray<std::array<T, N>> = true;
template <class T>
inline constexpr bool kIsPerLeg = false;
template <class T>
inline constexpr bool kIsPerLeg<PerLeg<T>> = true;
template <class T>
inline constexpr bool kIsQuaternion = false;
template <class Scalar, int Options>
inline constexpr bool kIsQuaternion<Eigen::Quaternion<Scalar, Options>> = true;
template <class T>
inline constexpr bool kIsMatrix = std::is_base_of_v<Eigen::MatrixBase<T>, T>;
template <class T>
  requires(!std::is_class_v<T>)
inline constexpr bool kIsMatrix<T> = false;

/// Converts to a member of any type but std::optional, which accepts any value by itself.
struct Anything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor): never called
};

template <class T, std::size_t... I>
consteval bool takes(std::index_sequence<I...>) {
  return requires { T{(static_cast<void>(I), Anything{})...}; };
}

/// Members of a plain struct: as many initialisers as it takes.
template <class T, std::size_t N = 13>
consteval std::size_t member_count() {
  if constexpr (N == 0 || takes<T>(std::make_index_sequence<N>())) {
    return N;
  } else {
    return member_count<T, N - 1>();
  }
}

template <class T, class Visit>
void visit_members(T& s, Visit&& v) {
  constexpr std::size_t kCount = member_count<std::remove_const_t<T>>();
  static_assert(kCount >= 1 && kCount <= 12, "give it a list: memory()");
  if constexpr (kCount == 1) {
    auto& [a] = s;
    v(a);
  } else if constexpr (kCount == 2) {
    auto& [a, b] = s;
    v(a, b);
  } else if constexpr (kCount == 3) {
    auto& [a, b, c] = s;
    v(a, b, c);
  } else if constexpr (kCount == 4) {
    auto& [a, b, c, d] = s;
    v(a, b, c, d);
  } else if constexpr (kCount == 5) {
    auto& [a, b, c, d, e] = s;
    v(a, b, c, d, e);
  } else if constexpr (kCount == 6) {
    auto& [a, b, c, d, e, f] = s;
    v(a, b, c, d, e, f);
  } else if constexpr (kCount == 7) {
    auto& [a, b, c, d, e, f, g] = s;
    v(a, b, c, d, e, f, g);
  } else if constexpr (kCount == 8) {
    auto& [a, b, c, d, e, f, g, h] = s;
    v(a, b, c, d, e, f, g, h);
  } else if constexpr (kCount == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = s;
    v(a, b, c, d, e, f, g, h, i);
  } else if constexpr (kCount == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = s;
    v(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (kCount == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = s;
    v(a, b, c, d, e, f, g, h, i, j, k);
  } else {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l] = s;
    v(a, b, c, d, e, f, g, h, i, j, k, l);
  }
}

}  // namespace detail

/// Appends what it visits to a vector, in the machine's byte order and without padding.
class MemoryWriter {
 public:
  /// `out` must outlive the writer.
  explicit MemoryWriter(std::vector<std::byte>& out) : out_(out) {}

  /// Appends `members`.
  template <class... T>
  void operator()(const T&... members) {
    (write(members), ...);
  }

 private:
  void bytes(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    out_.insert(out_.end(), first, first + size);
  }
  template <class Range>
  void each(const Range& range) {
    for (const auto& element : range) write(element);
  }

  template <class T>
  void write(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      bytes(&value, sizeof value);
    } else if constexpr (detail::kIsQuaternion<T>) {
      write(value.coeffs());
    } else if constexpr (detail::kIsMatrix<T>) {
      static_assert(T::SizeAtCompileTime != Eigen::Dynamic);
      bytes(value.data(), sizeof(typename T::Scalar) * T::SizeAtCompileTime);
    } else if constexpr (detail::kIsOptional<T>) {
      write(value.has_value());
      if (value) write(*value);
    } else if constexpr (detail::kIsVariant<T>) {
      write(static_cast<std::uint64_t>(value.index()));
      std::visit([this](const auto& alternative) { write(alternative); }, value);
    } else if constexpr (detail::kIsVector<T>) {
      write(static_cast<std::uint64_t>(value.size()));
      each(value);
    } else if constexpr (detail::kIsArray<T> || detail::kIsPerLeg<T>) {
      each(value);
    } else if constexpr (ListsMemory<const T>) {
      T::memory(value, *this);
    } else {
      detail::visit_members(value, *this);
    }
  }

  std::vector<std::byte>& out_;
};

/// Sets what it visits from bytes that a MemoryWriter made of the same members.
class MemoryReader {
 public:
  /// `in` must outlive the reader.
  explicit MemoryReader(std::span<const std::byte> in) : in_(in) {}

  /// Sets `members`; unchanged or partly set when bytes are missing, see complete().
  template <class... T>
  void operator()(T&... members) {
    (read(members), ...);
  }

  /// True when every byte has been used and none was missing.
  bool complete() const { return ok_ && in_.empty(); }

 private:
  void bytes(void* data, std::size_t size) {
    ok_ = ok_ && size <= in_.size();
    if (!ok_) return;
    std::memcpy(data, in_.data(), size);
    in_ = in_.subspan(size);
  }
  template <class Range>
  void each(Range& range) {
    for (auto& element : range) read(element);
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    bytes(&value, sizeof value);
    return value;
  }
  bool flag() {
    unsigned char value = 0;
    bytes(&value, sizeof value);
    return value != 0;
  }

  template <class T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = flag();
    } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      bytes(&value, sizeof value);
    } else if constexpr (detail::kIsQuaternion<T>) {
      read(value.coeffs());
    } else if constexpr (detail::kIsMatrix<T>) {
      bytes(value.data(), sizeof(typename T::Scalar) * T::SizeAtCompileTime);
    } else if constexpr (detail::kIsOptional<T>) {
      if (!flag()) return value.reset();
      if (!value) value.emplace();
      read(*value);
    } else if constexpr (detail::kIsVariant<T>) {
      read_variant(value, number(), std::make_index_sequence<std::variant_size_v<T>>());
    } else if constexpr (detail::kIsVector<T>) {
      const std::uint64_t size = number();
      ok_ = ok_ && size <= in_.size();  // an element has at least a byte
      if (!ok_) return;
      value.resize(size);
      each(value);
    } else if constexpr (detail::kIsArray<T> || detail::kIsPerLeg<T>) {
      each(value);
    } else if constexpr (ListsMemory<T>) {
      T::memory(value, *this);
    } else {
      detail::visit_members(value, *this);
    }
  }

  template <class T, std::size_t... I>
  void read_variant(T& value, std::uint64_t index, std::index_sequence<I...>) {
    ok_ = ok_ && index < sizeof...(I);
    if (!ok_) return;
    ((index == I ? static_cast<void>(value.template emplace<I>()) : void()), ...);
    std::visit([this](auto& alternative) { read(alternative); }, value);
  }

  std::span<const std::byte> in_;
  bool ok_ = true;
};

}  // namespace pirouette
