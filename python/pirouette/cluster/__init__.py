"""Runs the trials of an experiment on a Ray cluster: the same files, byte for byte, as one machine
leaves.

pirouette-cluster FILE [--address local|auto|HOST:PORT] [--tasks N] [--out DIR] [--turns N]
                  [--seeds N] [--trials N] [--seed N]
"""

import argparse
from pathlib import Path

from pirouette import command
from pirouette.cluster.driver import Study, run

LOCAL = "local"


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="pirouette cluster", description="Runs an experiment's trials on a Ray cluster."
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="experiment, as for sweep")
    parser.add_argument(
        "--address",
        default=LOCAL,
        help="of a running cluster: auto, or HOST:PORT; local starts one here [local]",
    )
    parser.add_argument("--tasks", type=int, metavar="N", help="parts to run the trials in")
    parser.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        help="folder of results, tables and traces; what is finished there is kept "
        "[runs/sweep-NAME, runs/montecarlo-NAME]",
    )
    changes = parser.add_argument_group("changes, as for sweep and montecarlo")
    for option in ("--turns", "--seeds", "--trials", "--seed"):
        changes.add_argument(option, metavar="N")
    given = parser.parse_args()
    options = [
        word
        for name in ("turns", "seeds", "trials", "seed")
        if (value := getattr(given, name)) is not None
        for word in (f"--{name}", value)
    ]
    codes: list[int] = []
    study = Study(given.file, given.out, tuple(options))
    failed = command.run(lambda: codes.append(run(study, given.address, given.tasks)))
    return failed or codes[0]
