"""What the plots of `pirouette reproduce` are made of: looks, traces, panels."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from pirouette.signals import MM

RECORD = 10.0  # s, of figure 7

# Okabe and Ito: told apart with any colour vision. Line styles say the same again, for print.
COLOURS = [
    "#000000",
    "#7f7f7f",
    "#d55e00",
    "#e69f00",
    "#cc79a7",
    "#0072b2",
    "#56b4e9",
    "#009e73",
]
STYLES = ["-", "--", "-", "--", "-.", "-", "--", "-"]
MARKERS = ["o", "o", "s", "s", "v", "^", "D", "D"]

Style = dict[str, dict[str, str]]


def styles(report: dict) -> Style:
    """Colour, line and marker of each row; the same row looks the same in every figure."""
    order = [
        "MIT, velocity",
        "MIT, integrated",
        "MIT+FKM, velocity",
        "MIT+FKM, integrated",
        "MIT+LQR",
        "ASC",
        "ours, duty 0.5",
        "ours",
    ]
    labels = list(dict.fromkeys(e["label"] for e in report["entries"]))
    order += [label for label in labels if label not in order]
    return {
        label: {
            "color": COLOURS[i % len(COLOURS)],
            "linestyle": STYLES[i % len(STYLES)],
            "marker": MARKERS[i % len(MARKERS)],
        }
        for i, label in enumerate(order)
    }


def traced(report: dict, folder: Path) -> Iterator[tuple[dict, np.ndarray]]:
    """The entries that kept a trace, with its recorded part."""
    for entry in report["entries"]:
        if entry["trace"] is None or not (folder / entry["trace"]).is_file():
            continue
        rows = np.load(folder / entry["trace"])
        rows = rows[rows["time"] >= entry["record_start_s"]]
        if len(rows) > 1:
            yield entry, rows


def place(entry: dict) -> str:
    """What the traced trials have in common."""
    return (
        f"{entry['terrain']}, torsional friction {entry['torsional_friction']:g} m, {entry['profile']} plant, "
        f"{entry['estimator']} filter, {entry['yaw_rate']:g} rad/s"
    )


def add_legend(figure: plt.Figure, axes: plt.Axes) -> None:
    """One legend for all panels, below them."""
    handles, labels = axes.get_legend_handles_labels()
    if not handles:
        return
    legend = figure.legend(
        handles,
        labels,
        fontsize=8,
        loc="outside lower center",
        ncols=len(labels),
        frameon=False,
    )
    for line in legend.get_lines():
        line.set(linewidth=1.5, alpha=1.0)


def on_terrain(report: dict, terrain: str) -> dict:
    """The report with only those entries."""
    return report | {"entries": [e for e in report["entries"] if e["terrain"] == terrain]}


def terrains(report: dict) -> list[str]:
    return list(dict.fromkeys(e["terrain"] for e in report["entries"]))


def draw_paths(axes: plt.Axes, report: dict, folder: Path, look: Style) -> str:
    title = "no traces kept"
    for entry, rows in traced(report, folder):
        com = MM * rows["true_com_position"][:, :2]
        com = com - com.mean(axis=0)
        style = look[entry["label"]]
        axes.plot(
            com[:, 0],
            com[:, 1],
            lw=0.7,
            color=style["color"],
            ls=style["linestyle"],
            label=entry["label"],
        )
        title = place(entry)
    axes.set(xlabel="x from the mean point, mm", ylabel="y from the mean point, mm")
    axes.set_aspect("equal", adjustable="datalim")
    return title


def from_mean(rows: np.ndarray, axis: int) -> np.ndarray:
    """The CoM along a world axis from its mean, mm."""
    x = rows["true_com_position"][:, axis]
    return MM * (x - x.mean())


Signal = tuple[str, Callable[[np.ndarray], np.ndarray]]

SIGNALS: list[Signal] = [
    ("x, mm", lambda rows: from_mean(rows, 0)),
    ("y, mm", lambda rows: from_mean(rows, 1)),
    ("x velocity, mm/s", lambda rows: MM * rows["true_com_velocity"][:, 0]),
    ("y velocity, mm/s", lambda rows: MM * rows["true_com_velocity"][:, 1]),
    ("roll, rad", lambda rows: rows["true_rpy"][:, 0]),
    ("pitch, rad", lambda rows: rows["true_rpy"][:, 1]),
]


def relative_attitude(rpy: np.ndarray, normal_W: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Roll and pitch (rad, N each) of the trunk from the plane with that unit normal, for N rows of
    roll, pitch and yaw (rad); docs/equations.md#metrics.
    """
    roll, pitch, yaw = rpy.T
    # n_B = Rx(roll)' Ry(pitch)' Rz(yaw)' n_W, one rotation at a time.
    x = np.cos(yaw) * normal_W[0] + np.sin(yaw) * normal_W[1]
    y = -np.sin(yaw) * normal_W[0] + np.cos(yaw) * normal_W[1]
    x, z = (
        np.cos(pitch) * x - np.sin(pitch) * normal_W[2],
        np.sin(pitch) * x + np.cos(pitch) * normal_W[2],
    )
    y, z = np.cos(roll) * y + np.sin(roll) * z, -np.sin(roll) * y + np.cos(roll) * z
    return np.arctan2(y, z), np.arctan2(-x, np.hypot(y, z))


def relative_signals(normal_W: np.ndarray) -> list[Signal]:
    return [
        ("roll from plane, rad", lambda rows: relative_attitude(rows["true_rpy"], normal_W)[0]),
        ("pitch from plane, rad", lambda rows: relative_attitude(rows["true_rpy"], normal_W)[1]),
    ]


def draw_signals(
    panels: Sequence[plt.Axes],
    signals: list[Signal],
    report: dict,
    folder: Path,
    look: Style,
) -> str:
    """One panel for each signal, over the first seconds of the traced trials."""
    title = "no traces kept"
    for entry, rows in traced(report, folder):
        record = rows[rows["time"] <= rows["time"][0] + RECORD]
        style = look[entry["label"]]
        title = place(entry)
        for axes, (_, signal) in zip(panels, signals, strict=True):
            axes.plot(
                record["time"] - record["time"][0],
                signal(record),
                lw=0.8,
                color=style["color"],
                ls=style["linestyle"],
                label=entry["label"],
            )
    for axes, (name, _) in zip(panels, signals, strict=True):
        axes.set_ylabel(name)
    return title
