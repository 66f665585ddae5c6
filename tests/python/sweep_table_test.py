"""The table of a sweep as Parquet."""

import subprocess

import numpy as np
import pyarrow as pa
import pyarrow.parquet
import pytest
from conftest import PROGRAM, QUICK_TRIALS

from pirouette.export import write
from pirouette.export.study import read_table
from pirouette.run_folder import RunError

EXPERIMENT = f"""
seeds = [1, 2]
{QUICK_TRIALS}
[[rows]]
label = 'a "quoted", label'
controller = "asc"
[[axes]]
key = "plant.friction"
values = [0.6, 0.8]
[[axes]]
key = "plant.terrain"
values = ["flat", "slope:5"]
"""


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweep")
    (folder / "tiny.toml").write_text(EXPERIMENT)
    subprocess.run(
        [PROGRAM, "sweep", "tiny.toml", "--out", "out"], cwd=folder, check=True, capture_output=True
    )
    return folder / "out"


def test_parquet_holds_every_cell_with_its_type(sweep, tmp_path):
    file = write(sweep, "parquet", tmp_path / "table.parquet")
    table = pyarrow.parquet.read_table(file)
    assert table.equals(read_table(sweep / "table.csv"))
    assert table.num_rows == 8
    assert table.column_names[:6] == [
        "trial",
        "key",
        "row",
        "plant.friction",
        "plant.terrain",
        "seed",
    ]
    assert table["row"].to_pylist() == ['a "quoted", label'] * 8
    assert table["plant.terrain"].to_pylist()[:4] == ["flat", "flat", "slope:5", "slope:5"]
    assert table["plant.friction"].type == pa.float64()
    assert table["key"].type == pa.string()
    # Absent everywhere, as a spin follows no path: a number all the same.
    assert table["path.cross_track_mean_mm"].type == pa.float64()
    assert table["path.cross_track_mean_mm"].null_count == 8
    assert np.all(np.array(table["com.radius_mean_mm"]) > 0.0)


def test_parquet_is_the_same_bytes_each_time(sweep, tmp_path):
    first, second = (write(sweep, "parquet", tmp_path / name) for name in ("first", "second"))
    assert first.read_bytes() == second.read_bytes()


def test_it_lies_beside_the_table_and_other_formats_are_refused(sweep, call):
    result = call("export", sweep, "--parquet")
    assert result.stdout.strip() == str(sweep / "table.parquet")
    refused = call("export", sweep, "--mcap")
    assert refused.returncode == 2
    assert "holds the table.csv of a sweep; allowed: --parquet" in refused.stderr


def test_a_table_of_something_else_is_refused(tmp_path):
    (tmp_path / "table.csv").write_text("time,height\n0,1\n")
    with pytest.raises(RunError, match="no column trial, seed, key, row"):
        write(tmp_path, "parquet", None)
