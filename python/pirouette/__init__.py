"""Quadrupeds that spin accurately: the library, and pictures of its runs.

run(), Controller and Simulation need the compiled part of the package; reports and exports do not.
"""

import os
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pirouette.errors import NOT_BUILT, Error

if TYPE_CHECKING:
    from pirouette.api import (
        BaseTruth,
        Controller,
        ControllerStatus,
        JointCommand,
        MotionCommand,
        PositionAid,
        Result,
        SensorReading,
        Simulation,
        metrics,
        robot_check,
        robots,
        run,
    )

__version__ = "0.1.0"
__all__ = [
    "BaseTruth",
    "Controller",
    "ControllerStatus",
    "Error",
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

_HERE = Path(__file__).resolve().parent
_BUILT = _HERE.parents[1] / "build/release/python"  # by `make python`, in the source tree
if _BUILT.is_dir():
    __path__.append(str(_BUILT))
if (_HERE / "data").is_dir():  # robots/ and config/ of an installed package
    os.environ.setdefault("PIROUETTE_DATA_DIR", str(_HERE / "data"))


def __getattr__(name: str) -> Any:
    """Loads the compiled library with the first name that needs it."""
    if name not in __all__:
        raise AttributeError(f"module 'pirouette' has no attribute {name!r}")
    try:
        api = import_module("pirouette.api")
    except ModuleNotFoundError as error:
        if error.name != "pirouette._core":
            raise
        raise ImportError(NOT_BUILT) from None
    return getattr(api, name)


def __dir__() -> list[str]:
    return sorted(__all__)
