"""The report as one HTML page."""

import re
from html import escape
from importlib.resources import files

from plotly.offline import get_plotlyjs

from pirouette.report import figures, replay, summary
from pirouette.run_folder import Run

REPLAY_CAPTION = (
    "Space or the button plays, drag the bar to scrub, the field at its right is the speed; drag the "
    "picture to turn it. Yellow arrows: contact forces. Green diamonds: next footholds. Red ball: planned "
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
        "headlines": summary.headlines(runs),
        "measured": summary.measured(runs),
        "replay": section("Replay", REPLAY_CAPTION, frame, "replay"),
        "figures": plots,
        "settings": summary.settings(runs),
        "differences": differences
        and section("Where the runs differ", "Keys of run.toml.", differences),
        "plotly": get_plotlyjs(),
        "data": f"[{data}]".replace("</", "<\\/"),
    }
    template = files(__package__).joinpath("page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], template)
