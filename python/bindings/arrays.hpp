// Between the library's fixed-size values and NumPy arrays. Legs are rows, in the order FR FL RR
// RL.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"

namespace pirouette::python {

namespace nb = nanobind;

using InputArray = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Vector = nb::ndarray<nb::numpy, double, nb::shape<3>>;
using LegVectors = nb::ndarray<nb::numpy, double, nb::shape<kLegCount, kJointsPerLeg>>;

static_assert(sizeof(PerLeg<Vec3>) == kLegCount * kJointsPerLeg * sizeof(double));

/// Raises pirouette.Error with every one of `errors`, a line each.
[[noreturn]] void raise(const Errors& errors);

template <class T>
T value_or_raise(Result<T> result) {
  if (!result) raise(result.errors());
  return std::move(result).value();
}

/// What NumPy makes of `given` as doubles; raises pirouette.Error naming `name` unless it has this
/// shape.
InputArray as_array(nb::handle given, const char* name, std::initializer_list<std::size_t> shape);

/// A copy that owns its memory.
template <class T>
nb::object copied(const T* values, std::initializer_list<std::size_t> shape) {
  return nb::cast(nb::ndarray<nb::numpy, const T>(values, shape), nb::rv_policy::copy);
}

inline nb::object to_python(double value) { return nb::float_(value); }
inline nb::object to_python(int value) { return nb::int_(value); }
inline nb::object to_python(bool value) { return nb::bool_(value); }
template <int N>
nb::object to_python(const Eigen::Matrix<double, N, 1>& value) {
  return copied(value.data(), {static_cast<std::size_t>(N)});
}
template <class T>
nb::object to_python(const PerLeg<T>& value) {
  return copied(value.values.data(), {kLegCount});
}
template <int N>
nb::object to_python(const PerLeg<Eigen::Matrix<double, N, 1>>& value) {
  return copied(value.values.front().data(), {kLegCount, static_cast<std::size_t>(N)});
}

/// A vector of the struct C as an attribute: the array is the struct's own memory.
template <class C>
void def_vector(nb::class_<C>& type, const char* name, Vec3 C::*member, const char* meaning) {
  type.def_prop_rw(
      name, [member](C& self) { return Vector((self.*member).data(), {3}); },
      [member, name](C& self, const nb::object& given) {
        self.*member = Eigen::Map<const Vec3>(as_array(given, name, {3}).data());
      },
      meaning);
}

/// The same of a vector for each leg.
template <class C>
void def_leg_vectors(nb::class_<C>& type, const char* name, PerLeg<Vec3> C::*member,
                     const char* meaning) {
  type.def_prop_rw(
      name,
      [member](C& self) {
        return LegVectors((self.*member).values.front().data(), {kLegCount, kJointsPerLeg});
      },
      [member, name](C& self, const nb::object& given) {
        const InputArray array = as_array(given, name, {kLegCount, kJointsPerLeg});
        for (const Leg leg : kLegs) {
          (self.*member)[leg] = Eigen::Map<const Vec3>(array.data() + kJointsPerLeg * index(leg));
        }
      },
      meaning);
}

}  // namespace pirouette::python
