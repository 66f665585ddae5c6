"""From Python values to a checked configuration of the compiled library."""

import json
import math
import os
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypedDict

from pirouette import _core
from pirouette.errors import Error

ConfigLike = Mapping[str, Any] | str | os.PathLike | None
"""Parameters by name, nested ({"gait": {"duty": 0.6}}) or dotted ({"gait.duty": 0.6}); or the path
of a TOML file, such as the run.toml of a run; or None: the defaults."""


class Options(TypedDict, total=False):
    """The options of `pirouette spin` and `turn`, as keywords."""

    robot: str  # folder under robots/, or an MJCF file
    controller: str  # mit, fkm, asc or pirouette
    profile: str  # of the plant: nominal or realistic
    rate: float  # rad/s, positive turns left
    turns: float  # to record after settling
    angle: float  # deg, to turn by, positive to the left; instead of turns
    terrain: str  # flat, slope:10, stairs:0.03x0.20, ...
    estimator: str  # kalman or truth
    sensors: str  # noisy or ideal
    seed: int  # of noise, biases and terrain
    point: tuple[float, float]  # m, commanded point in the world
    start_offset: tuple[float, float]  # m, where the robot starts
    start_yaw_deg: float  # deg, at which it starts
    radius: float  # m, signed, of a circle
    speed: float  # m/s, along run.path, a circle (with rate) or a straight line
    heading_offset_deg: float  # deg, direction of travel from the robot's front
    path: str  # name under experiments/paths/, or a TOML file
    laps: float  # of a closed path
    set: Mapping[str, Any]  # any parameter by its dotted name


KEYS = {
    "rate": "run.rate",
    "turns": "run.turns",
    "angle": "run.angle_deg",
    "terrain": "plant.terrain",
    "estimator": "estimation.source",
    "seed": "run.seed",
    "point": "run.point",
    "start_offset": "run.start_offset",
    "start_yaw_deg": "run.start_yaw_deg",
    "path": "run.path",
    "laps": "run.laps",
}
SOURCES = ("robot", "controller", "profile")
DIGITS = 12  # of a velocity: a cosine of 90 degrees is to be 0


def resolve(config: ConfigLike, options: Mapping[str, Any]) -> _core.Config:
    """The defaults, then `config`, then the options, then their `set`. Raises Error."""
    unknown = sorted(options.keys() - Options.__annotations__.keys())
    if unknown:
        allowed = ", ".join(Options.__annotations__)
        raise Error(f"{', '.join(unknown)}: unknown option; allowed: {allowed}")
    given = {} if config is None or isinstance(config, (str, os.PathLike)) else flattened(config)
    file = str(Path(config)) if isinstance(config, (str, os.PathLike)) else None
    given |= {KEYS[name]: value for name, value in options.items() if name in KEYS}
    if "point" in options:
        given["run.fixed_point"] = True
    if "sensors" in options:
        given["plant.sensors.ideal"] = sensors_are_ideal(options["sensors"])
    last = flattened(options.get("set", {}))

    def load(more: Mapping[str, Any]) -> _core.Config:
        texts = [f"{key}={toml(key, value)}" for key, value in (given | last | more).items()]
        sources = {name: str(options[name]) for name in SOURCES if name in options}
        return _core.load_config(**sources, file=file, overrides=texts)

    loaded = load({})
    if "radius" in options or "speed" in options:
        loaded = load(travel(as_dict(loaded)["run"], options))
    return loaded


def as_dict(config: _core.Config) -> dict[str, Any]:
    """Every parameter, nested as in run.toml."""
    return tomllib.loads(config.toml)


def travel(run: Mapping[str, Any], options: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters of the motion that radius, speed and heading_offset_deg mean."""
    if "radius" in options and "speed" in options:
        raise Error("speed: given with radius; allowed: one of them")
    if "radius" not in options and run["path"]:
        return {"run.path_speed": options["speed"]}
    rate = run["rate"] if "radius" in options or "rate" in options else 0.0
    try:
        speed = options["radius"] * rate if "radius" in options else options["speed"] * 1.0
        direction = math.radians(options.get("heading_offset_deg", 0.0))
    except TypeError as error:
        raise Error(f"radius, speed, heading_offset_deg: {error}; allowed: numbers") from None
    velocity = [round(speed * part, DIGITS) for part in (math.cos(direction), math.sin(direction))]
    return {"run.path": "", "run.rate": rate, "run.velocity": velocity}


def sensors_are_ideal(sensors: str) -> bool:
    if sensors not in ("noisy", "ideal"):
        raise Error(f"sensors: given {sensors!r}; allowed: noisy, ideal")
    return sensors == "ideal"


def flattened(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Values by dotted key."""
    return dict(leaves("", parameters))


def leaves(prefix: str, parameters: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    if not isinstance(parameters, Mapping):
        raise Error(f"given {parameters!r}; allowed: a dict of parameters")
    for key, value in parameters.items():
        if isinstance(value, Mapping):
            yield from leaves(f"{prefix}{key}.", value)
        else:
            yield f"{prefix}{key}", value


def toml(key: str, value: Any) -> str:
    """The value as TOML: bool, number, text or a flat sequence of them; NumPy's too."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(toml(key, item) for item in value)}]"
    raise Error(f"{key}: given {value!r}; allowed: a bool, number, text or list")
