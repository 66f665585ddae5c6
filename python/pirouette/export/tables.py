"""The trace as a flat table: CSV or Parquet."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet

from pirouette.run_folder import LEGS, Run


def flat_columns(trace: np.ndarray) -> dict[str, np.ndarray]:
    """One column a number: foot_position_FR_0 is x of the right front foot, com_plan_1 is y."""
    columns = {}
    for name in trace.dtype.names:
        values = trace[name]
        for index in np.ndindex(values.shape[1:]):
            per_leg = len(index) > 0 and values.shape[1] == len(LEGS)
            parts = [LEGS[index[0]], *index[1:]] if per_leg else index
            key = "_".join([name, *map(str, parts)])
            columns[key] = np.ascontiguousarray(values[(slice(None), *index)])
    return columns


def table(run: Run) -> pa.Table:
    """The whole trace; run.toml and metrics.json are in the table's metadata."""
    texts = {name: (run.folder / name).read_bytes() for name in ("run.toml", "metrics.json")}
    return pa.table(flat_columns(run.trace)).replace_schema_metadata(texts)


def write_csv(run: Run, file: Path) -> None:
    pyarrow.csv.write_csv(table(run), file)


def write_parquet(run: Run, file: Path) -> None:
    pyarrow.parquet.write_table(table(run), file, compression="zstd")
