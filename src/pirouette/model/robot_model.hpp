// The controller's rigid-body model of a quadruped from an MJCF or URDF file, without a world.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/model/robot_description.hpp"
#include "pirouette/types/leg_geometry.hpp"
#include "pirouette/types/robot_scale.hpp"
#include "pirouette/types/robot_state.hpp"

namespace pirouette {

inline constexpr int kDof = 18;  ///< 6 of the trunk, 12 joints

/// Generalised velocity or force.
using VecDof = Eigen::Matrix<double, kDof, 1>;
/// Joint-space inertia.
using MatDof = Eigen::Matrix<double, kDof, kDof>;
/// Jacobian of a point or an angular velocity.
using Jacobian = Eigen::Matrix<double, 3, kDof>;

/// Rigid-body model. Generalised velocity nu = [v_WB_W; w_WB_B; joint velocities FR FL RR RL, each
/// abad hip knee].
class RobotModel {
 public:
  /// Reads a robot (model/robot_reader.hpp); a path stands for the robot of that file. The errors
  /// name the file and what keeps the robot from walking.
  static Result<RobotModel> load(const RobotDescription& robot);

  RobotModel(RobotModel&&) noexcept;             ///< moves
  RobotModel& operator=(RobotModel&&) noexcept;  ///< moves
  ~RobotModel();

  double mass() const;                      ///< kg
  const PerLeg<LegGeometry>& legs() const;  ///< lengths and limits of each leg
  RobotScale scale() const;                 ///< of mass and mean length of the legs
  /// The robot as it was found: complete, so that it can be read again.
  const RobotDescription& description() const;
  /// What was mended, left out or assumed, a sentence each.
  const std::vector<std::string>& notes() const;
  /// Inertia (kg m^2) of the whole robot about its CoM, trunk axes, at joint angles `q` (rad).
  Mat3 inertia(const PerLeg<Vec3>& q);
  /// CoM (m) in trunk axes at joint angles `q` (rad).
  Vec3 com(const PerLeg<Vec3>& q);

  /// Evaluates everything below at `state` (pose and velocity of the trunk, joints). No allocation.
  void update(const RobotState& state) noexcept;

  Vec3 p_WG() const;                              ///< m
  Vec3 v_WG_W() const;                            ///< m/s
  const MatDof& mass_matrix() const;              ///< with the rotors' reflected inertia
  const VecDof& bias() const;                     ///< N, N m: Coriolis, centrifugal and gravity
  const Jacobian& com_jacobian() const;           ///< v_WG_W = J nu
  const Vec3& com_bias() const;                   ///< m/s^2: Jdot nu of the CoM
  const Jacobian& foot_jacobian(Leg leg) const;   ///< sphere centre: v_WF_W = J nu
  const Jacobian& shank_jacobian(Leg leg) const;  ///< w_WS_W = J nu
  const Vec3& foot_bias(Leg leg) const;           ///< m/s^2: Jdot nu of the sphere centre
  const Vec3& shank_bias(Leg leg) const;  ///< rad/s^2: Jdot nu of the shank's angular velocity

 private:
  static Result<RobotModel> read(const RobotDescription& robot);
  void evaluate(const RobotState& state);

  struct Impl;
  explicit RobotModel(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace pirouette
