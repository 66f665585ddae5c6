// What a controller finds out about its robot before it takes the first step.
#pragma once

#include <string_view>

namespace pirouette {

/// State of the check of sensors, legs and motors at standing, or what it found wrong.
enum class SelfCheck : int {
  kRunning = 0,
  kPassed = 1,
  kSkipped = 2,  ///< safety.self_check = "none"
  kClockStopped = 3,
  kClockInMilliseconds = 4,
  kClockRate = 5,
  kJointsInDegrees = 6,
  kJointRange = 7,
  kFeetNotOnPlane = 8,
  kGravityMissing = 9,
  kAccelerometerInG = 10,
  kAccelerometerSize = 11,
  kAccelerometerUpsideDown = 12,
  kAccelerometerAxes = 13,
  kNotStill = 14,
  kLegsGiveWay = 15,
  kTorqueScale = 16,
  kGyroStuck = 17,
  kGyroInDegrees = 18,
  kGyroSize = 19,
  kGyroOpposite = 20,
  kGyroAxes = 21,
  kLegsLeftRight = 22,
  kLegsFrontRear = 23,
  kLegsDiagonal = 24,
  kLegOrder = 25,
  kGyroTurns = 26,
};

/// True for everything that keeps the robot from walking.
constexpr bool has_failed(SelfCheck check) { return static_cast<int>(check) > 2; }

/// What was found and what to look at, as a sentence without its full stop.
constexpr std::string_view words(SelfCheck check) {
  switch (check) {
    case SelfCheck::kRunning:
      return "the self-check is running";
    case SelfCheck::kPassed:
      return "the self-check has passed";
    case SelfCheck::kSkipped:
      return "the self-check was skipped";
    case SelfCheck::kClockStopped:
      return "SensorReading::time does not run: is it set?";
    case SelfCheck::kClockInMilliseconds:
      return "SensorReading::time runs a thousand times too fast: is it in ms? It is to be in s";
    case SelfCheck::kClockRate:
      return "readings do not come at control.rate, by their own times: does the loop keep its "
             "period, is the time in s?";
    case SelfCheck::kJointsInDegrees:
      return "a joint angle is larger than two turns: is it in degrees? It is to be in rad";
    case SelfCheck::kJointRange:
      return "a joint angle is outside its range in the robot's file: zero, sign or order of the "
             "joints?";
    case SelfCheck::kFeetNotOnPlane:
      return "by the joint angles the four feet do not stand on a plane below the trunk: order of "
             "the legs, sign or zero of a joint?";
    case SelfCheck::kGravityMissing:
      return "the accelerometer reads nothing at rest: is gravity removed? It is to be +g along z";
    case SelfCheck::kAccelerometerInG:
      return "the accelerometer reads 1.0 at rest: is it in g? It is to be in m/s^2";
    case SelfCheck::kAccelerometerSize:
      return "the accelerometer does not read g at rest: unit or scale?";
    case SelfCheck::kAccelerometerUpsideDown:
      return "the accelerometer reads -g along z at rest: is its sign turned, or the IMU mounted "
             "upside down?";
    case SelfCheck::kAccelerometerAxes:
      return "the accelerometer reads g along another axis than z at rest: axes of the IMU?";
    case SelfCheck::kNotStill:
      return "the trunk moves over its feet: is the robot being moved? It is to stand still";
    case SelfCheck::kLegsGiveWay:
      return "the joints give way while they hold the robot: sign or scale of the torque, motors "
             "without power?";
    case SelfCheck::kTorqueScale:
      return "the torque that holds the robot is not that of its weight: scale of the torque, "
             "another robot's file, a robot that hangs?";
    case SelfCheck::kGyroStuck:
      return "the gyro does not see the trunk turn over its feet: is it connected?";
    case SelfCheck::kGyroInDegrees:
      return "the gyro reads 57 times what the legs turn: is it in degrees? It is to be in rad/s";
    case SelfCheck::kGyroSize:
      return "gyro and legs disagree about how fast the trunk turns: scale of the gyro, or of the "
             "joint velocities?";
    case SelfCheck::kGyroOpposite:
      return "gyro and legs turn in opposite directions: sign of the gyro?";
    case SelfCheck::kGyroAxes:
      return "the gyro turns about other axes than the legs: axes of the IMU?";
    case SelfCheck::kLegsLeftRight:
      return "gyro and legs turn in opposite directions in roll and yaw: left and right legs "
             "swapped?";
    case SelfCheck::kLegsFrontRear:
      return "gyro and legs turn in opposite directions in pitch and yaw: front and rear legs "
             "swapped?";
    case SelfCheck::kLegsDiagonal:
      return "gyro and legs turn in opposite directions in roll and pitch: legs swapped across, or "
             "two axes of the gyro turned?";
    case SelfCheck::kLegOrder:
      return "the feet do not move as the feet of one trunk: order of the legs, sign of a joint?";
    case SelfCheck::kGyroTurns:
      return "the gyro reads more than 0.2 rad/s at rest: unit or bias?";
  }
  return "";
}

}  // namespace pirouette
