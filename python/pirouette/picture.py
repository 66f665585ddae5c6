"""Picture of a run: the robot rendered at its start, and the path of its centre of mass.

    python -m pirouette.picture RUN_FOLDER OUT.png

Reads trace.npy and metrics.json of a run folder; renders headless with MuJoCo (set MUJOCO_GL to egl or
osmesa).
"""

import argparse
import json
import os
import sys
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")

import matplotlib  # noqa: E402

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import mujoco  # noqa: E402
import numpy as np  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
MM = 1e3


def scene(robot_file: Path) -> mujoco.MjModel:
    """The robot on a checkered floor under a light sky."""
    spec = mujoco.MjSpec.from_file(str(robot_file))
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1280, 960
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
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[3, 3, 0.1],
        material="floor",
        pos=[0, 0, 0],
    )
    spec.worldbody.add_light(
        pos=[1.0, -1.0, 3.0], dir=[-0.3, 0.3, -1.0], castshadow=True
    )
    return spec.compile()


def set_pose(model: mujoco.MjModel, data: mujoco.MjData, row: np.void) -> None:
    """Puts the robot where it truly was in this row of the trace."""
    roll, pitch, yaw = row["true_rpy"]
    quaternion = np.zeros(4)
    mujoco.mju_euler2Quat(quaternion, np.array([yaw, pitch, roll]), "zyx")
    data.qpos[:3] = row["true_base_position"]
    data.qpos[3:7] = quaternion
    data.qpos[7:] = row["true_joint_position"].ravel()
    mujoco.mj_forward(model, data)


def render(model: mujoco.MjModel, row: np.void) -> np.ndarray:
    data = mujoco.MjData(model)
    set_pose(model, data, row)
    camera = mujoco.MjvCamera()
    camera.lookat[:] = [0.0, 0.0, 0.17]
    camera.distance, camera.azimuth, camera.elevation = 1.05, 130, -24
    options = mujoco.MjvOption()
    options.geomgroup[3] = 0
    with mujoco.Renderer(model, 960, 1280) as renderer:
        renderer.update_scene(data, camera, options)
        return renderer.render()


def draw(run: Path, out: Path) -> None:
    trace = np.load(run / "trace.npy")
    metrics = json.loads((run / "metrics.json").read_text())
    context = metrics["context"]
    robot = Path(context["robot"])
    robot_file = (
        robot if robot.suffix == ".xml" else ROOT / f"robots/{robot}/{robot}.xml"
    )

    point = np.array([context["point_x"], context["point_y"]])
    recorded = trace["time"] > trace["time"][-1] - context["duration_s"] + 6.0
    com = MM * (trace["true_com_position"][recorded, :2] - point)

    figure, (left, right) = plt.subplots(
        1, 2, figsize=(11, 4.6), width_ratios=[1.25, 1.0]
    )
    left.imshow(render(scene(robot_file), trace[len(trace) // 2]))
    left.axis("off")
    right.plot(com[:, 0], com[:, 1], lw=0.7, color="#1f4e79", label="centre of mass")
    right.plot(0, 0, "+", color="#b3400f", ms=12, mew=2, label="commanded point")
    reach = max(5.0, 1.1 * np.abs(com).max())
    right.set(
        xlim=(-reach, reach), ylim=(-reach, reach), xlabel="x, mm", ylabel="y, mm"
    )
    right.set_aspect("equal")
    right.grid(alpha=0.3)
    right.legend(loc="upper right", frameon=False)
    right.set_title(
        f"{metrics['turns_done']:.0f} turns at {context['yaw_rate']:g} rad/s, {context['terrain']}, "
        f"blind: {metrics['com']['distance_to_point_mean_mm']:.1f} mm from the point",
        fontsize=10,
    )
    figure.tight_layout()
    figure.savefig(out, dpi=110)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "run", type=Path, help="run folder, with trace.npy and metrics.json"
    )
    parser.add_argument("out", type=Path, help="picture to write, PNG")
    arguments = parser.parse_args()
    missing = [
        n for n in ("trace.npy", "metrics.json") if not (arguments.run / n).is_file()
    ]
    if missing:
        print(
            f"error: {arguments.run}: no run folder, {' and '.join(missing)} missing",
            file=sys.stderr,
        )
        return 2
    draw(arguments.run, arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
