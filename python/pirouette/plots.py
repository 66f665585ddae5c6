"""Plots of `pirouette reproduce`: figures 6, 7 and 8 of [Zhu21] with this project's trials.

    python -m pirouette.plots FOLDER

Reads fig6.json, fig7.json, fig8.json and the traces of FOLDER, whichever are there; writes an SVG and a PNG
beside each.
"""

import argparse
import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from pirouette.signals import CUTOFF, MM, accelerations  # noqa: E402

RECORD = 10.0  # s, of figure 7
RADII = [0.5, 1, 2, 5, 10, 20, 50, 100]  # mm, marked on the axis

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
        f"torsional friction {entry['torsional_friction']:g} m, {entry['profile']} plant, "
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


def draw_radii(axes: plt.Axes, report: dict, profile: str, look: Style) -> None:
    metric = "com.radius_mean_mm"
    entries = [e for e in report["entries"] if e["profile"] == profile and metric in e["metrics"]]
    for label in dict.fromkeys(e["label"] for e in entries):
        own = [e for e in entries if e["label"] == label]
        x = [e["torsional_friction"] for e in own]
        y = [e["metrics"][metric]["mean"] for e in own]
        spread = [e["metrics"][metric]["deviation"] for e in own]
        style = look[label]
        axes.errorbar(
            x,
            y,
            spread,
            lw=1.0,
            ms=4,
            capsize=2,
            color=style["color"],
            ls=style["linestyle"],
            marker=style["marker"],
            label=label,
        )
    printed = {}
    for e in entries:
        if metric in (e["printed"] or {}):
            printed.setdefault(e["paper"], (e["printed"][metric], look[e["label"]]))
    for paper, (value, style) in printed.items():
        axes.axhline(value, lw=0.6, ls=":", color=style["color"])
        axes.annotate(
            f"{paper}, printed",
            (1.0, value),
            xycoords=("axes fraction", "data"),
            fontsize=6,
            ha="right",
            va="bottom",
            color=style["color"],
        )
    ticks = sorted({e["torsional_friction"] for e in entries})
    axes.set(xscale="log", yscale="log", xlabel="torsional friction, m", ylabel="radius, mm")
    axes.set_xticks(ticks, [f"{t:g}" for t in ticks])
    axes.set_yticks(RADII, [f"{r:g}" for r in RADII])
    axes.minorticks_off()
    axes.set_title(f"{profile} plant", fontsize=8)


def draw_fig6(report: dict, folder: Path) -> plt.Figure:
    look = styles(report)
    profiles = list(dict.fromkeys(e["profile"] for e in report["entries"]))
    figure, panels = plt.subplots(
        1,
        1 + len(profiles),
        figsize=(5.0 + 3.6 * len(profiles), 4.6),
        layout="constrained",
    )
    title = draw_paths(panels[0], report, folder, look)
    panels[0].set_title(title, fontsize=8)
    for axes, profile in zip(panels[1:], profiles, strict=True):
        if axes is not panels[1]:
            axes.sharey(panels[1])
        draw_radii(axes, report, profile, look)
    add_legend(figure, panels[1])
    return figure


def draw_fig7(report: dict, folder: Path) -> plt.Figure:
    look = styles(report)
    signals: list[tuple[str, Callable[[np.ndarray], np.ndarray]]] = [
        (
            "x, mm",
            lambda rows: MM
            * (rows["true_com_position"][:, 0] - rows["true_com_position"][:, 0].mean()),
        ),
        (
            "y, mm",
            lambda rows: MM
            * (rows["true_com_position"][:, 1] - rows["true_com_position"][:, 1].mean()),
        ),
        ("x velocity, mm/s", lambda rows: MM * rows["true_com_velocity"][:, 0]),
        ("y velocity, mm/s", lambda rows: MM * rows["true_com_velocity"][:, 1]),
        ("roll, rad", lambda rows: rows["true_rpy"][:, 0]),
        ("pitch, rad", lambda rows: rows["true_rpy"][:, 1]),
    ]
    figure, panels = plt.subplots(3, 2, figsize=(10.0, 7.5), sharex=True, layout="constrained")
    title = "no traces kept"
    for entry, rows in traced(report, folder):
        record = rows[rows["time"] <= rows["time"][0] + RECORD]
        style = look[entry["label"]]
        title = place(entry)
        for axes, (_, signal) in zip(panels.flat, signals, strict=True):
            time = record["time"] - record["time"][0]
            axes.plot(
                time,
                signal(record),
                lw=0.8,
                color=style["color"],
                ls=style["linestyle"],
                label=entry["label"],
            )
    for axes, (name, _) in zip(panels.flat, signals, strict=True):
        axes.set_ylabel(name)
    for axes in panels[-1]:
        axes.set_xlabel("time, s")
    add_legend(figure, panels[0, 0])
    figure.suptitle(title, fontsize=9)
    return figure


def draw_fig8(report: dict, folder: Path) -> plt.Figure:
    """A column for each row of the experiment: one over the other they would hide each other."""
    look = styles(report)
    entries = list(traced(report, folder))
    columns = max(1, len(entries))
    figure, panels = plt.subplots(
        2,
        columns,
        figsize=(2.6 * columns + 0.6, 5.4),
        sharex="row",
        sharey="row",
        squeeze=False,
        layout="constrained",
    )
    for (linear, angular), (entry, rows) in zip(panels.T, entries, strict=False):
        colour = look[entry["label"]]["color"]
        for axes, x in zip((linear, angular), accelerations(rows), strict=True):
            axes.plot(x[:, 0], x[:, 1], lw=0.4, color=colour)
        linear.set_title(entry["label"], fontsize=9)
        linear.set_xlabel("x, m/s²")
        angular.set_xlabel("roll, rad/s²")
    panels[0, 0].set_ylabel("y, m/s²")
    panels[1, 0].set_ylabel("pitch, rad/s²")
    title = place(entries[0][0]) if entries else "no traces kept"
    figure.suptitle(f"Accelerations, {CUTOFF:g} Hz low-pass; {title}", fontsize=9)
    return figure


FIGURES = {"fig6": draw_fig6, "fig7": draw_fig7, "fig8": draw_fig8}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="folder of `pirouette reproduce`")
    folder = parser.parse_args().folder
    found = [name for name in FIGURES if (folder / f"{name}.json").is_file()]
    if not found:
        print(
            f"error: {folder}: none of {', '.join(FIGURES)} was reproduced here",
            file=sys.stderr,
        )
        return 2
    for name in found:
        report = json.loads((folder / f"{name}.json").read_text())
        figure = FIGURES[name](report, folder)
        for axes in figure.axes:
            axes.grid(alpha=0.25, lw=0.5)
        for suffix in ("svg", "png"):
            figure.savefig(folder / f"{name}.{suffix}", dpi=130)
        plt.close(figure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
