// Robots that are wired wrongly, in the closed loop: the self-check names the mistake before the
// first step.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "pirouette/plant/simulated_world.hpp"
#include "support/closed_loop.hpp"
#include "support/trial.hpp"

namespace pirouette {
namespace {

constexpr double kDegrees = 180.0 / kPi;

struct Wiring {
  const char* name;
  std::function<void(SensorReading&)> reading;
  std::function<void(JointCommand&)> command;
  std::vector<SelfCheck> expected;  ///< any of them
};

/// A simulated robot between wrong wires.
class MiswiredWorld final : public World {
 public:
  MiswiredWorld(Plant& plant, const Wiring& wiring) : plant_(plant), wiring_(wiring) {}

  double period() const override { return plant_.period(); }
  std::optional<SensorReading> sense() override {
    SensorReading reading = plant_.sense();
    if (wiring_.reading) wiring_.reading(reading);
    return reading;
  }
  void send(const JointCommand& command) override {
    JointCommand sent = command;
    if (wiring_.command) wiring_.command(sent);
    plant_.advance(sent);
  }

 private:
  Plant& plant_;
  const Wiring& wiring_;
};

template <class T>
void swap_left_right(PerLeg<T>& legs) {
  std::swap(legs[Leg::kFR], legs[Leg::kFL]);
  std::swap(legs[Leg::kRR], legs[Leg::kRL]);
}
template <class T>
void swap_front_rear(PerLeg<T>& legs) {
  std::swap(legs[Leg::kFR], legs[Leg::kRR]);
  std::swap(legs[Leg::kFL], legs[Leg::kRL]);
}
/// FR FL RR RL taken for FR RR RL FL.
template <class T>
void rotate_order(PerLeg<T>& legs) {
  const PerLeg<T> from = legs;
  legs[Leg::kFL] = from[Leg::kRR];
  legs[Leg::kRR] = from[Leg::kRL];
  legs[Leg::kRL] = from[Leg::kFL];
}
template <class Swap>
auto in_readings(Swap swap) {
  return [swap](SensorReading& r) {
    swap(r.joint_position);
    swap(r.joint_velocity);
    if (r.foot_contact) swap(*r.foot_contact);
  };
}

const auto kLeftRight = [](auto& legs) { swap_left_right(legs); };
const auto kFrontRear = [](auto& legs) { swap_front_rear(legs); };
const auto kOrder = [](auto& legs) { rotate_order(legs); };
const auto kNoCommand = std::function<void(JointCommand&)>();

/// The first seconds of a spin that is asked for after one; steps before kPassed are failures.
SpinController first_seconds(const ConfigSources& sources, const Wiring& wiring) {
  const Result<Config> config = load_config(sources);
  if (!config) throw std::runtime_error(config.errors().front().to_string());
  const Result<TrialSetup> setup = set_up(config.value());
  if (!setup) throw std::runtime_error(setup.errors().front().to_string());
  Result<Plant> plant = Plant::create(setup.value().world, setup.value().plant);
  Result<SpinController> created =
      SpinController::create(setup.value().controller, setup.value().plant.robot);
  if (!plant || !created) throw std::runtime_error("no robot");
  SpinController& controller = created.value();
  const BaseTruth start = plant.value().truth().base;
  controller.reset({start.p_WB, start.R_WB});
  MiswiredWorld world(plant.value(), wiring);
  ControlLoop loop(world, controller);
  for (int i = 0; i < 1500 && !is_stood_down(controller.status()); ++i) {
    loop.tick(i < 500 ? test::stand_still() : test::spin(0.7));
    const SelfCheck check = controller.trace().self_check;
    if (check != SelfCheck::kPassed && check != SelfCheck::kSkipped) {
      EXPECT_NE(controller.status(), ControllerStatus::kWalking) << "tick " << i;
    }
    loop.send();
  }
  return std::move(created).value();
}

class WrongWiring : public testing::TestWithParam<Wiring> {};

TEST_P(WrongWiring, IsNamedBeforeTheFirstStep) {
  for (const char* robot : {"mini_cheetah", "go1"}) {
    const SpinController controller = first_seconds({.robot = robot}, GetParam());
    EXPECT_EQ(controller.status(), ControllerStatus::kCheckFailed) << robot;
    const SelfCheck found = controller.trace().self_check;
    const std::vector<SelfCheck>& expected = GetParam().expected;
    EXPECT_NE(std::find(expected.begin(), expected.end(), found), expected.end())
        << robot << ": " << words(found);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, WrongWiring,
    testing::Values(
        Wiring{"AccelerometerInG",
               [](SensorReading& r) { r.specific_force_B /= kGravity; },
               kNoCommand,
               {SelfCheck::kAccelerometerInG}},
        Wiring{"GravityRemoved",
               [](SensorReading& r) { r.specific_force_B.z() -= kGravity; },
               kNoCommand,
               {SelfCheck::kGravityMissing}},
        Wiring{"AccelerometerSign",
               [](SensorReading& r) { r.specific_force_B *= -1.0; },
               kNoCommand,
               {SelfCheck::kAccelerometerUpsideDown}},
        Wiring{"AccelerometerAxes",
               [](SensorReading& r) { std::swap(r.specific_force_B.x(), r.specific_force_B.z()); },
               kNoCommand,
               {SelfCheck::kAccelerometerAxes}},
        Wiring{"ImuUpsideDown",
               [](SensorReading& r) {
                 for (Vec3* v : {&r.specific_force_B, &r.w_WB_B}) {
                   v->y() *= -1.0;
                   v->z() *= -1.0;
                 }
               },
               kNoCommand,
               {SelfCheck::kAccelerometerUpsideDown}},
        Wiring{"ImuTurnedByAQuarter",
               [](SensorReading& r) {
                 for (Vec3* v : {&r.specific_force_B, &r.w_WB_B}) {
                   *v = Vec3(v->y(), -v->x(), v->z());
                 }
               },
               kNoCommand,
               {SelfCheck::kGyroAxes}},
        Wiring{"GyroInDegrees",
               [](SensorReading& r) { r.w_WB_B *= kDegrees; },
               kNoCommand,
               {SelfCheck::kGyroInDegrees}},
        Wiring{"GyroSign",
               [](SensorReading& r) { r.w_WB_B *= -1.0; },
               kNoCommand,
               {SelfCheck::kGyroOpposite}},
        Wiring{"GyroAxes",
               [](SensorReading& r) { std::swap(r.w_WB_B.x(), r.w_WB_B.z()); },
               kNoCommand,
               {SelfCheck::kGyroAxes}},
        Wiring{"GyroStuck",
               [](SensorReading& r) { r.w_WB_B.setZero(); },
               kNoCommand,
               {SelfCheck::kGyroStuck}},
        Wiring{"LeftAndRightSwapped",
               in_readings(kLeftRight),
               kLeftRight,
               {SelfCheck::kLegsLeftRight}},
        Wiring{"FrontAndRearSwapped",
               in_readings(kFrontRear),
               kFrontRear,
               {SelfCheck::kLegsFrontRear}},
        Wiring{"LeftAndRightReadingsSwapped",
               in_readings(kLeftRight),
               kNoCommand,
               {SelfCheck::kLegsLeftRight, SelfCheck::kLegOrder, SelfCheck::kLegsGiveWay}},
        Wiring{
            "LegOrder", in_readings(kOrder), kOrder, {SelfCheck::kLegOrder, SelfCheck::kGyroAxes}},
        Wiring{"TorqueSign",
               {},
               [](JointCommand& command) {
                 for (LegCommand& c : command) {
                   c.tau *= -1.0;
                   c.kp *= -1.0;
                   c.kd *= -1.0;
                 }
               },
               {SelfCheck::kLegsGiveWay}},
        Wiring{"FeedForwardSign",
               {},
               [](JointCommand& command) {
                 for (LegCommand& c : command) c.tau *= -1.0;
               },
               {SelfCheck::kLegsGiveWay, SelfCheck::kTorqueScale}},
        Wiring{"ClockInMilliseconds",
               [](SensorReading& r) { r.time *= 1000.0; },
               kNoCommand,
               {SelfCheck::kClockInMilliseconds}},
        Wiring{"ClockFrozen",
               [](SensorReading& r) { r.time = 1.0; },
               kNoCommand,
               {SelfCheck::kClockStopped}},
        Wiring{"ClockAtHalfRate",
               [](SensorReading& r) { r.time *= 0.5; },
               kNoCommand,
               {SelfCheck::kClockRate}},
        Wiring{"AnglesInDegrees",
               [](SensorReading& r) {
                 for (const Leg leg : kLegs) {
                   r.joint_position[leg] *= kDegrees;
                   r.joint_velocity[leg] *= kDegrees;
                 }
               },
               kNoCommand,
               {SelfCheck::kJointsInDegrees}},
        Wiring{"KneeSign",
               [](SensorReading& r) {
                 for (const Leg leg : kLegs) {
                   r.joint_position[leg].z() *= -1.0;
                   r.joint_velocity[leg].z() *= -1.0;
                 }
               },
               kNoCommand,
               {SelfCheck::kJointRange}}),
    [](const auto& of) { return std::string(of.param.name); });

TEST(Wiring, PassesTheSelfCheckWhenAllIsRight) {
  for (const char* robot : {"mini_cheetah", "go1"}) {
    for (const char* ground :
         {"flat", "slope:15", "stairs:0.05x0.20", "rough:0.04", "blocks:0.05"}) {
      const SpinController controller =
          first_seconds({.robot = robot,
                         .profile = "realistic",
                         .overrides = {std::string("plant.terrain='") + ground + "'"}},
                        {"Right", {}, {}, {}});
      EXPECT_EQ(controller.trace().self_check, SelfCheck::kPassed) << robot << " " << ground;
      EXPECT_EQ(controller.status(), ControllerStatus::kWalking) << robot << " " << ground;
    }
  }
}

TEST(Wiring, IsNotLookedAtWhenTheSelfCheckIsSwitchedOff) {
  const SpinController controller =
      first_seconds({.overrides = {"safety.self_check='none'"}}, {"Right", {}, {}, {}});
  EXPECT_EQ(controller.trace().self_check, SelfCheck::kSkipped);
}

}  // namespace
}  // namespace pirouette
