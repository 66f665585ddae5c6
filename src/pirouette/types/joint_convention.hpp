// Signs and zeros of the joints of a robot's file.
#pragma once

#include "pirouette/base/math.hpp"

namespace pirouette {

/// How the joint angles of a robot's file, in which readings come and commands go, relate to those
/// of LegGeometry, in which the controller thinks. Vectors hold abad, hip, knee.
struct JointConvention {
  Vec3 sign = Vec3::Ones();  ///< +1 or -1: of LegGeometry's angles over the file's
  Vec3 zero = Vec3::Zero();  ///< rad, the file's angles where the leg hangs straight down

  /// The file's angles at `q` (rad) of LegGeometry.
  Vec3 to_file(const Vec3& q) const { return zero + sign.cwiseProduct(q); }
  /// Angles (rad) of LegGeometry at the file's.
  Vec3 from_file(const Vec3& q) const { return sign.cwiseProduct(q - zero); }
  /// Velocities or torques, either way.
  Vec3 turned(const Vec3& rate) const { return sign.cwiseProduct(rate); }
};

}  // namespace pirouette
