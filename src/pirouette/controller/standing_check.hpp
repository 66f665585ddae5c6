// The check of sensors, legs and motors before the first step.
#pragma once

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/controller/safety_config.hpp"
#include "pirouette/types/foot_state.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/leg_geometry.hpp"
#include "pirouette/types/self_check.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette {

/// Input of StandingCheck::update().
struct StandingCheckInput {
  const SensorReading& sensors;      ///< of this tick
  const PerLeg<FootState>& feet;     ///< by the joint angles
  const JointCommand& last_command;  ///< of the tick before
};

/// Holds a robot that stands by its joint angles alone, because nothing else is trusted yet, and
/// watches it. First it stands still: clock, joint angles, accelerometer and the torque that holds
/// its weight are compared with what they have to be. Then it turns its trunk a little about one
/// axis after the other, over feet that stay where they are: what the legs turn (least squares over
/// the four feet) and what the gyro says has to be the same, axis by axis. It counts ticks, because
/// the clock is one of the things that are checked. A robot that is moved by others starts over.
class StandingCheck {
 public:
  /// `period`: s, nominal; `mass`: kg; `p_BG`: m, CoM in trunk axes when it stands.
  StandingCheck(const SafetyConfig& config, double period, double mass, const Vec3& p_BG,
                const PerLeg<LegGeometry>& legs);

  /// One tick further; to be called while state() is kRunning.
  void update(const StandingCheckInput& in) noexcept;

  /// What it has found so far.
  SelfCheck state() const noexcept { return state_; }
  /// The trunk turns over its feet.
  bool turns() const noexcept;
  /// What holds and turns the robot, while state() is kRunning.
  const JointCommand& command() const noexcept { return command_; }

  void reset() noexcept;  ///< begins anew with the next tick

  /// See base/memory.hpp.
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [config, period, mass, com, legs, state, command, ticks, tries, stance, still, turning] =
        self;
    visit(state, command, ticks, tries, stance, still, turning);
  }

 private:
  /// A turn of the trunk over its standing feet, about its own axes.
  struct Turn {
    Vec3 angle_B = Vec3::Zero();  ///< rad, small
    Vec3 rate_B = Vec3::Zero();   ///< rad/s
  };
  /// Where the robot stood at the first tick.
  struct Stance {
    PerLeg<Vec3> q{};     ///< rad
    PerLeg<Vec3> p_BF{};  ///< m
    PerLeg<double> f{};   ///< N, that each foot carries of the weight
  };
  /// Sums while standing still.
  struct Still {
    double samples = 0.0;
    double first_time = 0.0, last_time = 0.0;  ///< s
    Vec3 sum_a = Vec3::Zero();                 ///< m/s^2
    Vec3 sum_gyro = Vec3::Zero();              ///< rad/s
    Vec3 sum_legs = Vec3::Zero();              ///< rad/s, the trunk's turn by the legs
    double sum_legs2 = 0.0;                    ///< (rad/s)^2
    double sum_lift = 0.0;                     ///< N, that the joints' torques press on the ground
  };
  /// Sums while the trunk turns.
  struct Turning {
    Mat3 gyro_legs = Mat3::Zero();  ///< (rad/s)^2
    Mat3 legs_legs = Mat3::Zero();  ///< (rad/s)^2
    double foot_speed = 0.0;        ///< (m/s)^2, of the feet in trunk axes
    double misfit = 0.0;            ///< (m/s)^2, of it that is no motion of one rigid body
  };

  void watch_still(const StandingCheckInput& in) noexcept;
  void watch_turn(const StandingCheckInput& in) noexcept;
  SelfCheck first_look(const StandingCheckInput& in) const noexcept;
  SelfCheck judge_still() const noexcept;
  SelfCheck judge_turn() const noexcept;
  SelfCheck judge_bias() const noexcept;
  SelfCheck judge_clock() const noexcept;
  SelfCheck judge_accelerometer(const Vec3& a) const noexcept;
  bool gives_way(const StandingCheckInput& in) const noexcept;
  double lift(const StandingCheckInput& in) const noexcept;
  void begin(const StandingCheckInput& in) noexcept;
  Turn turn_at(double time) const noexcept;
  void hold(const Turn& turn) noexcept;

  SafetyConfig config_;
  double period_;
  double mass_;
  Vec3 p_BG_;
  PerLeg<LegGeometry> legs_;
  SelfCheck state_ = SelfCheck::kRunning;
  JointCommand command_;
  int ticks_ = 0;
  int tries_ = 0;  ///< times that it was not still
  Stance stance_;
  Still still_;
  Turning turning_;
};

}  // namespace pirouette
