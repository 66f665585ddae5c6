"""The table of a sweep with the types of its columns."""

import csv
from pathlib import Path

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet

from pirouette.run_folder import RunError

TEXTS, COUNTS = ("key", "row"), ("trial", "seed")


def column_types(names: list[str]) -> dict[str, pa.DataType]:
    """Metrics, which stand behind the seed, are numbers even where none is known; a key is a text
    even where all its digits are decimal. Axes are what their values look like."""
    metrics = names[names.index("seed") + 1 :]
    return (
        dict.fromkeys(metrics, pa.float64())
        | dict.fromkeys(TEXTS, pa.string())
        | dict.fromkeys(COUNTS, pa.int64())
    )


def read_table(file: Path) -> pa.Table:
    """A row for each trial, as in `file`. Raises RunError."""
    with file.open(newline="") as stream:
        names = next(csv.reader(stream), [])
    if missing := [name for name in (*COUNTS, *TEXTS) if name not in names]:
        raise RunError(f"{file}: is no table of trials, it has no column {', '.join(missing)}")
    convert = pyarrow.csv.ConvertOptions(column_types=column_types(names))
    parse = pyarrow.csv.ParseOptions(newlines_in_values=True)
    try:
        return pyarrow.csv.read_csv(file, parse_options=parse, convert_options=convert)
    except pa.ArrowInvalid as error:
        raise RunError(f"{file}: {error}") from None


def write_parquet(table: Path, file: Path) -> None:
    pyarrow.parquet.write_table(read_table(table), file, compression="zstd")
