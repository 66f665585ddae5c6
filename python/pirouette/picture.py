"""Picture of a run: the robot in its middle, and the path of its centre of mass.

    python -m pirouette.picture RUN_FOLDER OUT.png

Renders without a display with MuJoCo (set MUJOCO_GL to egl or osmesa).
"""

import argparse
import sys
from pathlib import Path

from pirouette.stage import options, stage  # isort: skip - chooses the renderer for mujoco

import matplotlib
import mujoco
import numpy as np

from pirouette import command
from pirouette.robot import Poser, robot_file
from pirouette.run_folder import Run, load
from pirouette.signals import MM

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

SIZE = (1280, 960)  # pixels


def render(run: Run) -> np.ndarray:
    """The robot in the middle of the run, shape (height, width, 3)."""
    row = run.trace[len(run.trace) // 2]
    poser = Poser(stage(robot_file(run), run.ground, row["true_com_position"], SIZE, samples=4))
    camera = mujoco.MjvCamera()
    camera.lookat[:] = row["true_com_position"] - [0.0, 0.0, 0.1]
    camera.distance, camera.azimuth, camera.elevation = 1.05, 130, -24
    data = poser.set(row)
    mujoco.mj_camlight(poser.model, data)
    with mujoco.Renderer(poser.model, SIZE[1], SIZE[0]) as renderer:
        renderer.update_scene(data, camera, options())
        return renderer.render()


def draw(run: Run, out: Path) -> None:
    context, metrics = run.context, run.metrics
    com = MM * (run.record["true_com_position"][:, :2] - run.point)

    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6), width_ratios=[1.25, 1.0])
    left.imshow(render(run))
    left.axis("off")
    right.plot(com[:, 0], com[:, 1], lw=0.7, color="#1f4e79", label="centre of mass")
    right.plot(0, 0, "+", color="#b3400f", ms=12, mew=2, label="commanded point")
    reach = max(5.0, 1.1 * np.abs(com).max())
    right.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="x, mm", ylabel="y, mm")
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
    parser.add_argument("run", type=Path, help="run folder, with trace.npy and metrics.json")
    parser.add_argument("out", type=Path, help="picture to write, PNG")
    arguments = parser.parse_args()

    def body() -> None:
        with command.whole_file(arguments.out) as part:
            draw(load(arguments.run), part)

    return command.run(body)


if __name__ == "__main__":
    sys.exit(main())
