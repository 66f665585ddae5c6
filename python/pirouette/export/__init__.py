"""Writes a run in formats of other programs.

pirouette-export RUN --mcap [FILE] | --csv [FILE] | --parquet [FILE] | --video [FILE]
"""

import argparse
from importlib import import_module
from pathlib import Path

from pirouette import command
from pirouette.run_folder import load

# Option, file in the run folder, module and function that writes it, meaning. Modules are loaded
# when used: each needs another library.
FORMATS = {
    "mcap": ("trace.mcap", "recording", "write_mcap", "recording for Foxglove and PlotJuggler"),
    "csv": ("trace.csv", "tables", "write_csv", "table of the trace"),
    "parquet": ("trace.parquet", "tables", "write_parquet", "table of the trace"),
    "video": ("video.mp4", "video", "write_video", "video at real-time speed"),
}


def write(folder: Path, kind: str, out: Path | None) -> Path:
    """Exports a run as one of FORMATS, returns the file's path. Raises RunError."""
    name, module, function, _ = FORMATS[kind]
    run = load(folder)
    out = out or folder / name
    with command.whole_file(out) as part:
        getattr(import_module(f"{__name__}.{module}"), function)(run, part)
    return out


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="pirouette export", description="Writes a run in a format of other programs."
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="run folder")
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
