"""Writes a run, or the table of a sweep, in formats of other programs.

pirouette-export RUN --mcap [FILE] | --csv [FILE] | --parquet [FILE] | --video [FILE]
pirouette-export SWEEP --parquet [FILE]
"""

import argparse
from importlib import import_module
from pathlib import Path

from pirouette import command
from pirouette.run_folder import RunError, add_to_record, load

# Option, file in the run folder, module and function that writes it, meaning. Modules are loaded
# when used: each needs another library.
FORMATS = {
    "mcap": ("trace.mcap", "recording", "write_mcap", "recording for Foxglove and PlotJuggler"),
    "csv": ("trace.csv", "tables", "write_csv", "table of the trace"),
    "parquet": (
        "trace.parquet",
        "tables",
        "write_parquet",
        "table of the trace, or of a sweep's trials",
    ),
    "video": ("video.mp4", "video", "write_video", "video at real-time speed"),
}
SWEEP_TABLE, SWEEP_PARQUET = "table.csv", "table.parquet"


def write(folder: Path, kind: str, out: Path | None) -> Path:
    """Exports a run as one of FORMATS, or a sweep as Parquet; returns the file's path. Raises
    RunError."""
    if (folder / SWEEP_TABLE).is_file():
        return write_sweep(folder, kind, out)
    name, module, function, _ = FORMATS[kind]
    run = load(folder)
    out = out or folder / name
    with command.whole_file(out) as part:
        getattr(import_module(f"{__name__}.{module}"), function)(run, part)
    if out == folder / name:
        add_to_record(folder, name)
    return out


def write_sweep(folder: Path, kind: str, out: Path | None) -> Path:
    """A row for each trial of the sweep, with the types of its columns."""
    if kind != "parquet":
        raise RunError(f"{folder}: holds the {SWEEP_TABLE} of a sweep; allowed: --parquet")
    out = out or folder / SWEEP_PARQUET
    with command.whole_file(out) as part:
        import_module(f"{__name__}.study").write_parquet(folder / SWEEP_TABLE, part)
    return out


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="pirouette export",
        description="Writes a run or a sweep's table in a format of other programs.",
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="folder of a run or of a sweep")
    group = parser.add_mutually_exclusive_group(required=True)
    for kind, (name, _, _, meaning) in FORMATS.items():
        group.add_argument(
            f"--{kind}",
            nargs="?",
            type=Path,
            const=Path(),
            metavar="FILE",
            help=f"{meaning} [RUN/{name}]",
        )
    arguments = parser.parse_args()
    kind = next(k for k in FORMATS if getattr(arguments, k) is not None)
    given = getattr(arguments, kind)
    out = given if given != Path() else None
    return command.run(lambda: print(write(arguments.run, kind, out)))
