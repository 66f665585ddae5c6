"""Picture of a robot that stands, with its legs, joint axes and feet named.

pirouette robot check ROBOT --picture FILE draws it.
"""

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D

from pirouette import style
from pirouette.api import robot_check
from pirouette.errors import Error

ROLES = ("abad", "hip", "knee")
AXIS_LENGTH = 0.25  # of the leg
SPHERE = np.linspace(0.0, np.pi, 9), np.linspace(0.0, 2.0 * np.pi, 17)


def draw_sphere(axes: Axes3D, centre: np.ndarray, radius: float, colour: str) -> None:
    down, around = np.meshgrid(*SPHERE)
    x = centre[0] + radius * np.sin(down) * np.cos(around)
    y = centre[1] + radius * np.sin(down) * np.sin(around)
    z = centre[2] + radius * np.cos(down)
    axes.plot_surface(x, y, z, color=colour, linewidth=0)


def robot_figure(check: dict[str, Any]) -> Figure:
    """The figure of a pirouette.robot_check(): m, trunk axes, x forward and y left."""
    figure = Figure(figsize=(10.0, 8.0))
    FigureCanvasAgg(figure)
    axes = figure.add_subplot(projection="3d")
    points = {name: np.array(leg["points_B"]) for name, leg in check["legs"].items()}
    corners = [points[name][0] for name in ("FR", "FL", "RL", "RR", "FR")]
    axes.plot(*np.array(corners).T, color="0.3", lw=3)
    for i, (name, leg) in enumerate(check["legs"].items()):
        colour, chain = style.colour(i), points[name]
        axes.plot(*chain.T, color=colour, lw=3, marker="o", ms=4)
        draw_sphere(axes, chain[-1], leg["foot_radius"], colour)
        below = chain[-1] - [0.0, 0.0, 2.5 * leg["foot_radius"]]
        label = f"{name}: {leg['foot']}"
        axes.text(*below, label, color=colour, fontsize=9, ha="center", va="top")
        length = AXIS_LENGTH * (leg["thigh"] + leg["shank"])
        for j, role in enumerate(ROLES):
            axis = length * np.array(leg["axes_B"][j])
            axes.quiver(*chain[j], *axis, color="k", lw=1, arrow_length_ratio=0.2)
            axes.text(*(chain[j] + axis), f"{role} {leg['joints'][j]}", fontsize=7)
    axes.scatter(*check["com_B"], color="k", marker="x", s=60)
    axes.text(*check["com_B"], " CoM")
    axes.set(xlabel="x forward, m", ylabel="y left, m", zlabel="z up, m")
    axes.set_aspect("equal")
    figure.subplots_adjust(left=-0.1, right=1.1, bottom=-0.1, top=1.0)
    axes.view_init(elev=18, azim=-60)
    axes.set_title(
        f"{Path(check['file']).name}: {check['mass']:.4g} kg, CoM {check['height']:.3g} m above the ground; "
        "arrows: positive turns of the file's joints",
        fontsize=9,
    )
    return figure


def main() -> int:
    parser = argparse.ArgumentParser(prog="pirouette-robot-picture", description=__doc__)
    parser.add_argument("robot", help="name of a robot, or an MJCF, URDF or robot.toml file")
    parser.add_argument("picture", type=Path, help="PNG, PDF or SVG file to write")
    arguments = parser.parse_args()
    try:
        robot_figure(robot_check(arguments.robot)).savefig(arguments.picture, dpi=150)
    except (Error, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
