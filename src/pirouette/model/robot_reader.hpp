// Reads a robot's MJCF or URDF file: finds its legs, and mends what a simulator cannot take.
#pragma once

#include <string>
#include <vector>

#include "pirouette/base/result.hpp"
#include "pirouette/model/mujoco.hpp"
#include "pirouette/model/robot_description.hpp"

namespace pirouette {

/// A robot as it was read.
struct ReadRobot {
  SpecPtr spec;                    ///< with a free joint, twelve leg joints and four foot spheres
  RobotDescription description;    ///< complete: reading it again gives the same robot
  std::vector<std::string> notes;  ///< what was mended, left out or assumed, a sentence each
};

/// Reads the file of `given` and finds what `given` leaves out.
///
/// A leg is a chain of three hinges from the trunk: abad along the trunk's x, hip and knee parallel
/// to each other and across the abad. Four of them, one in each quadrant by the place of the abad
/// joint, are FR FL RR RL. Signs and zeros of the joints follow from the axes and from where the
/// leg hangs straight down; the knee's side from its range, else from the first keyframe or the
/// SRDF file's first pose, else backward. Any other joint is locked where that pose, or zero, has
/// it. A foot is the colliding sphere farthest from the knee; a capsule, mesh or other shape gets
/// a sphere in its place.
/// Mended: a missing free joint, visual meshes that cannot be read, inertias that no body has.
/// Errors: all that keep the robot from walking, each with a remedy.
Result<ReadRobot> read_robot(const RobotDescription& given);

}  // namespace pirouette
