"""Shows the running simulation in a browser, with sliders for what the robot is to do.

pirouette-view [--terrain WHAT] [--rate RAD/S] [--port N] ...
"""

import argparse
import re
import socket
import threading
import tomllib
from pathlib import Path
from typing import Any

from pirouette import command
from pirouette.errors import Error


def assignment(text: str) -> tuple[str, Any]:
    """KEY=VALUE; the value is TOML, what is not TOML is a string."""
    key, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"given {text!r}; allowed: KEY=VALUE")
    try:
        return key, tomllib.loads(f"value = {value}")["value"]
    except tomllib.TOMLDecodeError:
        return key, value


def origin(text: str) -> str:
    """SCHEME://NAME[:PORT] of a page, as browsers send it. Raises Error."""
    if not re.fullmatch(r"https?://[^/\s]+", text):
        raise Error(
            f"--allow-origin: given {text!r}; allowed: http://NAME[:PORT] or https://NAME[:PORT]"
        )
    return text.lower()


def parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="pirouette view", description="Shows the running simulation in a browser."
    )
    option = parser.add_argument
    option("--rate", metavar="RAD/S", type=float, help="yaw rate at the start [0.7]")
    option("--radius", metavar="M", type=float, help="signed radius at the start [0]")
    option("--terrain", metavar="WHAT", help="as of pirouette spin [flat]")
    option("--seed", metavar="N", type=int, help="of noise, biases and terrain [1]")
    option("--estimator", metavar="WHICH", help="kalman or truth [kalman]")
    option("--robot", metavar="NAME|FILE.xml", help="folder under robots/, or an MJCF file")
    option("--controller", metavar="NAME", help="mit, fkm, asc or pirouette [pirouette]")
    option("--profile", metavar="NAME", help="plant: nominal or realistic [nominal]")
    option("--config", metavar="FILE", type=Path, help="TOML file of parameters, such as run.toml")
    option("--set", metavar="KEY=VALUE", type=assignment, action="append", help="one parameter")
    option("--host", metavar="ADDRESS", default="127.0.0.1", help="to listen at [127.0.0.1]")
    option("--port", metavar="N", type=int, default=8080, help="the next free one from [8080]")
    option(
        "--allow-origin",
        metavar="URL",
        action="append",
        help="page that may steer the robot, such as http://robot.local:8080; always those of "
        "this machine and of --host",
    )
    return parser.parse_args()


def check_address(host: str, port: int) -> None:
    if not 0 <= port < 2**16:
        raise Error(f"--port: given {port}; allowed: 0 to 65535, 0 for any")
    try:
        socket.create_server((host, 0)).close()
    except OSError as error:
        raise Error(
            f"--host: given {host!r}: {error.strerror}; allowed: an address of this machine, such "
            "as 127.0.0.1, or 0.0.0.0 for all"
        ) from None


def serve(arguments: argparse.Namespace) -> None:
    from pirouette.view.server import View  # needs the compiled library

    options = {name: value for name, value in vars(arguments).items() if value is not None}
    config, host, port = options.pop("config", None), options.pop("host"), options.pop("port")
    check_address(host, port)
    options["set"] = dict(options.get("set", []))
    origins = [origin(text) for text in options.pop("allow_origin", [])]
    view = View(config, options, host, port, origins)
    print(f"Live view: {view.address}, Ctrl-C ends it", flush=True)
    if host in ("0.0.0.0", "::") and not origins:
        print(
            "Pages under this machine's other addresses show the robot only with --allow-origin, "
            "such as http://192.168.0.7:8080",
            flush=True,
        )
    try:
        view.run(threading.Event())
    except KeyboardInterrupt:
        print()
    finally:
        view.close()


def main() -> int:
    arguments = parsed()
    return command.run(lambda: serve(arguments))
