// The four legs, in the order FR FL RR RL everywhere, and a container indexed by leg.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pirouette {

/// A leg: front (F) or rear (R), right (R) or left (L).
enum class Leg : int { kFR = 0, kFL = 1, kRR = 2, kRL = 3 };

inline constexpr std::size_t kLegCount = 4;      ///< number of legs
inline constexpr std::size_t kJointsPerLeg = 3;  ///< abad, hip, knee
/// For loops over all legs.
inline constexpr std::array<Leg, kLegCount> kLegs = {Leg::kFR, Leg::kFL, Leg::kRR, Leg::kRL};
/// In the order of Leg.
inline constexpr std::array<std::string_view, kLegCount> kLegNames = {"FR", "FL", "RR", "RL"};

constexpr std::size_t index(Leg leg) { return static_cast<std::size_t>(leg); }  ///< 0 to 3
constexpr std::string_view name(Leg leg) { return kLegNames[index(leg)]; }      ///< "FR" ...
/// +1 for the left legs, -1 for the right ones.
constexpr double side_sign(Leg leg) { return (leg == Leg::kFL || leg == Leg::kRL) ? 1.0 : -1.0; }
/// +1 for the front legs, -1 for the rear ones.
constexpr double fore_sign(Leg leg) { return (leg == Leg::kFR || leg == Leg::kFL) ? 1.0 : -1.0; }

/// One T for each leg, indexed by Leg. Iterates in the order FR FL RR RL. Starts as T{} or, for
/// fixed-size Eigen types, whose T{} is uninitialised, as zeros.
template <class T>
struct PerLeg {
  std::array<T, kLegCount> values = initial_values();  ///< in the order of Leg

  constexpr T& operator[](Leg leg) { return values[index(leg)]; }  ///< the value of `leg`
  /// The value of `leg`.
  constexpr const T& operator[](Leg leg) const { return values[index(leg)]; }
  constexpr auto begin() { return values.begin(); }        ///< of FR
  constexpr auto end() { return values.end(); }            ///< after RL
  constexpr auto begin() const { return values.begin(); }  ///< of FR
  constexpr auto end() const { return values.end(); }      ///< after RL

  /// `value` for every leg.
  static constexpr PerLeg filled(const T& value) { return {{value, value, value, value}}; }

 private:
  static constexpr std::array<T, kLegCount> initial_values() {
    if constexpr (requires { T::Zero(); }) {
      return {T::Zero(), T::Zero(), T::Zero(), T::Zero()};
    } else {
      return {};
    }
  }
};

}  // namespace pirouette
