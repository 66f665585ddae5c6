"""A robot on its ground under a light sky, for MuJoCo's renderer, which works without a display."""

import os
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")  # read when mujoco is imported

import numpy as np  # noqa: E402

from pirouette.errors import Error  # noqa: E402
from pirouette.ground import Ground  # noqa: E402

NO_RENDERER = (
    f"MUJOCO_GL={os.environ['MUJOCO_GL']}: MuJoCo's renderer does not start: {{}}; allowed: egl "
    "(Debian: libegl1 libgl1-mesa-dri) or osmesa (Debian: libosmesa6)"
)
try:
    import mujoco
except (ImportError, AttributeError) as error:  # PyOpenGL's way to say that a library is missing
    raise Error(NO_RENDERER.format(error)) from None

MOST_LINES = 600  # of uneven ground along one axis
MARGIN = 1.5  # m, of uneven ground around what is to be seen
LEVEL_MARGIN = 3.5  # m, more of level ground
DEPTH = 0.1  # m, of ground below its lowest point
COLLISION_GROUP = 3  # of geoms, not drawn
METRES_PER_NEWTON = 0.004
LEAST_FORCE = 1.0  # N, that is drawn
ARROW_RADIUS, LINE_RADIUS = 0.008, 0.002  # m
YELLOW, BLUE = (0.90, 0.62, 0.0, 1.0), (0.0, 0.45, 0.70, 1.0)  # red, green, blue, opacity


def stage(
    robot_file: Path,
    ground: Ground,
    path: np.ndarray,
    size: tuple[int, int],
    samples: int,
    pitch: float,
) -> mujoco.MjModel:
    """Model for frames of size (width, height) in pixels, with this many samples a pixel; uneven
    ground lies around the path (m, shape (n, 3)), with a line every pitch (m)."""
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
    add_ground(spec, ground, path[:, :2], pitch)
    spec.worldbody.first_body().add_light(
        mode=mujoco.mjtCamLight.mjCAMLIGHT_TRACK,
        pos=[-1.0, -1.0, 2.7],
        dir=[0.3, 0.3, -1.0],
        castshadow=True,
    )
    return spec.compile()


def add_ground(spec: mujoco.MjSpec, ground: Ground, path: np.ndarray, pitch: float) -> None:
    low, high = path.min(axis=0) - MARGIN, path.max(axis=0) + MARGIN
    counts = np.minimum((high - low) / pitch + 1, MOST_LINES).astype(int)
    z = ground.sampled(*(np.linspace(*ends) for ends in zip(low, high, counts, strict=True))).z
    middle, bottom, height = 0.5 * (low + high), z.min(), np.ptp(z)
    if height == 0.0:
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_PLANE,
            size=[*(0.5 * (high - low) + LEVEL_MARGIN), 0.1],
            material="floor",
            pos=[*middle, bottom],
        )
        return
    spec.add_hfield(
        name="ground",
        nrow=counts[1],
        ncol=counts[0],
        size=[*(0.5 * (high - low)), height, DEPTH],
        userdata=((z - bottom) / height).ravel(),
    )
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_HFIELD,
        hfieldname="ground",
        material="floor",
        pos=[*middle, bottom],
    )


def add_forces(scene: mujoco.MjvScene, row: np.void) -> None:
    """Arrows of the true contact forces in a row of the trace."""
    for foot, force in zip(row["true_foot_position"], row["true_foot_force"], strict=True):
        if np.linalg.norm(force) > LEAST_FORCE:
            tip = foot + METRES_PER_NEWTON * force
            connect(scene, mujoco.mjtGeom.mjGEOM_ARROW, ARROW_RADIUS, foot, tip, YELLOW)


def add_line(scene: mujoco.MjvScene, points: np.ndarray) -> None:
    """A line through points (m, shape (n, 3))."""
    for start, end in zip(points[:-1], points[1:], strict=True):
        connect(scene, mujoco.mjtGeom.mjGEOM_CAPSULE, LINE_RADIUS, start, end, BLUE)


def connect(
    scene: mujoco.MjvScene,
    kind: mujoco.mjtGeom,
    radius: float,
    start: np.ndarray,
    end: np.ndarray,
    rgba: tuple[float, float, float, float],
) -> None:
    """Adds a slender shape between two points, m, to what is drawn next."""
    geom = scene.geoms[scene.ngeom]
    mujoco.mjv_initGeom(geom, kind, np.zeros(3), np.zeros(3), np.zeros(9), np.array(rgba, "f4"))
    mujoco.mjv_connector(geom, kind, radius, start, end)
    scene.ngeom += 1


def renderer(model: mujoco.MjModel, size: tuple[int, int]) -> mujoco.Renderer:
    """Of frames of size (width, height) in pixels. Raises Error."""
    try:
        return mujoco.Renderer(model, size[1], size[0])
    except (AttributeError, ImportError, RuntimeError) as error:
        raise Error(NO_RENDERER.format(error)) from None


def options() -> mujoco.MjvOption:
    """What is drawn: no collision shapes."""
    chosen = mujoco.MjvOption()
    chosen.geomgroup[COLLISION_GROUP] = 0
    return chosen
