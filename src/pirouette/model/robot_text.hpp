// A robot as the text of an MJCF file.
#pragma once

#include <string>

#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_description.hpp"

namespace pirouette {

/// The text of an MJCF file with the robot as it was read: with a free joint, feet that are
/// spheres and no other joints than the legs', its meshes and textures by absolute paths. Its
/// <custom> text pirouette_joints names the joints of FR, FL, RR, RL, each abad, hip, knee.
Result<std::string> robot_mjcf(const RobotDescription& given);

}  // namespace pirouette
