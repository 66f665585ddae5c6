// Finds the legs of a quadruped by the structure of its joints.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/model/mujoco.hpp"
#include "pirouette/model/robot_description.hpp"
#include "pirouette/types/joint_convention.hpp"

namespace pirouette {

/// Joint ids of a leg: abad, hip, knee.
using LegJoints = std::array<int, kJointsPerLeg>;

/// Joints of a quadruped in a compiled model.
struct JointRoles {
  int trunk = -1;            ///< body with the free joint
  PerLeg<LegJoints> legs{};  ///< of the legs
  std::vector<int> others;   ///< that belong to no leg
};

/// Joints of `m`, as `given` names them or else by structure. `d` holds the pose with every hinge
/// at 0. The errors call the model `given.file`.
Result<JointRoles> find_legs(const mjModel& m, const mjData& d, const RobotDescription& given);

/// The convention of a leg from the pose with every hinge at 0: its joints' axes, and the places of
/// joints and foot centre `p_WF` (m).
JointConvention find_convention(const mjModel& m, const mjData& d, int trunk,
                                const LegJoints& joints, const Vec3& p_WF);

/// Largest torque (N m) of a joint that its actuatorfrcrange or else its motor's forcerange or
/// ctrlrange allows; kNoTorqueLimit: none says.
double torque_limit(const mjModel& model, int joint);

/// N m, limit of a motor for which the robot file gives none.
inline constexpr double kNoTorqueLimit = 1e3;

/// "abad_FR (hinge), ...": all joints of the model.
std::string list_joints(const mjModel& model);

/// A joint's name.
std::string joint_name(const mjModel& model, int joint);

/// True: `body` is `ancestor` or hangs on it.
bool is_below(const mjModel& model, int body, int ancestor);

}  // namespace pirouette
