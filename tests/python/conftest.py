"""Runs of the built program, and a headless Chromium, for the tests of the Python side."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

os.environ.setdefault(
    "MUJOCO_GL", "egl"
)  # read when mujoco is imported, by whichever test is first

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("PIROUETTE", ROOT / "build/release/pirouette"))
ARTEFACTS = ROOT / "build/artefacts"
# The [common] part of an experiment whose trials take a tenth of a second.
QUICK_TRIALS = """[common]
run.turns = 0.02
run.settle_time = 0.1
gait.stand_time = 0.2"""


@pytest.fixture(scope="session")
def simulate(tmp_path_factory) -> Callable[..., Path]:
    """Runs a verb of the program for half a turn; returns the run folder."""

    def run(name: str, *arguments: str) -> Path:
        folder = tmp_path_factory.mktemp("runs") / name
        short = ["--turns", "0.5", "--set", "run.settle_time=1", "--quiet"]
        subprocess.run([PROGRAM, *arguments, *short, "--out", folder], check=True)
        return folder

    return run


@pytest.fixture(scope="session")
def spin_folder(simulate) -> Path:
    return simulate("spin", "spin")


@pytest.fixture
def own_run(spin_folder, tmp_path) -> Path:
    """A copy of that run to break or to write to."""
    return Path(shutil.copytree(spin_folder, tmp_path / "run"))


@pytest.fixture(scope="session")
def call() -> Callable[..., subprocess.CompletedProcess]:
    """Runs a module of the package as a user does."""

    def run(module: str, *arguments: object) -> subprocess.CompletedProcess:
        return subprocess.run(
            [sys.executable, "-m", f"pirouette.{module}", *map(str, arguments)],
            capture_output=True,
            text=True,
            env=os.environ | {"PYTHONPATH": str(ROOT / "python")},
        )

    return run


class Browser:
    """Chromium with a software renderer, and what it logged and asked the network for."""

    def __init__(self) -> None:
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        for flag in (
            "headless=new",
            "no-sandbox",
            "use-angle=swiftshader",
            "enable-unsafe-swiftshader",
            "window-size=720,640",
            "hide-scrollbars",
        ):
            options.add_argument(f"--{flag}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(options, Service(shutil.which("chromedriver")))
        self.driver.set_script_timeout(60)

    def errors(self) -> list[str]:
        log = self.driver.get_log("browser")
        return [entry["message"] for entry in log if entry["level"] == "SEVERE"]

    def requests(self) -> list[str]:
        """Addresses that were asked for, but those inside the page and its own file."""
        messages = (
            json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")
        )
        urls = [
            message["params"].get("request", message["params"]).get("url", "")
            for message in messages
            if message["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated")
        ]
        return [url for url in urls if not url.startswith(("data:", "blob:", "file:", "about:"))]


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    missing = [name for name in ("chromium", "chromedriver") if not shutil.which(name)]
    if missing:
        pytest.skip(f"not installed: {' and '.join(missing)}")
    browser = Browser()
    yield browser
    browser.driver.quit()
