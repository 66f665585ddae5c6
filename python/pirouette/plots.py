"""Plots of `pirouette reproduce`: figures 6 to 10 of [Zhu21] with this project's trials.

    python -m pirouette.plots FOLDER

Reads fig6.json to fig10.json and the traces of FOLDER, whichever are there; writes an SVG and a PNG beside
each.
"""

import argparse
import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from pirouette.plot_parts import (  # noqa: E402
    SIGNALS,
    Style,
    add_legend,
    draw_paths,
    draw_signals,
    on_terrain,
    place,
    relative_signals,
    styles,
    terrains,
    traced,
)
from pirouette.signals import CUTOFF, accelerations  # noqa: E402

TICKS = [0.5, 1, 2, 5, 10, 20, 50, 100]  # mm or mrad, marked on the axis


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
    axes.set_yticks(TICKS, [f"{r:g}" for r in TICKS])
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
    figure, panels = plt.subplots(3, 2, figsize=(10.0, 7.5), sharex=True, layout="constrained")
    title = draw_signals(list(panels.flat), SIGNALS, report, folder, styles(report))
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


def draw_fig9(report: dict, folder: Path) -> plt.Figure:
    """A row of panels for each ground with traces: path, attitude, displacement, velocity."""
    look = styles(report)
    grounds = [t for t in terrains(report) if any(traced(on_terrain(report, t), folder))]
    lines = max(1, len(grounds))
    figure = plt.figure(figsize=(15.0, 6.4 * lines), layout="constrained")
    first: plt.Axes | None = None
    for line, ground in zip(figure.subfigures(lines, 1, squeeze=False).flat, grounds, strict=False):
        left, right = line.subfigures(1, 2, width_ratios=[1, 2])
        path = left.subplots()
        panels = right.subplots(4, 2, sharex=True)
        part = on_terrain(report, ground)
        draw_paths(path, part, folder, look)
        signals = SIGNALS + relative_signals(np.array(part["entries"][0]["ground_normal"]))
        line.suptitle(draw_signals(list(panels.flat), signals, part, folder, look), fontsize=9)
        for axes in panels.flat:
            axes.yaxis.label.set_size(8)
        for axes in panels[-1]:
            axes.set_xlabel("time, s")
        first = first or path
    if first is not None:
        add_legend(figure, first)
    return figure


def tilt_error(entry: dict) -> float:
    """Root mean square angle (rad) of the trunk from the ground's plane, over all seeds."""
    mean = {name: value["mean"] for name, value in entry["metrics"].items()}
    return float(
        np.sqrt(
            sum(
                mean[f"attitude.relative_{angle}_mean"] ** 2
                + mean[f"attitude.relative_{angle}_variance"]
                for angle in ("roll", "pitch")
            )
        )
    )


def draw_fig10(report: dict, folder: Path) -> plt.Figure:
    """Errors over the yaw rate, a column for each ground, a line for each controller."""
    del folder  # no traces
    look = styles(report)
    grounds = terrains(report)
    figure, panels = plt.subplots(
        2,
        len(grounds),
        figsize=(2.6 * len(grounds) + 0.6, 5.4),
        sharex=True,
        sharey="row",
        squeeze=False,
        layout="constrained",
    )
    metric = "com.distance_to_point_mean_mm"
    for (position, attitude), ground in zip(panels.T, grounds, strict=True):
        entries = [e for e in on_terrain(report, ground)["entries"] if metric in e["metrics"]]
        for label in dict.fromkeys(e["label"] for e in entries):
            own = [e for e in entries if e["label"] == label]
            rates = [e["yaw_rate"] for e in own]
            style = {"lw": 1.0, "ms": 4, "label": label} | look[label]
            position.errorbar(
                rates,
                [e["metrics"][metric]["mean"] for e in own],
                [e["metrics"][metric]["deviation"] for e in own],
                capsize=2,
                **style,
            )
            attitude.plot(rates, [1e3 * tilt_error(e) for e in own], **style)
        position.set_title(ground, fontsize=9)
        for axes in (position, attitude):
            axes.set_yscale("log")
            axes.set_yticks(TICKS, [f"{r:g}" for r in TICKS])
            axes.minorticks_off()
        attitude.set_xlabel("yaw rate, rad/s")
    panels[0, 0].set_ylabel("distance to the point, mm")
    panels[1, 0].set_ylabel("trunk from the plane, rms, mrad")
    add_legend(figure, panels[0, 0])
    return figure


FIGURES = {
    "fig6": draw_fig6,
    "fig7": draw_fig7,
    "fig8": draw_fig8,
    "fig9": draw_fig9,
    "fig10": draw_fig10,
}


def without_formulas(report: dict) -> dict:
    """The report with labels of which no dollar sign begins a formula."""
    for entry in report["entries"]:
        for name in ("label", "paper"):
            entry[name] = entry[name].replace("$", r"\$")
    return report


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
        report = without_formulas(json.loads((folder / f"{name}.json").read_text()))
        figure = FIGURES[name](report, folder)
        for axes in figure.axes:
            axes.grid(alpha=0.25, lw=0.5)
        for suffix in ("svg", "png"):
            figure.savefig(folder / f"{name}.{suffix}", dpi=130)
        plt.close(figure)
    return 0


if __name__ == "__main__":
    sys.exit(main())
