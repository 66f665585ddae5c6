// What is known of a robot's file beyond its text: which joints are the legs, where the feet are.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

/// What is said about one leg; vectors hold abad, hip, knee. What is left out is found in the file.
struct LegDescription {
  std::array<std::string, kJointsPerLeg> joints{};  ///< names; all empty: found by structure
  /// +1 or -1: about the file's axis or against it the joint turns as in LegGeometry.
  std::optional<Vec3> sign;
  std::optional<Vec3> zero;  ///< rad, the file's joint angles where the leg hangs straight down
  std::optional<double> knee_sign;    ///< -1 knees backward, +1 forward
  std::string foot;                   ///< geom, body or site of the foot; empty: found
  std::optional<double> foot_radius;  ///< m, of the sphere that the robot stands on
  std::optional<Vec3> torque;         ///< N m, limits
  std::optional<Vec3> armature;       ///< kg m^2, rotor inertia at the joint
};

/// A robot: its file, and what is said about it. What is left out is found in the file
/// (model/robot_reader.hpp).
struct RobotDescription {
  std::string file;                      ///< path of an MJCF or URDF file
  std::string source;                    ///< file that says the rest, for errors; empty: nobody
  PerLeg<LegDescription> legs{};         ///< the legs
  std::string imu;                       ///< site of the IMU; empty: the trunk's frame
  std::map<std::string, double> locked;  ///< rad or m: joints that are held, and where
  /// rad or m: a pose in which the robot stands. Knees bend as there, and what is locked is so.
  std::map<std::string, double> pose;

  RobotDescription() = default;
  /// The robot of `path`, about which nothing else is said.
  RobotDescription(std::string path) : file(std::move(path)) {}
  /// The same.
  RobotDescription(const char* path) : file(path) {}
};

/// Name of the sphere that stands in for a foot of another shape.
inline std::string foot_sphere_name(Leg leg) { return "pirouette_foot_" + std::string(name(leg)); }

}  // namespace pirouette
