// Sensor reading of one control tick: the controller's only input besides the motion command.
#pragma once

#include <optional>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"

namespace pirouette {

/// Pose of the trunk frame B in the world W.
struct BasePose {
  Vec3 p_WB = Vec3::Zero();      ///< m
  Mat3 R_WB = Mat3::Identity();  ///< trunk axes in world axes
};

/// True pose and velocity of the trunk. Read only with estimation.source = "truth", for studies.
struct BaseTruth {
  Vec3 p_WB = Vec3::Zero();      ///< m
  Mat3 R_WB = Mat3::Identity();  ///< trunk axes in world axes
  Vec3 v_WB_W = Vec3::Zero();    ///< m/s, world axes
  Vec3 w_WB_B = Vec3::Zero();    ///< rad/s, body axes
};

/// Pose of the trunk measured from outside (motion capture) or by a camera on board.
struct PositionAid {
  Vec3 p_WB = Vec3::Zero();  ///< m
  double yaw = 0.0;          ///< rad, in [-pi, pi]
  double time = 0.0;         ///< s, of the measurement, by the clock of SensorReading::time
};

/// Sensor values of one control tick.
struct SensorReading {
  double time = 0.0;              ///< s since the robot was switched on
  PerLeg<Vec3> joint_position{};  ///< rad: abad, hip, knee
  PerLeg<Vec3> joint_velocity{};  ///< rad/s
  Vec3 specific_force_B =
      Vec3::Zero();  ///< m/s^2, accelerometer in body axes: (0, 0, +g) at rest on the flat
  Vec3 w_WB_B = Vec3::Zero();                ///< rad/s, gyro in body axes
  std::optional<PerLeg<bool>> foot_contact;  ///< absent where the robot has no contact sensing
  /// Raw readings of the feet's force sensors in any unit, rising with the load; absent where there
  /// are none. Where present they stand for foot_contact: the threshold is found at standing.
  std::optional<PerLeg<double>> foot_force;
  std::optional<PositionAid> aid;  ///< present in ticks in which a measurement arrives
  std::optional<BaseTruth> truth;  ///< absent on a real robot

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [time, joint_position, joint_velocity, specific_force_B, w_WB_B, foot_contact, foot_force,
           aid, truth] = self;
    visit(time, joint_position, joint_velocity, specific_force_B, w_WB_B, foot_contact, foot_force,
          aid, truth);
  }
};

}  // namespace pirouette
