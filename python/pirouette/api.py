"""What `import pirouette` offers of the compiled library."""

import json
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Unpack

import numpy as np

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
