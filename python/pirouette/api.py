"""What `import pirouette` offers of the compiled library."""

import json
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from pirouette import _core
from pirouette._core import (
    BaseTruth,
    ControllerStatus,
    JointCommand,
    MotionCommand,
    PositionAid,
    SensorReading,
)
from pirouette.configuration import ConfigLike, Options, as_dict, resolve
from pirouette.errors import Error

__all__ = [
    "BaseTruth",
    "Controller",
    "ControllerStatus",
    "JointCommand",
    "MotionCommand",
    "PositionAid",
    "Result",
    "SensorReading",
    "Simulation",
    "metrics",
    "robot_check",
    "robots",
    "run",
]


@dataclass(frozen=True)
class Result:
    """One simulated run."""

    config: dict[str, Any] = field(repr=False)
    """Every parameter, as in run.toml."""
    metrics: dict[str, Any]
    """As metrics.json; `pirouette config metrics` lists its keys with their units. None stands for
    what the run cannot tell."""
    trace: np.ndarray = field(repr=False)
    """As trace.npy: a structured array, one row for each 1 / run.trace_rate s; `pirouette config
    trace` lists its fields with their units."""

    @property
    def fell(self) -> bool:
        """The robot fell, or its controller gave up for a second."""
        return self.metrics["fell"]


def robots() -> list[str]:
    """Names of the robots in the box."""
    return _core.known_robots()


def robot_check(robot: str | Path) -> dict[str, Any]:
    """What was found, mended and assumed of a robot: the name of one in the box, or an MJCF, URDF or
    robot.toml file. Lengths in m, angles in rad, torques in N m; lists hold abad, hip, knee;
    points_B are the abad axis, hip, knee and foot of the standing robot in trunk axes, axes_B the
    joints' axes. `problems` says why it cannot walk. Raises Error for a file that cannot be read."""
    return json.loads(_core.robot_check(str(robot)))


def run(config: ConfigLike = None, **options: Unpack[Options]) -> Result:
    """Simulates one run, as `pirouette spin` or, with radius, speed or path, `pirouette turn` does.

        result = pirouette.run(terrain="slope:10", rate=0.7, turns=2, set={"gait.duty": 0.6})
        result.metrics["com"]["radius_mean_mm"], result.trace["true_com_position"]

    The interpreter is free meanwhile: runs in several threads use several cores. The same
    configuration gives the same trace. Raises Error for a configuration that is not allowed.
    """
    resolved = resolve(config, options)
    with tempfile.TemporaryDirectory(prefix="pirouette-") as folder:
        file = Path(folder) / "trace.npy"
        metrics = _core.run_trial(resolved, str(file))
        trace = np.load(file)
    return Result(as_dict(resolved), json.loads(metrics), trace)


def metrics(
    time: ArrayLike,
    com: ArrayLike,
    yaw: ArrayLike,
    *,
    yaw_rate: float,
    point: ArrayLike | None = None,
    velocity: ArrayLike = (0.0, 0.0),
    roll: ArrayLike | None = None,
    pitch: ArrayLike | None = None,
) -> dict[str, Any]:
    """How well a robot turned, in any simulator and under any controller, by the definitions of
    metrics.json.

    time: s, shape (n,), evenly spaced, n >= 2; com: m, shape (n, 2) or (n, 3), the true centre of
    mass in the world; yaw, roll, pitch: rad, shape (n,), true, yaw wrapped or not. What was
    commanded: yaw_rate in rad/s; velocity in m/s, heading axes; point in m, absent: where com
    begins. Give the part to be measured only, without standing and settling. The keys are those of
    `pirouette config metrics` that this motion can tell. Raises Error for other shapes,
    values that are not finite and times that are not evenly spaced.
    """
    seconds = np.asarray(time, dtype=float)
    place = np.asarray(com, dtype=float)
    if seconds.ndim != 1 or len(seconds) < 2:
        raise Error(f"time: given shape {seconds.shape}; allowed: (n,) with n of 2 and more")
    steps = np.diff(seconds)
    if not (np.all(steps > 0.0) and np.allclose(steps, steps.mean(), rtol=1e-3)):
        raise Error("time: the steps differ; allowed: evenly spaced, increasing times")
    if place.ndim != 2 or place.shape[0] != len(seconds) or place.shape[1] not in (2, 3):
        raise Error(f"com: given shape {place.shape}; allowed: ({len(seconds)}, 2) or (..., 3)")
    given = {"com": place[:, :2], "yaw": yaw, "yaw_rate": yaw_rate, "velocity": velocity}
    given |= {"point": point, "roll": roll, "pitch": pitch}
    for name, values in given.items():
        if values is not None and not np.all(np.isfinite(np.asarray(values, dtype=float))):
            raise Error(f"{name}: holds values that are no number; allowed: finite ones")
    place = np.ascontiguousarray(place[:, :2])
    text = _core.metrics(
        1.0 / steps.mean(),
        seconds,
        place,
        np.gradient(place, seconds, axis=0),
        np.unwrap(np.asarray(yaw, dtype=float)),
        roll,
        pitch,
        place[0] if point is None else point,
        velocity,
        yaw_rate,
    )
    known = _drop_absent(json.loads(text))
    for key in ("context", "timing", "fell", "interrupted"):  # of a run of ours
        known.pop(key, None)
    return known


def _drop_absent(values: dict[str, Any]) -> dict[str, Any]:
    """Without the entries that are None and the groups that are empty then."""
    inner = {k: _drop_absent(v) if isinstance(v, dict) else v for k, v in values.items()}
    return {key: value for key, value in inner.items() if value is not None and value != {}}


class Controller(_core.Controller):
    """The controller, for a loop of your own: tick() takes a SensorReading and a MotionCommand and
    returns a JointCommand. Arguments as of run()."""

    def __init__(self, config: ConfigLike = None, **options: Unpack[Options]) -> None:
        resolved = resolve(config, options)
        super().__init__(resolved)
        self.config = as_dict(resolved)
        self.period: float = 1.0 / self.config["control"]["rate"]
        """s, between two ticks"""


class Simulation(_core.Simulation):
    """The simulated robot and its controller, tick by tick. Arguments as of run()."""

    def __init__(self, config: ConfigLike = None, **options: Unpack[Options]) -> None:
        resolved = resolve(config, options)
        super().__init__(resolved)
        self.config = as_dict(resolved)
        self.period: float = 1.0 / self.config["control"]["rate"]
        """s, of one tick"""
