"""A run folder in memory."""

import json
import math
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from pirouette import __version__
from pirouette.errors import Error
from pirouette.ground import Ground

FILES = ("run.toml", "metrics.json", "trace.npy", "terrain.npy")
LEGS = ("FR", "FL", "RR", "RL")  # order of every per-leg column of the trace
SHORTEST_RECORD = 1.0  # s
LEAST_COLUMNS = {  # of the trace, with the shape of a row's value
    "time": (),
    "path_position": (2,),
    "true_base_position": (3,),
    "true_base_velocity": (3,),
    "true_rpy": (3,),
    "true_angular_velocity_B": (3,),
    "true_com_position": (3,),
    "true_com_velocity": (3,),
    "true_joint_position": (4, 3),
}
NUMBERS_OF_CONTEXT = ("point_x", "point_y", "velocity_x", "velocity_y", "terrain_half_extent_m")
TEXTS_OF_CONTEXT = ("path", "terrain", "robot", "controller")
# What NumPy raises about a damaged file; the last ones about numbers in its head.
NUMPY_ERRORS = (ValueError, EOFError, OSError, MemoryError, OverflowError, TypeError, SyntaxError)


class RunError(Error):
    """A folder that cannot be read; the text names the file and what is wrong with it."""


@dataclass(frozen=True)
class Run:
    """One simulated trial. Rows of `trace` are as `pirouette config trace` lists them."""

    folder: Path
    config: dict  # run.toml
    metrics: dict  # metrics.json
    trace: np.ndarray  # structured, one row a sample
    ground: Ground

    @property
    def name(self) -> str:
        return self.folder.name

    @property
    def context(self) -> dict:
        return self.metrics["context"]

    @property
    def record_start(self) -> float:
        """Time (s) of the first sample that the metrics count."""
        run = self.config["run"]
        settling = 0.0 if run.get("angle_deg") else run["settle_time"]
        start = self.config["gait"]["stand_time"] + settling
        first, last = self.trace["time"][[0, -1]]
        return float(start if start < last - SHORTEST_RECORD else first)

    @property
    def record(self) -> np.ndarray:
        """The rows that the metrics count; all of them if the robot fell before."""
        return self.trace[self.trace["time"] >= self.record_start]

    @property
    def point(self) -> np.ndarray:
        """Commanded point in the world, m, shape (2,)."""
        return np.array([self.context.get(key) or 0.0 for key in ("point_x", "point_y")])

    @property
    def spins(self) -> bool:
        """Whether it is to stay at the point, rather than to walk along a path."""
        return not any(self.context.get(key) for key in ("velocity_x", "velocity_y", "path"))

    def has(self, *columns: str) -> bool:
        return all(column in self.trace.dtype.names for column in columns)


def load(folder: Path) -> Run:
    """Reads and checks a run folder. Raises RunError."""
    if not folder.is_dir():
        raise RunError(f"{folder}: is no folder; give the folder of a run")
    missing = [name for name in FILES if not (folder / name).is_file()]
    if missing:
        raise RunError(f"{folder}: is no run folder, {' and '.join(missing)} missing")
    metrics = load_metrics(folder / "metrics.json")
    config = load_config(folder / "run.toml")
    trace = load_trace(folder / "trace.npy")
    return Run(folder.resolve(), config, metrics, trace, load_ground(folder, metrics["context"]))


def load_metrics(file: Path) -> dict:
    try:
        metrics = json.loads(file.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise RunError(f"{file}: is no JSON: {error}") from None
    context = metrics.get("context") if isinstance(metrics, dict) else None
    if not isinstance(context, dict) or "version" not in context:
        raise RunError(f"{file}: context.version is missing; a run's metrics.json has it")
    check_version(file, str(context["version"]))
    check_values(file, metrics, "")
    for key in NUMBERS_OF_CONTEXT:
        if isinstance(context.get(key), str | bool):
            raise RunError(f"{file}: context.{key} is {context[key]!r}; expected a number")
    for key in TEXTS_OF_CONTEXT:
        if not isinstance(context.get(key, ""), str):
            raise RunError(f"{file}: context.{key} is {context[key]!r}; expected a text")
    return metrics


def check_values(file: Path, table: dict, prefix: str) -> None:
    """Refuses what no entry of metrics.json is: lists, and tables within tables of it."""
    for key, value in table.items():
        if isinstance(value, dict) and not prefix:
            check_values(file, value, f"{key}.")
        elif not isinstance(value, str | bool | int | float | None):
            raise RunError(f"{file}: {prefix}{key} is {value!r}; expected a number or a text")


def check_version(file: Path, version: str) -> None:
    """Refuses what a newer program has written: keys may mean something else there."""

    def release(text: str) -> tuple[int, ...]:
        return tuple(int(number) for number in text.split(".")[:2])

    try:
        newer = release(version) > release(__version__)
    except ValueError:
        raise RunError(f"{file}: context.version is {version!r}; expected e.g. 0.1.0") from None
    if newer:
        raise RunError(
            f"{file}: context.version is {version}, newer than this program, {__version__}; "
            "update the Python package pirouette"
        )


def load_config(file: Path) -> dict:
    try:
        config = tomllib.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise RunError(f"{file}: is no TOML: {error}") from None
    for section, key in (("gait", "stand_time"), ("run", "settle_time")):
        table = config.get(section)
        value = table.get(key) if isinstance(table, dict) else None
        if value is None:
            raise RunError(f"{file}: {section}.{key} is missing")
        if (
            isinstance(value, bool)
            or not isinstance(value, int | float)
            or not 0 <= value < math.inf
        ):
            raise RunError(f"{file}: {section}.{key} is {value!r}; expected a time in s")
    if not isinstance(config.get("robot"), str):
        raise RunError(f"{file}: robot is missing, or no text")
    return config


def load_trace(file: Path) -> np.ndarray:
    try:
        trace = np.load(file, allow_pickle=False)
    except NUMPY_ERRORS as error:
        raise RunError(f"{file}: is cut or no NumPy file: {error}") from None
    missing = [n for n in LEAST_COLUMNS if n not in (trace.dtype.names or ())]
    if missing:
        raise RunError(f"{file}: columns missing: {', '.join(missing)}")
    if trace.ndim != 1 or len(trace) < 2:
        raise RunError(f"{file}: has shape {trace.shape}; a run has one axis of two rows or more")
    for name, shape in LEAST_COLUMNS.items():
        column = trace[name]
        if column.shape[1:] != shape or column.dtype.kind != "f":
            raise RunError(
                f"{file}: column {name} has rows of shape {column.shape[1:]}, {column.dtype}; "
                f"expected {shape} of floating-point numbers"
            )
    if not (np.isfinite(trace["time"]).all() and (np.diff(trace["time"]) > 0).all()):
        raise RunError(f"{file}: column time does not rise from row to row")
    return trace


def load_ground(folder: Path, context: dict) -> Ground:
    """The heights that the simulator wrote."""
    file = folder / "terrain.npy"
    try:
        heights = np.load(file, allow_pickle=False)
    except NUMPY_ERRORS as error:
        raise RunError(f"{file}: is cut or no NumPy file: {error}") from None
    extent = context.get("terrain_half_extent_m")
    if heights.ndim != 2 or min(heights.shape) < 2 or not extent or not 0 < extent < math.inf:
        raise RunError(
            f"{file}: has shape {heights.shape} and context.terrain_half_extent_m of metrics.json "
            f"is {extent}; expected two axes and a length in m"
        )
    if heights.dtype.kind != "f" or not np.isfinite(heights).all():
        raise RunError(f"{file}: holds {heights.dtype}, or heights that are no number")
    terrain = context.get("terrain", "flat")
    try:
        return Ground.square(heights, float(extent), terrain)
    except ValueError:
        raise RunError(
            f"{folder / 'metrics.json'}: context.terrain is {terrain!r}; expected as of --terrain"
        ) from None


def add_to_record(folder: Path, name: str) -> None:
    """Lists the file `name` among those of the run that a later run with --force may replace."""
    record = folder / "files.txt"
    try:
        names = record.read_text(encoding="utf-8").splitlines()
        if name not in names:
            record.write_text("\n".join([*names, name, ""]), encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return  # a folder without a record, or that is only read: nothing replaces its files
