"""Random configurations over the documented ranges: the program does what was asked, says that it
did not, or says what is wrong. Never a crash, a hang, a value that is no number or a wrong exit
code.

PIROUETTE_RANDOM_CONFIGS: how many [20]; PIROUETTE_RANDOM_SEED: of which [1]."""

import json
import math
import os
import random
import re
import resource
import subprocess
from pathlib import Path
from typing import Any

import pytest
from conftest import PROGRAM

COUNT = int(os.environ.get("PIROUETTE_RANDOM_CONFIGS", "20"))
SEED = int(os.environ.get("PIROUETTE_RANDOM_SEED", "1"))
RUN_TIME = 2.0  # s, recorded at most
PATIENCE = 400.0  # s, of a simulation of a few seconds with the smallest steps on a busy machine
MOST_MEMORY = 400_000_000  # bytes
# Lengths of the run: drawn, it would take days. Paths and controllers by name.
FIXED = {
    "run.time_limit": RUN_TIME,
    "run.settle_time": 0.5,
    "gait.stand_time": 0.3,
    "run.turns": 0.05,
    "run.laps": 0.02,
}
CHOICES = {
    "robot": ["mini_cheetah", "go1"],
    "controller": ["mit", "fkm", "asc", "pirouette"],
    "profile": ["nominal", "realistic"],
    "run.path": ["", "", "", "figure8", "square"],
}


def documented() -> dict[str, str]:
    """What `config dump` says is allowed, by key; empty for free text."""
    text = subprocess.run([PROGRAM, "config", "dump"], capture_output=True, text=True, check=True)
    allowed, table = {}, ""
    for line in text.stdout.splitlines():
        if header := re.match(r"\[(\S+)\]", line):
            table = header[1] + "."
        elif parameter := re.match(r"(\w+) = .*?  +# (?:\[.*?\] )?(?:\((.*?)\) )?", line):
            allowed[table + parameter[1]] = parameter[2] or ""
    return allowed


def number(draw: random.Random, low: float, high: float) -> float:
    """An end of the range, a value near a small end, or any."""
    kind = draw.random()
    if kind < 0.15:
        return draw.choice([low, high])
    if kind < 0.6 and low >= 0.0:
        smallest = max(low, 1e-4 * high)
        return min(high, smallest * (high / smallest) ** draw.random()) if high > 0.0 else 0.0
    return draw.uniform(low, high)


def terrain(draw: random.Random) -> str:
    value = draw.uniform
    return draw.choice(
        [
            "flat",
            f"slope:{value(0, 40):.3g}",
            f"slope:{value(0, 40):.3g}+rough:{value(0, 0.1):.3g}",
            f"stairs:{value(0, 0.2):.3g}x{value(0.1, 1):.3g}@{value(-180, 180):.3g}",
            f"rough:{value(0, 0.1):.3g}",
            f"blocks:{value(0, 0.2):.3g}",
            f"patch:{value(0, 5):.3g}x{value(0.1, 10):.3g}",
            f"soft:{value(0.002, 0.5):.3g}",
        ]
    )


def literal(draw: random.Random, key: str, allowed: str) -> str:
    """A value as TOML."""
    if key in CHOICES:
        return json.dumps(draw.choice(CHOICES[key]))
    if key == "plant.terrain":
        return json.dumps(terrain(draw))
    several = re.fullmatch(r"(\d+) numbers, each (.*)", allowed)
    whole = allowed.startswith("whole number, ")
    span = re.search(r"(\S+) to (\S+)$", allowed)
    if several:
        low, high = map(float, span.groups())
        return (
            "[" + ", ".join(f"{number(draw, low, high):.6g}" for _ in range(int(several[1]))) + "]"
        )
    if span:
        low, high = map(float, span.groups())
        value = number(draw, low, high)
        return str(round(value)) if whole else f"{value:.6g}"
    word = draw.choice(allowed.split(", "))
    return word if word in ("true", "false") else json.dumps(word)


def configuration(index: int) -> dict[str, str]:
    draw = random.Random(f"{SEED}, {index}")
    share = draw.choice([0.02, 0.1, 0.3, 1.0])
    settings = {
        key: literal(draw, key, allowed)
        for key, allowed in documented().items()
        if draw.random() < share and key not in FIXED
    }
    # A mistake is rarely only in the rate, the step or the period: most such draws are refused.
    if draw.random() < 0.8:
        for key in ("control.rate", "plant.timestep", "plant.command_latency"):
            settings.pop(key, None)
    return settings | {key: json.dumps(value) for key, value in FIXED.items()}


def leaves(value: Any, name: str = "") -> list[tuple[str, Any]]:
    if isinstance(value, dict):
        return [leaf for key, part in value.items() for leaf in leaves(part, f"{name}.{key}")]
    return [(name, value)]


def no_number(text: str) -> None:
    raise ValueError(f"metrics.json has {text}")


def check_metrics(folder: Path, returncode: int) -> None:
    metrics = json.loads((folder / "metrics.json").read_text(), parse_constant=no_number)
    for name, value in leaves(metrics):
        assert not isinstance(value, float) or math.isfinite(value), name
        if isinstance(value, float) and name.endswith("_mm"):
            assert abs(value) < 1e7, f"{name}: {value} mm within {RUN_TIME} s"  # 10 km
        if isinstance(value, float) and "variance" in name:
            assert value >= 0.0, name
    done, fell = metrics["done"], metrics["fell"]
    if returncode == 0:
        assert not fell
        assert done is None or done >= 0.98
    else:
        assert fell or done is None or done < 0.98


def limit() -> None:
    """A run that needs more memory cannot allocate it, and crashes."""
    resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def simulate(settings: dict[str, str], folder: Path) -> tuple[int, str]:
    """Exit code, and the command line with what it said."""
    path = json.loads(settings.get("run.path", '""'))
    verb = ["turn", "--path", path] if path else ["spin"]
    assignments = [f"--set={key}={value}" for key, value in settings.items() if key != "run.path"]
    command = [str(PROGRAM), *verb, "--quiet", "--out", str(folder), *assignments]
    process = subprocess.run(
        command, capture_output=True, text=True, preexec_fn=limit, timeout=PATIENCE
    )
    told = f"{' '.join(command)}\n{process.stderr}"
    assert process.returncode in (0, 1, 2), told
    assert process.stdout == "", told
    assert "Traceback" not in process.stderr, told
    return process.returncode, told


@pytest.mark.parametrize("index", range(COUNT))
def test_a_random_configuration_runs_or_says_why_not(index, tmp_path):
    settings, folder = configuration(index), tmp_path / "run"
    returncode, told = simulate(settings, folder)
    while returncode == 2:
        # Refused: the error names what was set. Without that, the rest has its turn.
        assert not folder.exists(), told
        error = told.split("\n", 1)[1]
        assert error.startswith("error: "), told
        named = [key for key in settings if key not in FIXED and names(error, key)]
        assert named, told
        for key in named:
            del settings[key]
        returncode, told = simulate(settings, folder)
    assert returncode == 0 or told.split("\n", 1)[1].strip(), told
    try:
        check_metrics(folder, returncode)
    except (AssertionError, ValueError) as wrong:
        raise AssertionError(f"{wrong}\n{told}") from None


def names(error: str, key: str) -> bool:
    """Whether the error is about the parameter: its key, or the option that sets it."""
    option = {"run.path": "--path"}.get(key, key)
    return key in error or option in error
