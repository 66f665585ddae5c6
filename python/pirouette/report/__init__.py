"""Writes the report of runs: one HTML file that opens from disk without a network.

    pirouette-report RUN... [--out FILE] [--picture FILE.png]

Tables, interactive figures and a 3D replay, from the run folders alone.
"""

import argparse
import os
from importlib import import_module
from pathlib import Path

from pirouette import command
from pirouette.run_folder import add_to_record, load


def default_file(folders: list[Path]) -> Path:
    """report.html in the run folder; of several runs in the folder that holds them all."""
    if len(folders) == 1:
        return folders[0] / "report.html"
    return Path(os.path.commonpath([folder.resolve() for folder in folders])) / "report.html"


def write(folders: list[Path], out: Path | None, picture: Path | None = None) -> Path:
    """Reads the runs, writes their report and perhaps a picture of them, returns the report's path.
    Raises RunError."""
    runs = [load(folder) for folder in folders]
    out = out or default_file(folders)
    # Imported now: they take longer than to find out that a folder is no run.
    draw = import_module("pirouette.picture").write_picture if picture else None  # before mujoco
    page = import_module("pirouette.report.page").page
    with command.whole_file(out) as part:
        part.write_text(page(runs), encoding="utf-8")
        if draw and picture:
            with command.whole_file(picture) as picture_part:
                draw(runs, picture_part)
    if len(folders) == 1 and out == default_file(folders):
        add_to_record(folders[0], out.name)
    return out


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="pirouette report", description="Writes one HTML file about one run or several."
    )
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN", help="run folder")
    parser.add_argument("--out", type=Path, metavar="FILE", help="file to write [RUN/report.html]")
    parser.add_argument(
        "--picture", type=Path, metavar="FILE.png", help="also a picture for a README or slides"
    )
    given = parser.parse_args()
    return command.run(lambda: print(write(given.runs, given.out, given.picture)))
