"""Builds the mutants of tests/mutation/mutants.toml one by one and runs the tests on each.

python scripts/mutation.py [--only TEXT] [--jobs N]; from the project's root, after a build. Works on
a copy below build/mutation. Exit code 0: none survived; 1: some did; 2: a mutant does not apply or
does not build, or the tests fail on the code as it is.
"""

import argparse
import os
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
TREE = ROOT / "build/mutation/tree"
BUILD = ROOT / "build/mutation/build"
TESTS = BUILD / "tests/pirouette_unit_tests"
CMAKE = Path(sys.executable).parent / "cmake"
PATIENCE = 900  # s, of tests that a mutant may have sent round for ever


def run(*command: object, timeout: float | None = None) -> subprocess.CompletedProcess:
    environment = os.environ | {"GTEST_FAIL_FAST": "1", "GTEST_BRIEF": "1"}
    return subprocess.run(
        list(map(str, command)), capture_output=True, text=True, env=environment, timeout=timeout
    )


def copy_tree() -> None:
    """The files that git knows, as they are now; files that did not change keep their times."""
    TREE.mkdir(parents=True, exist_ok=True)
    listed = run("git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard")
    for name in listed.stdout.splitlines():
        source, copy = ROOT / name, TREE / name
        if source.is_file() and (not copy.exists() or copy.read_bytes() != source.read_bytes()):
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes(source.read_bytes())


def build(jobs: int) -> bool:
    target = "pirouette_unit_tests"
    return run(CMAKE, "--build", BUILD, "--parallel", jobs, "--target", target).returncode == 0


def notices(filter_: str) -> bool:
    """Whether a test fails; one that does not end has noticed too."""
    try:
        return run(TESTS, f"--gtest_filter={filter_}", timeout=PATIENCE).returncode != 0
    except subprocess.TimeoutExpired:
        return True


def outcome(mutant: dict, filter_: str, jobs: int) -> str:
    """killed, survived or what is wrong with the mutant."""
    file = TREE / "src/pirouette" / mutant["file"]
    text = file.read_text()
    if text.count(mutant["from"]) != 1:
        return f"`from` stands {text.count(mutant['from'])} times in {mutant['file']}"
    file.write_text(text.replace(mutant["from"], mutant["to"]))
    try:
        if not build(jobs):
            return "does not build"
        return "killed" if notices(filter_) else "survived"
    finally:
        file.write_text(text)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="TEXT", default="", help="mutants whose name holds TEXT")
    parser.add_argument("--jobs", metavar="N", type=int, default=os.cpu_count(), help="of builds")
    # Studies simulate whole trials: slow, and the closed loop has tests of its own.
    parser.add_argument("--filter", default="-Sweeps*:Survival*", help="of the unit tests")
    arguments = parser.parse_args()
    mutants = tomllib.loads((ROOT / "tests/mutation/mutants.toml").read_text())["mutants"]
    mutants = [mutant for mutant in mutants if arguments.only in mutant["name"]]
    copy_tree()
    configured = run(
        CMAKE, "-S", TREE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
        "-DPIROUETTE_INSTALL=OFF", f"-DPIROUETTE_PYTHON={sys.executable}",
    )  # fmt: skip
    if configured.returncode != 0 or not build(arguments.jobs):
        print(f"the code as it is does not build\n{configured.stderr}", file=sys.stderr)
        return 2
    if notices(arguments.filter):
        print("the tests fail on the code as it is", file=sys.stderr)
        return 2
    outcomes = []
    for number, mutant in enumerate(mutants, 1):
        outcomes.append(outcome(mutant, arguments.filter, arguments.jobs))
        print(f"{number:3}/{len(mutants)}  {outcomes[-1]:10}  {mutant['name']}", flush=True)
    survived = outcomes.count("survived")
    wrong = len(outcomes) - survived - outcomes.count("killed")
    print(f"{len(mutants)} mutants, {survived} survived, {wrong} wrong")
    return 2 if wrong else 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
