"""A damaged run folder gives one line that names the file, never a traceback."""

import json
import re
import shutil

import numpy as np
import pytest

from pirouette import command, report
from pirouette.run_folder import FILES


def replaced(name, content):
    return lambda run: (run / name).write_bytes(content)


def cut(name, length):
    return lambda run: (run / name).write_bytes((run / name).read_bytes()[:length])


def a_folder(name):
    def damage(run):
        (run / name).unlink()
        (run / name).mkdir()

    return damage


def metric(key, value):
    def damage(run):
        content = json.loads((run / "metrics.json").read_text())
        table = content
        *groups, last = key.split(".")
        for group in groups:
            table = table[group]
        table[last] = value
        (run / "metrics.json").write_text(json.dumps(content))

    return damage


def setting(key, text):
    def damage(run):
        content = (run / "run.toml").read_text()
        changed = re.sub(rf"(?m)^{key} = [^#\n]*", f"{key} = {text} ", content, count=1)
        assert changed != content
        (run / "run.toml").write_text(changed)

    return damage


def array(name, change):
    def damage(run):
        np.save(run / name, change(np.load(run / name)))

    return damage


def column(name, value):
    def change(trace):
        trace[name] = value
        return trace

    return array("trace.npy", change)


def retyped(name, dtype):
    def change(trace):
        fields = [(n, dtype if n == name else trace.dtype[n]) for n in trace.dtype.names]
        out = np.zeros(len(trace), fields)
        for other in set(trace.dtype.names) - {name}:
            out[other] = trace[other]
        return out

    return array("trace.npy", change)


JUNK = bytes(range(256)) * 8
HUGE = (
    b"\x93NUMPY\x01\x00v\x00"
    + b"{'descr': '<f8', 'fortran_order': False, 'shape': (999999999999, 99999), }".ljust(117)
    + b"\n"
)
DAMAGES = {
    **{f"no {name}": (lambda run, n=name: (run / n).unlink()) for name in FILES},
    **{f"{name} is a folder": a_folder(name) for name in FILES},
    **{f"{name} is empty": replaced(name, b"") for name in FILES},
    **{f"{name} is junk": replaced(name, JUNK) for name in FILES},
    **{f"{name} is cut": cut(name, 100) for name in FILES},
    "trace.npy is cut in a row": cut("trace.npy", -7),
    "trace.npy is larger than memory": replaced("trace.npy", HUGE),
    "terrain.npy is larger than memory": replaced("terrain.npy", HUGE),
    "trace.npy is plain numbers": array("trace.npy", lambda trace: trace["time"]),
    "trace.npy has no rows": array("trace.npy", lambda trace: trace[:0]),
    "trace.npy has one row": array("trace.npy", lambda trace: trace[:1]),
    "trace.npy has two axes": array("trace.npy", lambda trace: trace[:4].reshape(2, 2)),
    "trace.npy is backwards": array("trace.npy", lambda trace: trace[::-1]),
    "time is no number": column("time", np.nan),
    "time stands still": column("time", 1.0),
    "a column of texts": retyped("true_rpy", "U5"),
    "a column of another shape": retyped("true_rpy", ("f8", 2)),
    "a column of whole numbers": retyped("true_com_position", ("i8", 3)),
    "metrics.json is a list": replaced("metrics.json", b"[]"),
    "metrics.json is a number": replaced("metrics.json", b"7"),
    "metrics.json is deep": replaced("metrics.json", b"[" * 100_000),
    "context is a text": metric("context", "flat"),
    "version is a table": metric("context.version", {}),
    "version is no version": metric("context.version", "new"),
    "point is a text": metric("context.point_x", "here"),
    "terrain is a number": metric("context.terrain", 3),
    "terrain is half a text": metric("context.terrain", "stairs:high"),
    "terrain is infinite": metric("context.terrain_half_extent_m", float("inf")),
    "terrain is negative": metric("context.terrain_half_extent_m", -1.0),
    "terrain extent is a text": metric("context.terrain_half_extent_m", "wide"),
    "a metric is a list": metric("com.radius_mean_mm", [1, 2]),
    "a metric is a table": metric("com.radius_mean_mm", {"a": 1}),
    "run.toml is a list": replaced("run.toml", b"gait = []\nrun = []\nrobot = 'go1'\n"),
    "stand_time is a text": setting("stand_time", '"a second"'),
    "stand_time is infinite": setting("stand_time", "inf"),
    "settle_time is negative": setting("settle_time", "-5.0"),
    "settle_time is true": setting("settle_time", "true"),
    "robot is a number": setting("robot", "7"),
    "robot is unknown": setting("robot", '"nobody"'),
    "heights are texts": array("terrain.npy", lambda heights: heights.astype("U4")),
    "heights are no numbers": array("terrain.npy", lambda heights: heights * np.nan),
    "heights have one axis": array("terrain.npy", lambda heights: heights[0]),
}


@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES.keys())
def test_one_line_names_the_file(damage, spin_folder, tmp_path, capsys):
    run = tmp_path / "run"
    shutil.copytree(spin_folder, run)
    damage(run)
    code = command.run(lambda: report.write([run], None))
    said = capsys.readouterr().err
    assert code == command.BAD_USAGE
    assert said.startswith(f"error: {run}")
    assert said.count("\n") == 1
    assert not (run / "report.html").exists()
