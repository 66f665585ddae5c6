// Lift-off point of each foot.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/types/foot_contacts.hpp"

namespace pirouette {

/// Remembers where each foot last left the ground.
class LiftOffPoints {
 public:
  /// Sphere centres `p_WF` (m, world) when each foot last left the ground; those of start() for a
  /// foot that has not.
  const PerLeg<Vec3>& update(const FootContacts& contacts, const PerLeg<Vec3>& p_WF) noexcept {
    for (const Leg leg : kLegs) {
      const bool in_contact = contacts[leg].in_contact;
      if (was_in_contact_[leg] && !in_contact) p_WF_[leg] = p_WF[leg];
      was_in_contact_[leg] = in_contact;
    }
    return p_WF_;
  }

  /// Discards all contacts; `p_WF` (m, world) are the points of feet that have not left the ground
  /// yet.
  void start(const PerLeg<Vec3>& p_WF) noexcept {
    was_in_contact_ = {};
    p_WF_ = p_WF;
  }

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [was_in_contact, p_WF] = self;
    visit(was_in_contact, p_WF);
  }

 private:
  PerLeg<bool> was_in_contact_{};
  PerLeg<Vec3> p_WF_{};
};

}  // namespace pirouette
