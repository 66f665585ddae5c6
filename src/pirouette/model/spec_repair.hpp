// Changes to a MuJoCo specification that make a robot's file usable.
#pragma once

#include <string>
#include <vector>

#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/model/mujoco.hpp"

namespace pirouette {

/// Name of an element, empty if it has none.
std::string name_of(mjsElement* element);

/// Gives every body, joint and geom a name, so that the compiled elements can be found again.
void name_all(mjSpec& spec);

/// Finds the files of meshes, also of those named by package://; leaves out what only looks and
/// cannot be read. What carries collision or mass and is not there comes back as errors.
Errors mend_meshes(mjSpec& spec, const std::string& file, std::vector<std::string>& notes);

/// Puts the nearest inertia that a body can have in the place of those that none has.
void mend_inertias(mjSpec& spec, std::vector<std::string>& notes);

/// Gives the robot a free joint if the file has none.
void add_free_joint(mjSpec& spec, std::vector<std::string>& notes);

/// Fixes `joint` at `value` (rad, m): its bodies keep place and mass.
void lock_joint(mjSpec& spec, mjsJoint& joint, double value);

/// `inertia` if some body has it, else the nearest that one has: its moments about the principal
/// axes are not negative. kg m^2.
Mat3 possible_inertia(const Mat3& inertia);

}  // namespace pirouette
