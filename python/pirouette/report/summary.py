"""The tables of a report: what was measured beside what the paper prints, and the settings."""

from html import escape

from pirouette.report.paper import PRINTED
from pirouette.run_folder import Run

MEASURED = {
    "turns_done": ("turns", ""),
    "yaw_rate_mean": ("yaw rate", "rad/s"),
    "yaw_rate_error": ("yaw rate error, share", ""),
    "com.distance_to_point_mean_mm": ("distance to point, mean", "mm"),
    "com.distance_to_point_max_mm": ("distance to point, largest", "mm"),
    "path.cross_track_mean_mm": ("cross-track error, mean", "mm"),
    "path.cross_track_max_mm": ("cross-track error, largest", "mm"),
    "path.along_track_mean_mm": ("along-track error, mean", "mm"),
    "com.radius_mean_mm": ("radius", "mm"),
    "com.radius_variance_mm2": ("radius, variance", "mm²"),
    "com.peak_to_peak_x_mm": ("range of x in 10 s", "mm"),
    "com.peak_to_peak_y_mm": ("range of y in 10 s", "mm"),
    "com.drift_per_turn_mm": ("drift per turn", "mm"),
    "com.body_bias_mm_s": ("body-frame bias", "mm/s"),
    "attitude.roll_mean": ("roll, mean", "rad"),
    "attitude.roll_variance": ("roll, variance", "rad²"),
    "attitude.pitch_mean": ("pitch, mean", "rad"),
    "attitude.pitch_variance": ("pitch, variance", "rad²"),
    "acceleration.x_variance": ("acceleration x, variance", "(m/s²)²"),
    "acceleration.y_variance": ("acceleration y, variance", "(m/s²)²"),
    "acceleration.roll_variance": ("acceleration roll, variance", "(rad/s²)²"),
    "acceleration.pitch_variance": ("acceleration pitch, variance", "(rad/s²)²"),
    "contact.dropped_flags": ("feet whose contact flag is not believed", ""),
    "estimator.position_error_mm": ("estimator error", "mm"),
    "estimator.yaw_error_rad": ("estimator error, yaw", "rad"),
}
DONE_SHARE = 0.98  # of what was commanded, at least: kDoneShare of trial/trial.hpp
SETTINGS = {
    "robot": "robot",
    "terrain": "terrain",
    "friction": "friction",
    "torsional_friction": "torsional friction, m",
    "profile": "plant",
    "controller": "controller",
    "foot_model": "foot model",
    "com_planner": "CoM planner",
    "reference": "reference",
    "tracker": "tracker",
    "estimator": "estimator",
    "sensors": "sensors",
    "period": "gait period, s",
    "duty": "gait duty",
    "yaw_rate": "commanded yaw rate, rad/s",
    "path": "path",
    "seed": "seed",
    "duration_s": "simulated time, s",
    "version": "version",
    "commit": "commit",
    "mujoco": "MuJoCo",
}


def at(tree: dict, key: str) -> object:
    """The value under a dotted key; None where there is none."""
    for part in key.split("."):
        tree = tree.get(part) if isinstance(tree, dict) else None
    return tree


def shown(value: object) -> str:
    if value is None or value == "":
        return "–"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def table(head: list[str], rows: list[list[str]]) -> str:
    """An HTML table; the first column names the rows."""
    cells = "".join(f"<th scope=col>{escape(text)}</th>" for text in head)
    lines = [
        f"<tr><th scope=row>{escape(row[0])}</th>"
        + "".join(f"<td>{escape(text)}</td>" for text in row[1:])
        + "</tr>"
        for row in rows
    ]
    return f"<table><thead><tr>{cells}</tr></thead><tbody>{''.join(lines)}</tbody></table>"


def measured(runs: list[Run]) -> str:
    """Every run's numbers, and the paper's where they belong beside it: to spins."""
    printed = PRINTED if any(run.spins for run in runs) else {}
    head = ["", *(run.name for run in runs), *(f"paper: {name}" for name in printed)]
    rows = []
    for key, (name, unit) in MEASURED.items():
        values = [at(run.metrics, key) for run in runs]
        if all(value is None for value in values):
            continue
        columns = values + [column.get(key) for column in printed.values()]
        rows.append([f"{name}, {unit}" if unit else name, *map(shown, columns)])
    return table(head, rows)


def settings(runs: list[Run]) -> str:
    rows = [
        [name, *(shown(run.context.get(key)) for run in runs)]
        for key, name in SETTINGS.items()
        if any(run.context.get(key) not in (None, "") for run in runs)
    ]
    return table(["", *(run.name for run in runs)], rows)


def differences(runs: list[Run]) -> str:
    """The keys of run.toml in which the runs differ; empty for one run."""
    flat = [flattened(run.config) for run in runs]
    keys = list(dict.fromkeys(key for config in flat for key in config))
    rows = [
        [key, *(shown(config.get(key)) for config in flat)]
        for key in keys
        if any(config.get(key) != flat[0].get(key) for config in flat)
    ]
    return table(["", *(run.name for run in runs)], rows) if rows else ""


def flattened(tree: dict, prefix: str = "") -> dict[str, object]:
    flat = {}
    for key, value in tree.items():
        if isinstance(value, dict):
            flat |= flattened(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat


def headlines(runs: list[Run]) -> str:
    """A sentence about each run; falls must not be overlooked."""
    return "".join(
        f'<p class="{"notice" if is_incomplete(run) else "headline"}">'
        f"{escape(f'{run.name}: {headline(run)}')}</p>"
        for run in runs
    )


def is_incomplete(run: Run) -> bool:
    """Whether it did less than it was told."""
    return bool(run.metrics.get("fell") or run.metrics.get("interrupted") or shortfall(run))


def shortfall(run: Run) -> str:
    """What a run that did not fall did less than it was told; empty: nothing."""
    if run.metrics.get("interrupted"):
        return "interrupted; the numbers are of the part until then. "
    done = run.metrics.get("done")
    if isinstance(done, float) and done < DONE_SHARE:
        return f"{rounded(100.0 * done)} % of what was commanded was done. "
    return ""


def headline(run: Run) -> str:
    """What the robot did, in words."""
    return shortfall(run) + motion(run)


def motion(run: Run) -> str:
    metrics, context = run.metrics, run.context
    where = f"on {context.get('terrain', 'flat')}, controller {context.get('controller')}"
    if metrics.get("fell"):
        return f"the robot fell after {rounded(metrics.get('fall_time_s'))} s {where}."
    turns, rate = rounded(metrics.get("turns_done")), rounded(metrics.get("yaw_rate_mean"))
    if run.spins:
        distance = rounded(at(metrics, "com.distance_to_point_mean_mm"))
        return (
            f"{turns} turns at {rate} rad/s {where}; the centre of mass was {distance} mm from the "
            "commanded point on the average."
        )
    beside = at(metrics, "path.cross_track_mean_mm")
    way = "" if beside is None else f"; {rounded(beside)} mm beside its path on the average"
    return f"walked {where}{way}."


def rounded(value: object) -> str:
    return f"{value:.3g}" if isinstance(value, float) else shown(value)
