#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <array>
#include <optional>

#include "arrays.hpp"
#include "bindings.hpp"
#include "pirouette/types/joint_command.hpp"
#include "pirouette/types/motion_command.hpp"
#include "pirouette/types/sensor_reading.hpp"

namespace pirouette::python {
namespace {

using namespace nanobind::literals;

using Pair = std::array<double, 2>;
using Matrix = nb::ndarray<nb::numpy, double, nb::shape<3, 3>>;
using ConstLegVectors = nb::ndarray<nb::numpy, const double, nb::shape<kLegCount, kJointsPerLeg>>;

Vec2 to_vector(const Pair& pair) { return {pair[0], pair[1]}; }

void define_aid(nb::module_& module) {
  nb::class_<PositionAid> aid(
      module, "PositionAid",
      "A pose of the trunk measured from outside (motion capture) or by a camera on board.");
  aid.def(nb::init<>());
  def_vector(aid, "p_WB", &PositionAid::p_WB, "m, shape (3,): position of the trunk");
  aid.def_rw("yaw", &PositionAid::yaw, "rad, in [-pi, pi]");
  aid.def_rw("time", &PositionAid::time, "s, of the measurement, by the clock of SensorReading");
}

void define_truth(nb::module_& module) {
  nb::class_<BaseTruth> truth(
      module, "BaseTruth",
      "The simulator's truth about the trunk; read with estimation.source = \"truth\" only.");
  truth.def(nb::init<>());
  def_vector(truth, "p_WB", &BaseTruth::p_WB, "m, shape (3,)");
  truth.def_prop_rw(
      "R_WB",
      [](BaseTruth& self) { return Matrix(self.R_WB.data(), {3, 3}, nb::handle(), {1, 3}); },
      [](BaseTruth& self, const nb::object& given) {
        using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
        self.R_WB = Eigen::Map<const RowMajor>(as_array(given, "R_WB", {3, 3}).data());
      },
      "shape (3, 3): rotation from trunk to world axes");
  def_vector(truth, "v_WB_W", &BaseTruth::v_WB_W, "m/s, shape (3,), world axes");
  def_vector(truth, "w_WB_B", &BaseTruth::w_WB_B, "rad/s, shape (3,), trunk axes");
}

void define_reading(nb::module_& module) {
  nb::class_<SensorReading> reading(
      module, "SensorReading",
      "What the robot measures at one control tick. Set its attributes; arrays have a row for each "
      "leg, FR FL RR RL.");
  reading.def(nb::init<>());
  reading.def_rw("time", &SensorReading::time, "s since the robot was switched on");
  def_leg_vectors(reading, "joint_position", &SensorReading::joint_position,
                  "rad, shape (4, 3): abad, hip, knee");
  def_leg_vectors(reading, "joint_velocity", &SensorReading::joint_velocity, "rad/s, shape (4, 3)");
  def_vector(reading, "specific_force_B", &SensorReading::specific_force_B,
             "m/s^2, shape (3,): accelerometer in trunk axes, (0, 0, +g) at rest on the flat");
  def_vector(reading, "w_WB_B", &SensorReading::w_WB_B, "rad/s, shape (3,): gyro in trunk axes");
  reading.def_prop_rw(
      "foot_contact",
      [](const SensorReading& self) -> std::optional<std::array<bool, kLegCount>> {
        if (!self.foot_contact) return std::nullopt;
        return self.foot_contact->values;
      },
      [](SensorReading& self, const nb::object& given) {
        self.foot_contact.reset();
        if (given.is_none()) return;
        const InputArray flags = as_array(given, "foot_contact", {kLegCount});
        self.foot_contact.emplace();
        for (const Leg leg : kLegs) (*self.foot_contact)[leg] = flags.data()[index(leg)] != 0.0;
      },
      nb::for_setter(nb::arg().none()),
      "four flags: the foot touches; None where the robot has no contact sensing");
  reading.def_prop_rw(
      "foot_force",
      [](const SensorReading& self) -> std::optional<std::array<double, kLegCount>> {
        if (!self.foot_force) return std::nullopt;
        return self.foot_force->values;
      },
      [](SensorReading& self, const nb::object& given) {
        self.foot_force.reset();
        if (given.is_none()) return;
        const InputArray forces = as_array(given, "foot_force", {kLegCount});
        self.foot_force.emplace();
        for (const Leg leg : kLegs) (*self.foot_force)[leg] = forces.data()[index(leg)];
      },
      nb::for_setter(nb::arg().none()),
      "four raw forces in any unit, rising with the load, from which the controller makes its own "
      "contact flags; None where the feet have no force sensors");
  reading.def_rw("aid", &SensorReading::aid, nb::arg().none(),
                 "PositionAid in the ticks in which one arrives, else None");
  reading.def_rw("truth", &SensorReading::truth, nb::arg().none(),
                 "BaseTruth, None on a real robot");
}

void define_motion(nb::module_& module) {
  nb::class_<MotionCommand>(
      module, "MotionCommand",
      "A planar twist of the centre of mass in heading axes. A yaw rate alone: a spin. walk with a "
      "zero twist: trotting on the spot. Without walk: standing on four feet.")
      .def(
          "__init__",
          [](MotionCommand* self, bool walk, const Pair& v_H, double yaw_rate,
             const std::optional<Pair>& point, std::optional<double> heading, bool hold_heading) {
            new (self)
                MotionCommand{walk, to_vector(v_H), yaw_rate, std::nullopt, heading, hold_heading};
            if (point) self->point = to_vector(*point);
          },
          nb::kw_only(), "walk"_a = false, "v_H"_a = Pair{0.0, 0.0}, "yaw_rate"_a = 0.0,
          "point"_a = nb::none(), "heading"_a = nb::none(), "hold_heading"_a = false,
          "v_H: m/s, forwards and to the left. yaw_rate: rad/s, positive turns left. point: m, in "
          "the world, and heading: rad, where the reference starts; None: where the robot is when "
          "walking begins. hold_heading: on a path the trunk does not turn with it.")
      .def_ro("walk", &MotionCommand::walk, "False: stand on four feet")
      .def_prop_ro(
          "v_H", [](const MotionCommand& self) { return Pair{self.v_H.x(), self.v_H.y()}; },
          "m/s, forwards and to the left")
      .def_ro("yaw_rate", &MotionCommand::yaw_rate, "rad/s")
      .def_prop_ro(
          "point",
          [](const MotionCommand& self) -> std::optional<Pair> {
            if (!self.point) return std::nullopt;
            return Pair{self.point->x(), self.point->y()};
          },
          "m, in the world, or None")
      .def_ro("heading", &MotionCommand::heading, "rad, or None")
      .def_ro("hold_heading", &MotionCommand::hold_heading);
}

void def_part(nb::class_<JointCommand>& type, const char* name, Vec3 LegCommand::*part,
              const char* meaning) {
  constexpr auto kStride = static_cast<std::int64_t>(sizeof(LegCommand) / sizeof(double));
  type.def_prop_ro(
      name,
      [part](const JointCommand& self) {
        return ConstLegVectors((self.values.front().*part).data(), {kLegCount, kJointsPerLeg},
                               nb::handle(), {kStride, 1});
      },
      nb::rv_policy::reference_internal, meaning);
}

void define_joint_command(nb::module_& module) {
  nb::enum_<ControllerStatus>(module, "ControllerStatus", nb::is_arithmetic(),
                              "What the controller is doing, and why it stopped if it did.")
      .value("STANDING", ControllerStatus::kStanding)
      .value("WALKING", ControllerStatus::kWalking)
      .value("FALLEN", ControllerStatus::kFallen)
      .value("BAD_INPUT", ControllerStatus::kBadInput)
      .value("SOLVER_FAILED", ControllerStatus::kSolverFailed)
      .value("BAD_COMMAND", ControllerStatus::kBadCommand)
      .value("CHECK_FAILED", ControllerStatus::kCheckFailed)
      .value("GYRO_AGAINST_LEGS", ControllerStatus::kGyroAgainstLegs);

  nb::class_<JointCommand> command(
      module, "JointCommand",
      "What the joints are to do: torque = tau + kp (q - measured) + kd (dq - measured). Arrays "
      "of shape (4, 3): legs FR FL RR RL; abad, hip, knee.");
  def_part(command, "q", &LegCommand::q, "rad");
  def_part(command, "dq", &LegCommand::dq, "rad/s");
  def_part(command, "kp", &LegCommand::kp, "N m/rad");
  def_part(command, "kd", &LegCommand::kd, "N m s/rad");
  def_part(command, "tau", &LegCommand::tau, "N m, feed-forward");
  command.def(
      "torque",
      [](const JointCommand& self, const nb::object& joint_position,
         const nb::object& joint_velocity) {
        const auto q = as_array(joint_position, "joint_position", {kLegCount, kJointsPerLeg});
        const auto dq = as_array(joint_velocity, "joint_velocity", {kLegCount, kJointsPerLeg});
        PerLeg<Vec3> torque;
        for (const Leg leg : kLegs) {
          const Eigen::Map<const Vec3> q_leg(q.data() + kJointsPerLeg * index(leg));
          const Eigen::Map<const Vec3> dq_leg(dq.data() + kJointsPerLeg * index(leg));
          torque[leg] = self[leg].torque(q_leg, dq_leg);
        }
        return to_python(torque);
      },
      "joint_position"_a, "joint_velocity"_a,
      nb::sig("def torque(self, joint_position: object, joint_velocity: object) -> "
              "numpy.typing.NDArray[numpy.float64]"),
      "Torque (N m, shape (4, 3)) of the motors at measured angles (rad) and velocities (rad/s), "
      "before the motors' own limits.");
}

}  // namespace

void define_values(nb::module_& module) {
  define_aid(module);
  define_truth(module);
  define_reading(module);
  define_motion(module);
  define_joint_command(module);
}

}  // namespace pirouette::python
