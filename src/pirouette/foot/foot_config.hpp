// Parameters of the foot model.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Values of foot.model.
enum class FootModel { kCentre, kRolling };
template <>
struct EnumNames<FootModel> {
  static constexpr std::array<std::string_view, 2> kNames = {"centre", "rolling"};
};

/// Parameters `foot.*`.
struct FootConfig {
  FootModel model = FootModel::kRolling;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.model, "model",
      "centre: the sphere's centre is a point foot (MIT); rolling: the contact point rolls (FKM). "
      "Shared by estimator, planner and dynamics.");
  }
};

}  // namespace pirouette
