"""Sliders, buttons, keys and the radius beside the picture."""

from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
import viser
from viser import uplot

from pirouette import _core, style
from pirouette.errors import Error
from pirouette.view.live import Live

TERRAINS = (
    "flat",
    "slope:5",
    "slope:10",
    "slope:10+rough:0.02",
    "stairs:0.03x0.20",
    "rough:0.04",
    "blocks:0.03",
    "patch:0.3x0.6",
    "soft:0.02",
)
PUSHES = {"ahead": (1, 0), "back": (-1, 0), "left": (0, 1), "right": (0, -1)}
KEYS = """
| key | |
|---|---|
| I, K | faster forwards, backwards |
| U, O | faster to the left, to the right |
| J, L | turn more to the left, to the right |
| B | stop |
| N | push |
| P | pause |
| R | reset |
"""
PLOT_TIME = 20.0  # s
SPEED_STEP, RATE_STEP = 0.05, 0.1  # m/s and rad/s, of one key press


class Panel:
    """What the user sees and does. Handlers run in threads of the server: they only hand changes
    to `live`."""

    def __init__(self, server: viser.ViserServer, live: Live) -> None:
        self.server, self.gui, self.live = server, server.gui, live
        self.status = self.gui.add_markdown("")
        self.add_plot()
        self.add_motion()
        self.add_world()
        self.add_disturbances()
        self.add_run()
        with self.gui.add_folder("Keys", expand_by_default=False):
            self.gui.add_markdown(KEYS)
        self.add_keys()

    def add_plot(self) -> None:
        self.times: deque[float] = deque()
        self.radii: deque[float] = deque()
        self.plot = self.gui.add_uplot(
            self.curve(),
            series=(
                uplot.Series(label="s"),
                uplot.Series(label="mm", stroke=style.colour(0), width=2),
            ),
            scales={"x": uplot.Scale(time=False)},
            legend=uplot.Legend(show=False),
            title="Radius about the mean of the last turn, mm",
            aspect=2.2,
        )

    def add_motion(self) -> None:
        motion = self.live.motion
        with self.gui.add_folder("Motion"):
            self.rate = self.slider("rate, rad/s", 3.0, 0.05, motion.rate, "rate")
            self.radius = self.slider("radius, m", 1.0, 0.01, motion.radius, "radius")
            self.forwards = self.slider("forwards, m/s", 0.5, 0.01, motion.forwards, "forwards")
            self.left = self.slider("to the left, m/s", 0.5, 0.01, motion.left, "left")

    def slider(self, label: str, limit: float, step: float, value: float, part: str):
        limit = max(limit, abs(value))
        slider = self.gui.add_slider(label, -limit, limit, step, value)
        self.acts(slider, lambda value: self.live.move(**{part: value}))
        return slider

    def acts(self, control: Any, act: Callable[[Any], None]) -> None:
        """Has `act` done with every new value of the control. A page may send anything: a value
        that is refused is taken back, and said."""
        limits = {name: getattr(control, name) for name in ("min", "max") if hasattr(control, name)}
        good = control.value

        def do(value: Any) -> None:
            nonlocal good
            try:
                act(value)
                good = value
            except Error as error:
                control.value = good
                self.tell(error)

        def update(_: Any) -> None:
            for name, limit in limits.items():
                if getattr(control, name) != limit:
                    setattr(control, name, limit)
            value = control.value
            self.live.change(lambda: do(value))

        control.on_update(update)

    def tell(self, error: Error) -> None:
        for client in self.server.get_clients().values():
            client.add_notification("Not possible", str(error), color="red")

    def add_world(self) -> None:
        config = self.live.simulation.config
        with self.gui.add_folder("World and controller"):
            self.terrain = self.choice("terrain", TERRAINS, config["plant"]["terrain"])
            self.friction = self.gui.add_slider(
                "friction", 0.05, max(1.5, self.live.friction), 0.05, self.live.friction
            )
            self.acts(self.friction, self.live.set_friction)
            self.controller = self.choice(
                "controller", _core.known_controllers(), config["controller"]
            )

    def choice(self, option: str, values: tuple[str, ...] | list[str], value: str):
        """A menu whose entries begin a new simulation."""
        menu = self.gui.add_dropdown(
            option, list(dict.fromkeys((value, *values))), initial_value=value
        )
        self.acts(menu, lambda value: self.live.rebuild(option, value))
        return menu

    def add_disturbances(self) -> None:
        with self.gui.add_folder("Push"):
            self.strength = self.gui.add_slider("push, m/s", 0.1, 1.0, 0.05, 0.3)
            self.pushes = self.gui.add_button_group("direction", tuple(PUSHES))
            self.pushes.on_click(lambda _: self.push(self.pushes.value))

    def push(self, direction: str) -> None:
        if direction not in PUSHES:
            return
        forwards, left = (self.strength.value * part for part in PUSHES[direction])

        def act() -> None:
            try:
                self.live.push(forwards, left)
            except Error as error:
                self.tell(error)

        self.live.change(act)

    def add_run(self) -> None:
        self.paused = self.gui.add_checkbox("pause", False)
        self.paused.on_update(
            lambda _: self.live.change(lambda: self.live.pause(self.paused.value))
        )
        self.follow = self.gui.add_checkbox("follow the robot", True)
        self.reset = self.gui.add_button("Reset")
        self.reset.on_click(lambda _: self.live.change(self.live.reset))

    def add_keys(self) -> None:
        def shift(slider: Any, step: float) -> Callable[[], None]:
            def act() -> None:
                slider.value = float(np.clip(slider.value + step, slider.min, slider.max))

            return act

        def stop() -> None:
            for slider in (self.rate, self.radius, self.forwards, self.left):
                slider.value = 0.0

        def pause() -> None:
            self.paused.value = not self.paused.value

        actions = {
            "I": ("Faster forwards", shift(self.forwards, SPEED_STEP)),
            "K": ("Faster backwards", shift(self.forwards, -SPEED_STEP)),
            "U": ("Faster to the left", shift(self.left, SPEED_STEP)),
            "O": ("Faster to the right", shift(self.left, -SPEED_STEP)),
            "J": ("Turn more to the left", shift(self.rate, RATE_STEP)),
            "L": ("Turn more to the right", shift(self.rate, -RATE_STEP)),
            "B": ("Stop", stop),
            "N": ("Push", lambda: self.push("left")),
            "P": ("Pause", pause),
            "R": ("Reset", lambda: self.live.change(self.live.reset)),
        }
        for key, (label, act) in actions.items():
            command = self.gui.add_command(label, hotkey=key)
            command.on_trigger(lambda _, act=act: act())

    def curve(self) -> tuple[np.ndarray, np.ndarray]:
        """Time (s) and radius (mm); uPlot wants a point."""
        return np.array(self.times or [0.0]), 1e3 * np.array(self.radii or [0.0])

    def update(self, state: dict[str, Any]) -> None:
        """Status and plot of this moment."""
        live = self.live
        if not self.times or state["time"] != self.times[-1]:
            self.add_to_plot(state["time"], live.radius_meter.update(state))
        status = live.simulation.status.name.lower().replace("_", " ")
        if live.simulation.stood_down:
            status = f"**{status}: press Reset**"
        self.status.content = (
            f"{status}, commanded {live.motion.rate:g} rad/s, {state['time']:.1f} s, "
            f"{live.speed:.2f} x real time, radius {1e3 * self.radii[-1]:.1f} mm"
        )

    def add_to_plot(self, time: float, radius: float) -> None:
        """A point (s, m); a time that went back is that after a reset."""
        if self.times and time < self.times[-1]:
            self.times.clear(), self.radii.clear()
        self.times.append(time)
        self.radii.append(radius)
        while self.times[-1] - self.times[0] > PLOT_TIME:
            self.times.popleft(), self.radii.popleft()
        self.plot.data = self.curve()
