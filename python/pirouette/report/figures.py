"""The interactive figures of a report, for one run or several over each other."""

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from pirouette import style
from pirouette.report.paper import PRINTED_RADII
from pirouette.run_folder import LEGS, Run
from pirouette.signals import MM, TURN, accelerations, in_heading, turn_average

MOST_POINTS = 10_000  # of a line; longer ones are thinned
STRIDES_SHOWN = 10.0  # s, of the contact figures
FIRST_VIEW = 2.0  # s, of it that is seen at first


def all_figures(runs: list[Run]) -> list[tuple[str, str, go.Figure]]:
    """Title, caption and figure, in the order of the report."""
    figures = [
        (
            "Path of the centre of mass",
            "Relative to the commanded point, simulator's truth. Thick: circle fit. "
            "Click the paper's circles in the legend to compare.",
            path_figure(runs),
        ),
        (
            "Over time",
            "Dotted line: start of the record that the numbers count. Drift is the way of the "
            "one-turn moving average since its first value; velocities are in axes that turn "
            "with the robot.",
            time_figure(runs),
        ),
        (
            "Accelerations of the trunk",
            "As figure 8 of the paper: linear in world axes, angular in the body's, 20 Hz low-pass.",
            acceleration_figure(runs),
        ),
    ]
    figures += [
        (
            f"Contacts, {run.name}",
            "Bars: scheduled stance (pale) and true contact (line). Forces are vertical; slip is "
            "the speed of the foot's material point at the ground. Drag or zoom to see more.",
            contact_figure(run),
        )
        for run in runs
        if run.has("stance", "true_contact", "true_foot_force", "force_wbc", "true_foot_slip")
    ]
    if all(run.has("base_position", "base_velocity", "base_rpy") for run in runs):
        figures.append(
            (
                "Estimator error",
                "Where the robot believed to be, less where it was.",
                estimator_figure(runs),
            )
        )
    if all(run.metrics.get("timing") for run in runs):
        figures.append(
            (
                "Wall-clock times",
                "Of one run on one machine; not reproducible.",
                timing_figure(runs),
            )
        )
    return figures


def line(x: np.ndarray, y: np.ndarray, **options) -> go.Scatter:
    """A thinned line in single precision."""
    step = max(1, -(-len(x) // MOST_POINTS))
    return go.Scatter(
        x=x[::step].astype(np.float32), y=y[::step].astype(np.float32), mode="lines", **options
    )


def of_run(i: int, run: Run, first: bool = True) -> dict:
    """How every line of run number i looks."""
    return {
        "name": run.name,
        "legendgroup": str(i),
        "showlegend": first,
        "line": {"color": style.colour(i), "dash": style.dash(i), "width": 1.3},
    }


def circle(
    radius: float, centre: tuple[float, float] = (0.0, 0.0)
) -> tuple[np.ndarray, np.ndarray]:
    angle = np.linspace(0.0, TURN, 121)
    return centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle)


def path_figure(runs: list[Run]) -> go.Figure:
    figure = go.Figure()
    for i, run in enumerate(runs):
        com = MM * (run.record["true_com_position"][:, :2] - run.point)
        look = of_run(i, run)
        look["line"]["width"] = 0.8
        figure.add_trace(line(com[:, 0], com[:, 1], opacity=0.8, **look))
        if not run.spins and run.has("path_position"):
            path = MM * (run.record["path_position"] - run.point)
            figure.add_trace(
                line(
                    path[:, 0],
                    path[:, 1],
                    name=f"{run.name}: reference",
                    line={"color": style.NEUTRAL, "dash": "dash", "width": 1},
                )
            )
        com_metrics = run.metrics.get("com", {})
        radius = com_metrics.get("circle_radius_mm")
        if run.spins and radius is not None:
            centre = (com_metrics["circle_centre_x_mm"], com_metrics["circle_centre_y_mm"])
            figure.add_trace(
                line(
                    *circle(radius, centre),
                    name=f"{run.name}: circle, {radius:.3g} mm",
                    line={"color": style.colour(i), "dash": style.dash(i + 2), "width": 4},
                )
            )
    figure.add_trace(
        go.Scatter(
            x=[0.0],
            y=[0.0],
            mode="markers",
            name="commanded point",
            marker={
                "symbol": "cross-thin",
                "size": 16,
                "line": {"width": 3, "color": style.NEUTRAL},
            },
        )
    )
    for i, (name, radius) in enumerate(PRINTED_RADII.items()):
        figure.add_trace(
            line(
                *circle(radius),
                name=f"paper, {name}: {radius:g} mm",
                visible="legendonly",
                line={"color": style.NEUTRAL, "dash": style.dash(i + 1), "width": 1.5},
            )
        )
    figure.update_xaxes(title_text="x, mm")
    figure.update_yaxes(title_text="y, mm", scaleanchor="x", scaleratio=1)
    figure.update_layout(height=620)
    return figure


def stacked(labels: list[str], height: int) -> go.Figure:
    """Empty panels over each other with one time axis."""
    figure = make_subplots(rows=len(labels), cols=1, shared_xaxes=True, vertical_spacing=0.025)
    for row, label in enumerate(labels, start=1):
        figure.update_yaxes(title_text=label, row=row, col=1)
    figure.update_xaxes(title_text="time, s", row=len(labels), col=1)
    figure.update_layout(height=height * len(labels) + 60, hovermode="x")
    return figure


def add_rows(
    figure: go.Figure, i: int, run: Run, lines: list[tuple[np.ndarray, np.ndarray]]
) -> None:
    for row, (time, signal) in enumerate(lines, start=1):
        if len(time):
            figure.add_trace(line(time, signal, **of_run(i, run, row == 1)), row=row, col=1)


def time_figure(runs: list[Run]) -> go.Figure:
    spins = all(run.spins for run in runs)
    figure = stacked(
        [
            f"distance to<br>{'point' if spins else 'reference'}, mm",
            "drift, mm",
            "velocity<br>ahead, mm/s",
            "velocity<br>left, mm/s",
            "roll, mrad",
            "pitch, mrad",
            "yaw rate, rad/s",
        ],
        120,
    )
    for i, run in enumerate(runs):
        rows = run.trace
        time, com, rpy = rows["time"], rows["true_com_position"][:, :2], rows["true_rpy"]
        away = com - (run.point if run.spins else rows["path_position"])
        average_time, average = turn_average(run.record, run.record["true_com_position"][:, :2])
        drift = np.linalg.norm(average - average[:1], axis=1)
        velocity = MM * in_heading(rows["true_com_velocity"][:, :2], rpy[:, 2])
        add_rows(
            figure,
            i,
            run,
            [
                (time, MM * np.linalg.norm(away, axis=1)),
                (average_time, MM * drift),
                (time, velocity[:, 0]),
                (time, velocity[:, 1]),
                (time, 1e3 * rpy[:, 0]),
                (time, 1e3 * rpy[:, 1]),
                (time, np.gradient(rpy[:, 2], time)),
            ],
        )
        figure.add_vline(run.record_start, line={"color": style.NEUTRAL, "dash": "dot", "width": 1})
    return figure


def acceleration_figure(runs: list[Run]) -> go.Figure:
    """Linear on the left, angular on the right; a row for each run: over each other they hide."""
    figure = make_subplots(
        rows=len(runs),
        cols=2,
        shared_xaxes="columns",
        shared_yaxes="columns",
        vertical_spacing=0.06 / len(runs),
        horizontal_spacing=0.1,
        row_titles=[run.name for run in runs] if len(runs) > 1 else None,
    )
    for i, run in enumerate(runs):
        for column, x in enumerate(accelerations(run.record), start=1):
            look = of_run(i, run, False)
            look["line"] = {"color": style.colour(i), "width": 0.6}
            figure.add_trace(line(x[:, 0], x[:, 1], opacity=0.8, **look), row=i + 1, col=column)
        figure.update_yaxes(title_text="y, m/s²", row=i + 1, col=1)
        figure.update_yaxes(title_text="pitch, rad/s²", row=i + 1, col=2)
    figure.update_xaxes(title_text="x, m/s²", row=len(runs), col=1)
    figure.update_xaxes(title_text="roll, rad/s²", row=len(runs), col=2)
    figure.update_layout(height=60 + 360 * len(runs))
    return figure


def contact_figure(run: Run) -> go.Figure:
    """Gait diagram, forces and slip in the first strides of the record."""
    record = run.record
    rows = record[record["time"] <= record["time"][0] + STRIDES_SHOWN]
    time = rows["time"]
    figure = stacked(["gait", "true force, N", "planned force, N", "slip, mm/s"], 150)
    slip = MM * np.linalg.norm(rows["true_foot_slip"], axis=2)
    for leg, name in enumerate(LEGS):
        look = {"name": name, "legendgroup": name}
        colour, dash = style.colour(leg), style.dash(leg)
        for bars, width, opacity in (("stance", 16, 0.25), ("true_contact", 4, 1.0)):
            figure.add_trace(
                line(
                    time,
                    np.where(rows[bars][:, leg], -float(leg), np.nan),
                    line={"color": colour, "width": width},
                    opacity=opacity,
                    hovertemplate=f"{name} {'scheduled' if bars == 'stance' else 'touches'}",
                    showlegend=False,
                    **look,
                ),
                row=1,
                col=1,
            )
        signals = (
            rows["true_foot_force"][:, leg, 2],
            rows["force_wbc"][:, leg, 2],
            np.where(rows["true_contact"][:, leg], slip[:, leg], np.nan),
        )
        for row, signal in enumerate(signals, start=2):
            figure.add_trace(
                line(
                    time,
                    signal,
                    line={"color": colour, "dash": dash, "width": 1.3},
                    showlegend=row == 2,
                    **look,
                ),
                row=row,
                col=1,
            )
    figure.update_yaxes(
        tickvals=[-leg for leg in range(len(LEGS))], ticktext=LEGS, range=[-3.6, 0.6], row=1, col=1
    )
    start = float(time[0])
    figure.update_xaxes(range=[start, start + FIRST_VIEW])
    figure.update_layout(dragmode="pan")
    return figure


def estimator_figure(runs: list[Run]) -> go.Figure:
    figure = stacked(
        ["horizontal<br>position, mm", "height, mm", "horizontal<br>velocity, mm/s", "yaw, mrad"],
        130,
    )
    for i, run in enumerate(runs):
        rows = run.trace
        position = rows["base_position"] - rows["true_base_position"]
        velocity = rows["base_velocity"] - rows["true_base_velocity"]
        yaw = rows["base_rpy"][:, 2] - rows["true_rpy"][:, 2]
        time = rows["time"]
        add_rows(
            figure,
            i,
            run,
            [
                (time, MM * np.linalg.norm(position[:, :2], axis=1)),
                (time, MM * position[:, 2]),
                (time, MM * np.linalg.norm(velocity[:, :2], axis=1)),
                (time, 1e3 * yaw),
            ],
        )
    return figure


def timing_figure(runs: list[Run]) -> go.Figure:
    bars = {
        "tick_us_median": "tick, median",
        "tick_us_p99": "tick, 99 %",
        "tick_us_max": "tick, largest",
        "mpc_us_median": "MPC, median",
        "wbc_us_median": "whole-body, median",
        "physics_step_us_median": "physics step, median",
    }
    figure = go.Figure()
    for i, run in enumerate(runs):
        timing = run.metrics["timing"]
        figure.add_trace(
            go.Bar(
                name=run.name,
                x=list(bars.values()),
                y=[timing.get(key) for key in bars],
                marker={
                    "color": style.colour(i),
                    "pattern": {"shape": style.PATTERNS[i % len(style.PATTERNS)]},
                },
                texttemplate="%{y:.3~r}",
                textposition="outside",
                cliponaxis=False,
            )
        )
    figure.update_yaxes(type="log", title_text="time, µs")
    figure.update_layout(height=380, barmode="group")
    return figure
