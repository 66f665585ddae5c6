"""What a node of the cluster does: a shard of the trials in a scratch folder of its own.

Sent to the nodes by value, so it imports nothing of this package: a node needs the program only.
"""

import os
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Work:
    """The same for every shard."""

    program: str  # path of the compiled program on every node
    version: str  # what it must say of itself
    verb: str
    name: str  # of the experiment file
    text: str  # of the experiment file
    options: tuple[str, ...]
    folder: str  # where relative paths begin, if the node has it
    environment: dict[str, str]
    known: bytes  # results so far: lines of JSON


@dataclass(frozen=True)
class Finished:
    """What one shard has left, or why it has not."""

    results: bytes = b""  # lines of JSON
    traces: dict[str, bytes] = field(default_factory=dict)  # by file name
    error: str = ""


def call(work: Work, *arguments: object) -> subprocess.CompletedProcess:
    return subprocess.run(
        [work.program, *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=work.folder if Path(work.folder).is_dir() else None,
        env=os.environ | work.environment,
    )


def run_shard(work: Work, index: int, count: int) -> Finished:
    """Trials index, index + count, ... of the experiment, counted from 1."""
    node = os.uname().nodename
    try:
        version = call(work, "--version").stdout.strip()
    except OSError as error:
        return Finished(error=f"{node}: {work.program}: {error.strerror}")
    if version != work.version:
        return Finished(error=f"{node}: {work.program}: is {version}; allowed: {work.version}")
    with tempfile.TemporaryDirectory(prefix="pirouette-") as scratch:
        file, out = Path(scratch, work.name), Path(scratch, "out")
        file.write_text(work.text)
        out.mkdir()
        (out / "results.jsonl").write_bytes(work.known)
        shard = ("--out", out, "--jobs", 1, "--shard", f"{index}/{count}")
        done = call(work, work.verb, file, *shard, *work.options)
        if done.returncode != 0:
            return Finished(error=f"{node}: shard {index}/{count}: {done.stderr.strip()}")
        return Finished(
            (out / f"results-{index}of{count}.jsonl").read_bytes(),
            {trace.name: trace.read_bytes() for trace in (out / "traces").glob("*.npy")},
        )
