"""Plots of reproduced figures: from a short run of the experiments of uneven ground."""

import json
import shutil
import subprocess

import numpy as np
import pytest
from conftest import PROGRAM, ROOT

from pirouette.plot_parts import relative_attitude


SHORT = "run.turns = 0.05\nrun.settle_time = 0.1\ngait.stand_time = 0.2"


@pytest.fixture(scope="module")
def reproduced(tmp_path_factory):
    """A folder with one for each of the experiments as they are, only short."""
    folder = tmp_path_factory.mktemp("reports")
    for figure in ("fig9", "fig10"):
        text = (ROOT / "experiments" / f"{figure}.toml").read_text()
        assert "run.turns = 10.0" in text
        file = folder / f"{figure}.toml"
        file.write_text(text.replace("run.turns = 10.0", SHORT))
        subprocess.run(
            [PROGRAM, "sweep", file, "--seeds", "1", "--out", folder / figure],
            check=True,
            capture_output=True,
        )
    return folder


@pytest.mark.parametrize("figure", ["fig9", "fig10"])
def test_draws_the_figures_of_uneven_ground(reproduced, call, tmp_path, figure):
    folder = tmp_path / "reports"
    folder.mkdir()
    report = json.loads((reproduced / figure / f"{figure}.json").read_text())
    for entry in report["entries"]:
        entry["label"] += r" $\nosuch{$"  # is no formula
    (folder / f"{figure}.json").write_text(json.dumps(report))
    shutil.copytree(reproduced / figure / "traces", folder / "traces")
    done = call("plots", folder)
    assert done.returncode == 0, done.stderr
    assert (folder / f"{figure}.svg").stat().st_size > 10_000
    assert (folder / f"{figure}.png").stat().st_size > 10_000


def test_a_trunk_parallel_to_the_plane_has_no_relative_attitude():
    slope = 0.3
    yaw = np.linspace(0.0, 6.0, 7)
    # Uphill along x: a trunk that climbs (yaw 0) pitches its nose up, which is negative.
    normal = np.array([-np.sin(slope), 0.0, np.cos(slope)])
    x = np.cos(yaw) * normal[0]
    y = -np.sin(yaw) * normal[0]
    roll, pitch = np.arcsin(-y), np.arctan2(x, normal[2])
    relative = relative_attitude(np.stack([roll, pitch, yaw], axis=1), normal)
    np.testing.assert_allclose(relative, 0.0, atol=1e-12)
    level = relative_attitude(np.zeros((1, 3)), normal)
    np.testing.assert_allclose(np.ravel(level), [0.0, slope], atol=1e-12)
