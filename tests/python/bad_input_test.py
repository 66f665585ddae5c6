"""What is wrong with a run is said in one line, and nothing is left half-made."""

import json
import os
import subprocess
import sys

import pytest
from conftest import ROOT


def cut(run):
    file = run / "trace.npy"
    file.write_bytes(file.read_bytes()[:-1000])
    return file


def not_numpy(run):
    (run / "trace.npy").write_text("not an array")
    return run / "trace.npy"


def newer(run):
    file = run / "metrics.json"
    metrics = json.loads(file.read_text())
    metrics["context"]["version"] = "99.0.0"
    file.write_text(json.dumps(metrics))
    return file


def broken_json(run):
    (run / "metrics.json").write_text("{")
    return run / "metrics.json"


def broken_toml(run):
    (run / "run.toml").write_text("robot = ")
    return run / "run.toml"


def unknown_robot(run):
    file = run / "run.toml"
    file.write_text(file.read_text().replace('robot = "mini_cheetah"', 'robot = "nobody"'))
    return file


def no_trace(run):
    (run / "trace.npy").unlink()
    return run


def cut_ground(run):
    file = run / "terrain.npy"
    file.write_bytes(file.read_bytes()[:-1000])
    return file


def no_folder(run):
    return run.rename(run.with_name("elsewhere")) and run


@pytest.mark.parametrize("module", [["report"], ["export", "--mcap"]], ids=["report", "export"])
@pytest.mark.parametrize(
    ("harm", "reason"),
    [
        (cut, "is cut"),
        (not_numpy, "is cut or no NumPy file"),
        (newer, "99.0.0, newer than this program"),
        (broken_json, "is no JSON"),
        (broken_toml, "is no TOML"),
        (unknown_robot, "robot 'nobody' not found"),
        (no_trace, "is no run folder, trace.npy missing"),
        (cut_ground, "is cut"),
        (no_folder, "is no folder"),
    ],
)
def test_names_the_file_and_what_is_wrong(call, own_run, module, harm, reason):
    culprit = harm(own_run)
    before = set(own_run.glob("*"))
    result = call(module[0], own_run, *module[1:])
    assert result.returncode == 2
    assert result.stderr.startswith(f"error: {culprit}: ")
    assert reason in result.stderr
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert set(own_run.glob("*")) == before


def test_an_old_report_survives_a_failure(call, own_run):
    (own_run / "report.html").write_text("old")
    cut(own_run)
    assert call("report", own_run).returncode == 2
    assert (own_run / "report.html").read_text() == "old"


def test_output_into_no_folder_is_refused(call, own_run, tmp_path):
    result = call("export", own_run, "--csv", tmp_path / "nowhere" / "trace.csv")
    assert result.returncode == 2
    assert "there is no folder" in result.stderr
    assert not (tmp_path / "nowhere").exists()


def test_a_picture_that_cannot_be_written_leaves_no_report(call, own_run, tmp_path):
    result = call("report", own_run, "--picture", tmp_path / "nowhere" / "run.png")
    assert result.returncode == 2
    assert "there is no folder" in result.stderr
    assert not (own_run / "report.html").exists()


def test_a_missing_renderer_is_one_clear_error(own_run, tmp_path):
    out = tmp_path / "run.mp4"
    result = subprocess.run(
        [sys.executable, "-m", "pirouette.export", own_run, "--video", out],
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": str(ROOT / "python"), "MUJOCO_GL": "disable"},
    )
    assert result.returncode == 2
    assert result.stderr.startswith("error: MUJOCO_GL=disable: ")
    assert "allowed: egl" in result.stderr
    assert list(tmp_path.glob("*.mp4")) == []
