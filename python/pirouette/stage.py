"""A robot on its ground under a light sky, for MuJoCo's renderer, which works without a display."""

import os
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")  # read when mujoco is imported

import mujoco  # noqa: E402
import numpy as np  # noqa: E402

from pirouette.ground import Ground  # noqa: E402

PITCH = 0.02  # m, between the heights that are drawn
HALF_SIZE = 2.0  # m, of uneven ground around its centre
DEPTH = 0.1  # m, of ground below its lowest point
COLLISION_GROUP = 3  # of geoms, not drawn


def stage(
    robot_file: Path, ground: Ground, centre: np.ndarray, size: tuple[int, int], samples: int
) -> mujoco.MjModel:
    """Model for frames of size (width, height) in pixels, with this many samples a pixel; uneven
    ground lies around centre (m)."""
    spec = mujoco.MjSpec.from_file(str(robot_file))
    spec.visual.global_.offwidth, spec.visual.global_.offheight = size
    spec.visual.quality.offsamples = samples
    spec.add_texture(
        name="floor",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.86, 0.87, 0.88],
        rgb2=[0.80, 0.81, 0.83],
        width=256,
        height=256,
    )
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[1.0, 1.0, 1.0],
        rgb2=[0.82, 0.88, 0.94],
        width=256,
        height=1536,
    )
    material = spec.add_material(name="floor", texrepeat=[8, 8], texuniform=True)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "floor"
    add_ground(spec, ground, centre)
    spec.worldbody.add_light(pos=[1.0, -1.0, 3.0], dir=[-0.3, 0.3, -1.0], castshadow=True)
    return spec.compile()


def add_ground(spec: mujoco.MjSpec, ground: Ground, centre: np.ndarray) -> None:
    if np.ptp(ground.z) == 0.0:
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_PLANE,
            size=[5, 5, 0.1],
            material="floor",
            pos=[0, 0, ground.z[0, 0]],
        )
        return
    steps = np.arange(-HALF_SIZE, HALF_SIZE + PITCH / 2, PITCH)
    drawn = ground.sampled(centre[0] + steps, centre[1] + steps).z
    low, height = drawn.min(), np.ptp(drawn)
    spec.add_hfield(
        name="ground",
        nrow=len(steps),
        ncol=len(steps),
        size=[HALF_SIZE, HALF_SIZE, height, DEPTH],
        userdata=((drawn - low) / height).ravel(),
    )
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname="ground",
        material="floor",
        pos=[centre[0], centre[1], low],
    )


def options() -> mujoco.MjvOption:
    """What is drawn: no collision shapes."""
    chosen = mujoco.MjvOption()
    chosen.geomgroup[COLLISION_GROUP] = 0
    return chosen
