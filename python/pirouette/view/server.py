"""The live view: a simulation, its picture and its panel on one server."""

import contextlib
import functools
import io
import ipaddress
import re
import threading
import time
from collections.abc import Iterator, Sequence
from typing import Any

import viser
import websockets.asyncio.server

from pirouette.configuration import ConfigLike
from pirouette.view.live import Live
from pirouette.view.panel import Panel
from pirouette.view.world import World

FRAME_TIME = 1.0 / 30.0  # s
FRAMES_PER_UPDATE = 6  # of status and plot


LOOPBACK = re.compile(r"https?://(localhost|127(\.\d{1,3}){3}|\[::1\])(:\d+)?")


def page_origins(host: str, others: Sequence[str]) -> list[re.Pattern[str] | str | None]:
    """Origins of the pages that may steer the robot: those of this machine, those of `host` when
    that is one address, and `others`. None stands for programs, which send no Origin; a browser
    sends one with every WebSocket, and any page that it shows can open one to any address."""
    origins: list[re.Pattern[str] | str | None] = [None, LOOPBACK, *others]
    with contextlib.suppress(ValueError):
        if ipaddress.ip_address(host).is_unspecified:
            return origins
    name = f"[{host}]" if ":" in host else host
    return [*origins, re.compile(rf"https?://{re.escape(name)}(:\d+)?", re.IGNORECASE)]


@contextlib.contextmanager
def only_pages_of(origins: Sequence[re.Pattern[str] | str | None]) -> Iterator[None]:
    """WebSocket servers that start meanwhile refuse pages of other origins (403). viser has no
    option for it; the server below it has."""
    serve = websockets.asyncio.server.serve
    websockets.asyncio.server.serve = functools.partial(serve, origins=origins)
    try:
        yield
    finally:
        websockets.asyncio.server.serve = serve


class View:
    """A server with the simulation of a configuration. `origins`: of pages that may steer the
    robot, besides those of `host` and of this machine."""

    def __init__(
        self,
        config: ConfigLike,
        options: dict[str, Any],
        host: str,
        port: int,
        origins: Sequence[str] = (),
    ) -> None:
        self.live = Live(config, options)
        # viser greets
        with contextlib.redirect_stdout(io.StringIO()), only_pages_of(page_origins(host, origins)):
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
