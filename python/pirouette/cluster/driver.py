"""The side that hands out shards and gathers what they leave."""

import fcntl
import os
import re
import shutil
import socket
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import BinaryIO

from pirouette import command
from pirouette.cluster import shard
from pirouette.cluster.shard import Finished, Work
from pirouette.errors import Error

RESULTS = "results-ray.jsonl"  # read by the program as those of any shard
NO_RAY = (
    "ray: not installed; `pip install 'pirouette[cluster]'`, or `.venv/bin/pip install ray` in "
    "the source tree, installs it"
)
SOURCE_TREE = Path(__file__).resolve().parents[3]
TASKS_PER_CPU = 4  # so that no processor waits long for the last task
ANSWER_TIME = 5.0  # s
TRIALS_PER_TASK = 50  # at most, as an interruption loses those of the running tasks


@dataclass(frozen=True)
class Study:
    """What `pirouette sweep` or `montecarlo` would run."""

    file: Path
    folder: Path | None = None  # as the verb's --out, with its default
    options: tuple[str, ...] = ()

    @property
    def verb(self) -> str:
        """What is wrong with the file, the verb says itself."""
        try:
            draws = "trials" in tomllib.loads(self.file.read_text())
        except (OSError, ValueError):
            draws = False
        return "montecarlo" if draws else "sweep"

    @property
    def out(self) -> Path:
        return self.folder or Path("runs") / f"{self.verb}-{self.file.stem}"


def import_ray() -> ModuleType:
    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
    try:
        import ray
    except ImportError as error:
        if error.name not in (None, "ray"):
            raise
        raise Error(NO_RAY) from None
    return ray


def find_program() -> str:
    """The compiled program: $PIROUETTE, the source tree's or the one on PATH."""
    built = SOURCE_TREE / "build/release/pirouette"
    found = os.environ.get("PIROUETTE") or (str(built) if built.is_file() else None)
    found = found or shutil.which("pirouette")
    if found is None:
        raise Error("pirouette: no such program on PATH; `make build` builds it in the source tree")
    return found


def ask(program: str, *arguments: object) -> str:
    """What the program prints; its errors become ours."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise Error(re.sub("^error: ", "", done.stderr.strip(), flags=re.MULTILINE))
    return done.stdout.strip()


def unfinished(program: str, study: Study) -> int:
    """Number of trials that have no result yet; raises Error about a wrong experiment."""
    said = ask(program, study.verb, study.file, "--out", study.out, "--dry-run", *study.options)
    done, total = map(int, re.match(r"(\d+) of (\d+) trials", said).groups())
    return total - done


def known_results(folder: Path) -> bytes:
    """Whole lines of all results in `folder`; the program checks them."""
    texts = [file.read_bytes() for file in sorted(folder.glob("results*.jsonl"))]
    return b"".join(text[: text.rfind(b"\n") + 1] for text in texts)


@contextmanager
def open_results(folder: Path) -> Iterator[BinaryIO]:
    """The results of the cluster to append to; nobody else writes them meanwhile."""
    (folder / "traces").mkdir(parents=True, exist_ok=True)
    path = folder / RESULTS
    path.touch()
    with path.open("r+b") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Error(f"{path}: is in use: another cluster run writes to this folder") from None
        file.truncate(file.read().rfind(b"\n") + 1)  # what a killed process left of a line
        file.seek(0, os.SEEK_END)
        yield file


def keep(finished: Finished, folder: Path, results: BinaryIO) -> None:
    """Traces first: a result in the file says that its trace is there."""
    for name, trace in finished.traces.items():
        with command.whole_file(folder / "traces" / name) as part:
            part.write_bytes(trace)
    results.write(finished.results)
    results.flush()


def run_tasks(ray: ModuleType, work: Work, tasks: int, out: Path) -> None:
    """Runs all shards, keeping each when it is done; raises Error when one has failed."""
    ray.cloudpickle.register_pickle_by_value(shard)
    task = ray.remote(num_cpus=1)(shard.run_shard)
    shared = ray.put(work)
    waiting = [task.remote(shared, index, tasks) for index in range(1, tasks + 1)]
    with open_results(out) as results:
        while waiting:
            done, waiting = ray.wait(waiting)
            finished = ray.get(done[0])
            if finished.error:
                raise Error(finished.error)
            keep(finished, out, results)
            print(f"{tasks - len(waiting)} of {tasks} tasks", file=sys.stderr)


def check_address(address: str) -> None:
    """Ray itself tries for minutes. Raises Error when nobody answers at HOST:PORT."""
    host, colon, port = address.removeprefix("ray://").rpartition(":")
    if not colon:
        if address in ("local", "auto"):
            return
        raise Error(f"--address: given {address!r}; allowed: local, auto, HOST:PORT")
    try:
        socket.create_connection((host, int(port)), ANSWER_TIME).close()
    except (OSError, ValueError, OverflowError) as error:
        raise Error(f"--address: given {address!r}: no cluster answers there ({error})") from None


def run(study: Study, address: str, tasks: int | None) -> int:
    """Runs what is not finished, then writes the tables; exit code of the program."""
    if tasks is not None and tasks < 1:
        raise Error(f"--tasks: given {tasks}; allowed: a whole number from 1 on")
    program = find_program()
    trials = unfinished(program, study)
    if trials > 0:
        check_address(address)
        ray = import_ray()
        work = Work(
            program=program,
            version=ask(program, "--version"),
            verb=study.verb,
            name=study.file.name,
            text=study.file.read_text(),
            options=study.options,
            folder=os.getcwd(),
            environment={k: v for k, v in os.environ.items() if k == "PIROUETTE_DATA_DIR"},
            known=known_results(study.out),
        )
        try:
            ray.init(address=address, include_dashboard=False, log_to_driver=False)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise Error(f"--address: given {address!r}: {error}") from None
        try:
            cpus = int(ray.cluster_resources().get("CPU", 1))
            usual = max(TASKS_PER_CPU * cpus, -(-trials // TRIALS_PER_TASK))
            run_tasks(ray, work, min(tasks or usual, trials), study.out)
        finally:
            ray.shutdown()
    return merge(program, study)


def merge(program: str, study: Study) -> int:
    arguments = [study.verb, study.file, "--out", study.out, "--merge", *study.options]
    return subprocess.run([program, *map(str, arguments)]).returncode
