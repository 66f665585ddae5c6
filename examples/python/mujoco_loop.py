"""The controller in a MuJoCo loop of your own, in Python: stands for a second, then spins.

python examples/python/mujoco_loop.py robots/mini_cheetah/mini_cheetah.xml
"""

import sys

import mujoco
import numpy as np

import pirouette

YAW_RATE = 0.7  # rad/s
STANDING, SETTLING, DURATION = 1.0, 5.0, 24.0  # s
CONTACT_FORCE = 3.0  # N
LEGS = ("FR", "FL", "RR", "RL")

if len(sys.argv) != 2:
    sys.exit(f"usage: python {sys.argv[0]} ROBOT.xml")
robot = mujoco.MjSpec.from_file(sys.argv[1])
robot.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[1, 1, 1])
robot.option.timestep, robot.option.impratio = 0.001, 10.0
robot.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
model = robot.compile()
data = mujoco.MjData(model)
joints = [model.joint(f"{leg}_{name}").id for leg in LEGS for name in ("abad", "hip", "knee")]
feet = [model.geom(f"{leg}_foot").id for leg in LEGS]
q, dq = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
limit = model.jnt_actfrcrange[joints, 1]  # N m
data.qpos[2] = 0.2705  # m, of the trunk
data.qpos[q] = np.tile([0.0, 0.884, -1.865], 4)
mujoco.mj_forward(model, data)


def presses(foot: int) -> bool:
    """The ground's force on the geom is one that a contact sensor would notice."""
    wrench, force = np.zeros(6), 0.0
    for i, contact in enumerate(data.contact):
        if foot in contact.geom:
            mujoco.mj_contactForce(model, data, i, wrench)
            force += wrench[0]
    return force > CONTACT_FORCE


controller = pirouette.Controller()
controller.reset(data.qpos[:3], np.eye(3))
time, com, yaw = [], [], []
while data.time < DURATION:
    R_WB = data.body("trunk").xmat.reshape(3, 3)
    reading = pirouette.SensorReading()
    reading.time = data.time
    reading.joint_position = data.qpos[q].reshape(4, 3)
    reading.joint_velocity = data.qvel[dq].reshape(4, 3)
    reading.specific_force_B = R_WB.T @ (data.qacc[:3] + [0.0, 0.0, 9.81])
    reading.w_WB_B = data.qvel[3:6]
    reading.foot_contact = [presses(foot) for foot in feet]
    motion = pirouette.MotionCommand(walk=data.time >= STANDING, yaw_rate=YAW_RATE)
    command = controller.tick(reading, motion)
    for _ in range(round(controller.period / model.opt.timestep)):
        torque = command.torque(data.qpos[q].reshape(4, 3), data.qvel[dq].reshape(4, 3)).ravel()
        data.qfrc_applied[dq] = np.clip(torque, -limit, limit)
        mujoco.mj_step(model, data)
    if data.time >= STANDING + SETTLING:
        time.append(data.time)
        com.append(data.body("trunk").subtree_com.copy())
        yaw.append(np.arctan2(R_WB[1, 0], R_WB[0, 0]))

measured = pirouette.metrics(time, com, yaw, yaw_rate=YAW_RATE)
print(f"{measured['turns_done']:.2f} turns, radius {measured['com']['radius_mean_mm']:.2f} mm")
sys.exit(1 if controller.stood_down else 0)
