"""The live view: a simulation, its picture and its panel on one server."""

import contextlib
import io
import threading
import time
from typing import Any

import viser

from pirouette.configuration import ConfigLike
from pirouette.view.live import Live
from pirouette.view.panel import Panel
from pirouette.view.world import World

FRAME_TIME = 1.0 / 30.0  # s
FRAMES_PER_UPDATE = 6  # of status and plot


class View:
    """A server with the simulation of a configuration."""

    def __init__(self, config: ConfigLike, options: dict[str, Any], host: str, port: int) -> None:
        self.live = Live(config, options)
        with contextlib.redirect_stdout(io.StringIO()):  # viser greets
            self.server = viser.ViserServer(host=host, port=port, label="pirouette", verbose=False)
        self.server.gui.configure_theme(show_logo=False, show_share_button=False)
        self.world = World(self.server, self.live.simulation)
        self.panel = Panel(self.server, self.live)
        self.live.rebuilt = lambda: self.world.enter(self.live.simulation)
        self.address = f"http://{host}:{self.server.get_port()}"

    def run(self, stop: threading.Event) -> None:
        """Simulates in real time until `stop` is set."""
        frame, due = 0, time.monotonic()
        while not stop.is_set():
            if not self.live.wait(due - time.monotonic()):
                due = max(due + FRAME_TIME, time.monotonic())
            changed = self.live.advance()
            with self.server.atomic():
                state = self.live.simulation.state
                self.world.show(state, self.panel.follow.value)
                if changed or frame % FRAMES_PER_UPDATE == 0:
                    self.panel.update(state)
            frame += 1

    def close(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):  # viser takes its leave
            self.server.stop()
