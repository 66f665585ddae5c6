"""Writes the report of runs: one HTML file that opens from disk without a network.

    pirouette-report RUN... [--out FILE]

Tables, interactive figures and a 3D replay, from the run folders alone.
"""

import argparse
import os
import re
from html import escape
from importlib.resources import files
from pathlib import Path

from plotly.offline import get_plotlyjs

from pirouette import command
from pirouette.report import figures, replay, summary
from pirouette.run_folder import Run, load

REPLAY_CAPTION = (
    "Space or the button plays, drag the bar to scrub, the field at its right is the speed; drag the "
    "picture to turn it. Orange arrows: contact forces. Diamonds: next footholds. Red ball: planned "
    "centre of mass, on the ground. Pink: PSP vertices, a stick as tall as the vertex's weight. "
    "Blue: terrain plane as estimated. The tree button shows and hides each of them."
)


def section(title: str, caption: str, content: str, kind: str = "") -> str:
    return f'<section class="{kind}"><h2>{escape(title)}</h2><p>{escape(caption)}</p>{content}</section>'


def page(runs: list[Run]) -> str:
    """The report as an HTML document."""
    drawn = figures.all_figures(runs)
    plots = "".join(
        section(title, caption, f'<div class="plot" id="figure-{i}"></div>')
        for i, (title, caption, _) in enumerate(drawn)
    )
    data = ",".join(figure.to_json() for _, _, figure in drawn)
    differences = summary.differences(runs)
    frame = f'<iframe title="3D replay" srcdoc="{escape(replay.page(runs))}"></iframe>'
    parts = {
        "title": escape(f"pirouette: {', '.join(run.name for run in runs)}"),
        "notices": summary.notices(runs),
        "measured": summary.measured(runs),
        "replay": section("Replay", REPLAY_CAPTION, frame, "replay"),
        "figures": plots,
        "settings": summary.settings(runs),
        "differences": differences
        and section("Where the runs differ", "Keys of run.toml.", differences),
        "plotly": get_plotlyjs(),
        "data": f"[{data}]".replace("</", "<\\/"),
    }
    template = files(__name__).joinpath("page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], template)


def default_file(folders: list[Path]) -> Path:
    """report.html in the run folder; of several runs in the folder that holds them all."""
    if len(folders) == 1:
        return folders[0] / "report.html"
    return Path(os.path.commonpath([folder.resolve() for folder in folders])) / "report.html"


def write(folders: list[Path], out: Path | None) -> Path:
    """Reads the runs, writes their report, returns its path. Raises RunError."""
    runs = [load(folder) for folder in folders]
    out = out or default_file(folders)
    with command.whole_file(out) as part:
        part.write_text(page(runs), encoding="utf-8")
    return out


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="pirouette report", description="Writes one HTML file about one run or several."
    )
    parser.add_argument("runs", type=Path, nargs="+", metavar="RUN", help="run folder")
    parser.add_argument("--out", type=Path, metavar="FILE", help="file to write [RUN/report.html]")
    arguments = parser.parse_args()
    return command.run(lambda: print(write(arguments.runs, arguments.out)))
