// Whether the gyro agrees with the legs about how fast the robot turns.
#pragma once

#include <algorithm>
#include <cmath>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/types/foot_contacts.hpp"
#include "pirouette/types/foot_state.hpp"

namespace pirouette {

/// Compares the gyro's yaw rate with that of the trunk over its stance feet, both low-passed.
/// Slipping feet, pushes and rolling feet differ for a moment or by a little; a gyro with a wrong
/// sign or unit, or one that is stuck, differs for good, and the robot would wind itself up.
class GyroWatch {
 public:
  /// False: they contradict each other. `w_WB_B`: rad/s, gyro; `encoder_stuck`: legs left out.
  bool update(const Vec3& w_WB_B, const PerLeg<FootState>& feet, const FootContacts& contacts,
              const PerLeg<bool>& encoder_stuck, double dt) noexcept {
    PerLeg<bool> stands{};
    int count = 0;
    Vec2 centre = Vec2::Zero(), mean_v = Vec2::Zero();
    for (const Leg leg : kLegs) {
      stands[leg] = contacts[leg].in_contact && contacts[leg].measured && !encoder_stuck[leg];
      if (!stands[leg]) continue;
      ++count;
      centre += feet[leg].p_BF.head<2>();
      mean_v += feet[leg].v_BF_B.head<2>();
    }
    if (count < 2) return agree_;
    centre /= count;
    mean_v /= count;
    double moment = 0.0, spread = 0.0;
    for (const Leg leg : kLegs) {
      if (!stands[leg]) continue;
      const Vec2 arm = feet[leg].p_BF.head<2>() - centre;
      const Vec2 v = feet[leg].v_BF_B.head<2>() - mean_v;
      moment += arm.x() * v.y() - arm.y() * v.x();
      spread += arm.squaredNorm();
    }
    if (spread <= 0.0) return agree_;
    const double share = dt / (dt + kTimeConstant);
    by_legs_ += share * (-moment / spread - by_legs_);
    by_gyro_ += share * (w_WB_B.z() - by_gyro_);
    const double largest = std::max(std::abs(by_legs_), std::abs(by_gyro_));
    agree_ = std::abs(by_legs_ - by_gyro_) < std::max(kMaxDifference, kMaxShare * largest);
    return agree_;
  }

  void reset() noexcept { *this = GyroWatch(); }  ///< nothing seen yet

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [agree, by_legs, by_gyro] = self;
    visit(agree, by_legs, by_gyro);
  }

 private:
  static constexpr double kTimeConstant = 0.25;  // s
  static constexpr double kMaxDifference = 1.0;  // rad/s
  static constexpr double kMaxShare = 0.6;       // of the larger of the two

  bool agree_ = true;
  double by_legs_ = 0.0, by_gyro_ = 0.0;  ///< rad/s, low-passed
};

}  // namespace pirouette
