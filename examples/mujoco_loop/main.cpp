// The controller in a MuJoCo loop of your own: your model, your steps, your motors. The robot
// stands for a second, then spins on the spot. It links pirouette::controller and MuJoCo, nothing
// else.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "pirouette/base/rotation.hpp"
#include "pirouette/controller/spin_controller.hpp"

namespace {

using namespace pirouette;

constexpr double kTimestep = 0.001;      // s
constexpr int kStepsPerTick = 2;         // 500 Hz
constexpr double kYawRate = 0.7;         // rad/s
constexpr double kStanding = 1.0;        // s
constexpr double kDuration = 20.0;       // s
constexpr double kContactForce = 3.0;    // N
constexpr double kStartHeight = 0.2705;  // m, of the trunk
const Vec3 kStance(0.0, 0.884, -1.865);  // rad: abad, hip, knee of every leg

/// Where a leg's joints and foot are in the model, by the names of the robot's file.
struct LegOfModel {
  std::array<int, 3> qpos, dof;
  Vec3 torque_limit;  // N m
  int foot;
};

LegOfModel find_leg(const mjModel* model, Leg leg) {
  const std::string name(kLegNames.at(index(leg)));
  const std::array<const char*, 3> joints = {"_abad", "_hip", "_knee"};
  LegOfModel found{};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const int joint = mj_name2id(model, mjOBJ_JOINT, (name + joints[i]).c_str());
    found.qpos[i] = model->jnt_qposadr[joint];
    found.dof[i] = model->jnt_dofadr[joint];
    found.torque_limit[static_cast<Eigen::Index>(i)] = model->jnt_actfrcrange[2 * joint + 1];
  }
  found.foot = mj_name2id(model, mjOBJ_GEOM, (name + "_foot").c_str());
  return found;
}

/// The robot's file with a floor under it.
mjModel* load(const char* file) {
  char error[1000] = "";
  mjSpec* spec = mj_parseXML(file, nullptr, error, sizeof error);
  if (spec == nullptr) {
    std::fprintf(stderr, "%s\n", error);
    return nullptr;
  }
  mjsGeom* floor = mjs_addGeom(mjs_findBody(spec, "world"), nullptr);
  floor->type = mjGEOM_PLANE;
  floor->size[0] = floor->size[1] = floor->size[2] = 1.0;
  spec->option.timestep = kTimestep;
  spec->option.cone = mjCONE_ELLIPTIC;
  spec->option.impratio = 10.0;
  mjModel* model = mj_compile(spec, nullptr);
  if (model == nullptr) std::fprintf(stderr, "%s\n", mjs_getError(spec));
  mj_deleteSpec(spec);
  return model;
}

/// N, of everything that presses on the geom `foot`.
double normal_force(const mjModel* model, const mjData* data, int foot) {
  double sum = 0.0;
  for (int i = 0; i < data->ncon; ++i) {
    const mjContact& contact = data->contact[i];
    if (contact.geom[0] != foot && contact.geom[1] != foot) continue;
    mjtNum wrench[6];
    mj_contactForce(model, data, i, wrench);
    sum += wrench[0];
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: mujoco_loop ROBOT.xml\n");
    return 2;
  }
  mjModel* model = load(argv[1]);
  if (model == nullptr) return 2;
  mjData* data = mj_makeData(model);
  Result<SpinController> created = SpinController::create(ControllerConfig{}, argv[1]);
  if (!created) {
    std::fprintf(stderr, "%s\n", created.errors().front().to_string().c_str());
    return 2;
  }
  SpinController& controller = created.value();

  PerLeg<LegOfModel> legs;
  for (const Leg leg : kLegs) {
    legs[leg] = find_leg(model, leg);
    for (std::size_t i = 0; i < 3; ++i) {
      data->qpos[legs[leg].qpos[i]] = kStance[static_cast<Eigen::Index>(i)];
    }
  }
  data->qpos[2] = kStartHeight;  // the trunk's free joint comes first
  mj_forward(model, data);
  BasePose start;
  start.p_WB.z() = kStartHeight;
  controller.reset(start);

  const int trunk = model->jnt_bodyid[0];
  Vec2 point = Vec2::Zero();
  double farthest = 0.0, turned = 0.0, last_yaw = 0.0;
  for (int tick = 0; data->time < kDuration; ++tick) {
    // What the robot measures: encoders, gyro, accelerometer, contact flags.
    SensorReading reading;
    reading.time = data->time;
    PerLeg<bool> contact;
    for (const Leg leg : kLegs) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto joint = static_cast<Eigen::Index>(i);
        reading.joint_position[leg][joint] = data->qpos[legs[leg].qpos[i]];
        reading.joint_velocity[leg][joint] = data->qvel[legs[leg].dof[i]];
      }
      contact[leg] = normal_force(model, data, legs[leg].foot) > kContactForce;
    }
    reading.foot_contact = contact;
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_WB(data->xmat +
                                                                              9 * trunk);
    const Eigen::Map<const Vec3> a_WB_W(data->qacc);
    reading.specific_force_B = R_WB.transpose() * (a_WB_W + Vec3(0.0, 0.0, kGravity));
    reading.w_WB_B = Eigen::Map<const Vec3>(data->qvel + 3);

    MotionCommand motion;
    motion.walk = data->time >= kStanding;
    motion.yaw_rate = kYawRate;
    const JointCommand& command = controller.tick(reading, motion);

    // The motors: PD and feed-forward at the physics' rate, within their limits.
    for (int step = 0; step < kStepsPerTick; ++step) {
      for (const Leg leg : kLegs) {
        const LegCommand& c = command[leg];
        for (std::size_t i = 0; i < 3; ++i) {
          const auto joint = static_cast<Eigen::Index>(i);
          const double torque = c.tau[joint] +
                                c.kp[joint] * (c.q[joint] - data->qpos[legs[leg].qpos[i]]) +
                                c.kd[joint] * (c.dq[joint] - data->qvel[legs[leg].dof[i]]);
          const double limit = legs[leg].torque_limit[joint];
          data->qfrc_applied[legs[leg].dof[i]] = std::clamp(torque, -limit, limit);
        }
      }
      mj_step(model, data);
    }

    const Vec2 com(data->subtree_com[3 * trunk], data->subtree_com[3 * trunk + 1]);
    const double yaw = rpy_from_rotation(R_WB).yaw;
    if (!motion.walk) point = com;
    farthest = std::max(farthest, (com - point).norm());
    turned += wrap_angle(yaw - last_yaw);
    last_yaw = yaw;
  }

  std::printf("%.2f turns, the centre of mass within %.1f mm of its point\n", turned / (2.0 * kPi),
              1e3 * farthest);
  const double asked = kYawRate * (kDuration - kStanding);
  const bool walked = !is_stood_down(controller.status()) && turned > 0.9 * asked;
  mj_deleteData(data);
  mj_deleteModel(model);
  return walked ? 0 : 1;
}
