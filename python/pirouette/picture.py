"""Picture of runs for a README or slides: the robot of the first, and how far it strayed in each.

Renders without a display with MuJoCo (set MUJOCO_GL to egl or osmesa).
"""

from pathlib import Path

from pirouette.stage import add_forces, add_line, options, renderer, stage  # isort: skip - before mujoco

import mujoco
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from pirouette import style
from pirouette.robot import Poser, robot_file
from pirouette.run_folder import Run
from pirouette.signals import MM

SIZE = (1280, 1120)  # pixels
PATH_POINTS = 400
ABOVE_GROUND = 0.004  # m, at which the path is drawn
DASHES = {"solid": "-", "dash": "--", "dot": ":", "dashdot": "-."}


def render(run: Run) -> np.ndarray:
    """The robot in the middle of the run, its contact forces, and its path if it went anywhere;
    shape (height, width, 3)."""
    com = run.trace["true_com_position"]
    row = run.trace[len(run.trace) // 2]
    poser = Poser(stage(robot_file(run), run.ground, com, SIZE, samples=8, pitch=0.01))
    camera = mujoco.MjvCamera()
    camera.lookat[:] = row["true_com_position"] - [0.0, 0.0, 0.1]
    camera.distance, camera.azimuth, camera.elevation = 1.0, 35, -24
    data = poser.set(row)
    mujoco.mj_camlight(poser.model, data)
    with renderer(poser.model, SIZE) as painter:
        painter.update_scene(data, camera, options())
        if run.has("true_foot_force", "true_foot_position"):
            add_forces(painter.scene, row)
        if not run.spins:
            path = com[:: max(1, len(com) // PATH_POINTS)].copy()
            path[:, 2] = run.ground.height(path[:, 0], path[:, 1]) + ABOVE_GROUND
            add_line(painter.scene, path)
        return painter.render()


def look(i: int) -> dict:
    return {"color": style.colour(i), "ls": DASHES.get(style.dash(i), "-")}


def draw_paths(axes: Axes, runs: list[Run]) -> None:
    """The centre of mass from the commanded point; of several runs the first on top."""
    for i, run in reversed(list(enumerate(runs))):
        com = MM * (run.record["true_com_position"][:, :2] - run.point)
        axes.plot(com[:, 0], com[:, 1], lw=0.7, color=style.colour(i))
    axes.plot(0, 0, "+", color=style.NEUTRAL, ms=12, mew=2)
    axes.set(xlabel="x, mm", ylabel="y, mm", title="Path of the centre of mass")
    axes.set_aspect("equal", adjustable="datalim")


def draw_distances(axes: Axes, runs: list[Run]) -> None:
    """Distance to the commanded point, or to the reference on a path, over time."""
    largest = 0.0
    for i, run in enumerate(runs):
        rows = run.trace
        goal = run.point if run.spins else rows["path_position"]
        distance = MM * np.linalg.norm(rows["true_com_position"][:, :2] - goal, axis=1)
        mean = distance[rows["time"] >= run.record_start].mean()
        label = f"{run.name}: {mean:.3g} mm on the average"
        axes.plot(rows["time"], distance, lw=1.0, label=label, **look(i))
        largest = max(largest, distance.max())
    axes.set(xlabel="time, s", ylabel="mm", title="Distance to where it is to be")
    axes.set_ylim(0.0, (1.1 + 0.25 * len(runs)) * largest)  # the legend is above the curves
    axes.set_xmargin(0)
    axes.legend(fontsize=8, frameon=False, loc="upper left")


def write_picture(runs: list[Run], file: Path) -> None:
    """The picture as a PNG of about 1150 x 500 pixels."""
    figure = Figure(figsize=(11, 4.8), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subfigures(1, 2, width_ratios=[1.1, 1.0])
    robot = left.add_axes((0, 0, 1, 1))
    robot.imshow(render(runs[0]))
    robot.axis("off")
    path, distance = right.subplots(2, 1, height_ratios=[2.2, 1.0])
    draw_paths(path, runs)
    draw_distances(distance, runs)
    for axes in (path, distance):
        axes.grid(alpha=0.3)
        axes.title.set_size(10)
    context = runs[0].context
    figure.suptitle(f"{context['terrain']}, {context['yaw_rate']:g} rad/s, blind", fontsize=10)
    figure.savefig(file, dpi=105, format="png", pil_kwargs={"optimize": True})
