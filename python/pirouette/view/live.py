"""A simulation that keeps step with the clock and takes changes while it runs."""

import queue
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from pirouette import _core
from pirouette.api import MotionCommand, Simulation
from pirouette.configuration import KEYS, ConfigLike
from pirouette.errors import Error
from pirouette.signals import TURN

MOST_BEHIND = 0.1  # s, that the simulation catches up; more is lost when the machine is too slow
SPEED_TIME = 1.0  # s, over which the speed is measured
LONGEST_MEMORY = 10.0  # s, of positions for the radius


@dataclass(frozen=True)
class Motion:
    """What the robot is told to do."""

    rate: float = 0.7  # rad/s
    radius: float = 0.0  # m, signed
    forwards: float = 0.0  # m/s, beside what the circle needs
    left: float = 0.0  # m/s

    def command(self) -> MotionCommand:
        forwards = self.forwards + self.radius * self.rate
        return MotionCommand(walk=True, v_H=(forwards, self.left), yaw_rate=self.rate)


def check(name: str, value: float, key: str, unit: str) -> None:
    """Raises Error unless the value is within the range of the parameter `key`."""
    low, high = _core.parameter_range(key)
    if not low <= value <= high:  # nor NaN
        raise Error(f"{name}: given {value:g}; allowed: {low:g} to {high:g} {unit}")


class RadiusMeter:
    """Distance of the centre of mass from its mean over the last turn, or the last 10 s."""

    def __init__(self) -> None:
        self.rows: deque[tuple[float, float, float, float]] = deque()

    def update(self, state: dict[str, Any]) -> float:
        """m, at this moment."""
        x, y, _ = state["true_com_position"]
        time_now, yaw = state["time"], state["true_rpy"][2]
        self.rows.append((time_now, yaw, x, y))
        while (
            time_now - self.rows[0][0] > LONGEST_MEMORY or abs(yaw - self.rows[0][1]) > TURN
        ) and len(self.rows) > 1:
            self.rows.popleft()
        mean = np.mean([row[2:] for row in self.rows], axis=0)
        return float(np.hypot(*(np.array([x, y]) - mean)))


class Live:
    """The simulation of a configuration. One thread calls advance(); others hand it their changes
    with change()."""

    def __init__(self, config: ConfigLike, options: dict[str, Any]) -> None:
        self.config, self.options = config, dict(options)
        self.simulation = Simulation(config, **options)
        run = self.simulation.config["run"]
        rate, (forwards, left) = run["rate"], run["velocity"]
        self.motion = (
            Motion(rate, radius=forwards / rate, left=left)
            if rate
            else Motion(rate, forwards=forwards, left=left)
        )
        self.friction: float = self.simulation.config["plant"]["friction"]
        self.running = True
        self.speed = 0.0  # simulated over real time
        self.radius_meter = RadiusMeter()
        self.rebuilt: Callable[[], None] = lambda: None  # called with every new world
        self._changes: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._changed = threading.Event()
        self._clock = self._speed_clock = time.monotonic()
        self._behind = self._speed_start = 0.0

    def change(self, what: Callable[[], None]) -> None:
        """Has `what` done between two steps, soon. From any thread."""
        self._changes.put(what)
        self._changed.set()

    def wait(self, timeout: float) -> bool:
        """Waits for a change, at most so long (s). Whether there is one."""
        return self._changed.wait(max(0.0, timeout))

    def advance(self) -> bool:
        """Makes the changes that are due and simulates the time since the last call. Whether there
        were changes."""
        changed = self._changed.is_set()
        self._changed.clear()
        while not self._changes.empty():
            self._changes.get()()
        now = time.monotonic()
        self._behind = min(self._behind + now - self._clock, MOST_BEHIND)
        self._clock = now
        if not self.running:
            self._behind = 0.0
            return changed
        ticks = int(self._behind / self.simulation.period)
        self._behind -= ticks * self.simulation.period
        self.simulation.step(ticks)
        if now - self._speed_clock > SPEED_TIME:
            self.speed = (self.simulation.time - self._speed_start) / (now - self._speed_clock)
            self._restart_speed()
        return changed

    def _restart_speed(self) -> None:
        self._speed_clock, self._speed_start = time.monotonic(), self.simulation.time

    # Changes, to be handed to change(). They raise Error for a value that the configuration would
    # refuse, and leave everything as it was.

    def move(self, **parts: float) -> None:
        """Changes parts of the motion."""
        motion = replace(self.motion, **parts)
        command = motion.command()
        check("rate", command.yaw_rate, "run.rate", "rad/s")
        for name, speed in zip(("forwards", "to the left"), command.v_H, strict=True):
            check(f"speed {name}", speed, "run.velocity", "m/s")
        self.motion = motion
        self.simulation.command = command
        self.radius_meter = RadiusMeter()

    def set_friction(self, friction: float) -> None:
        self.simulation.set_friction(friction)
        self.friction = friction

    def push(self, forwards: float, left: float) -> None:
        """Adds to the trunk's velocity, m/s, in heading axes."""
        yaw = self.simulation.state["true_rpy"][2]
        c, s = np.cos(yaw), np.sin(yaw)
        self.simulation.push((c * forwards - s * left, s * forwards + c * left, 0.0))

    def pause(self, paused: bool) -> None:
        self.running = not paused
        self._restart_speed()

    def reset(self) -> None:
        self.simulation.reset()
        self._begin()

    def rebuild(self, option: str, value: str) -> None:
        """A new world or controller. Raises Error and keeps the old one if it is not allowed."""
        settings = dict(self.options.get("set", {}))
        settings.pop(KEYS.get(option), None)  # it would be above the option
        options = self.options | {option: value, "set": settings}
        self.simulation = Simulation(self.config, **options)
        self.options = options
        self._begin()
        self.rebuilt()

    def _begin(self) -> None:
        self.simulation.set_friction(self.friction)
        self.simulation.command = self.motion.command()
        self.radius_meter = RadiusMeter()
        self._restart_speed()
