"""Long table of a batch: a row per mesh, region, column and statistic, in the order of the plan."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..mesh.file import Labels
from ..output.atomic import Outputs
from ..output.tables.write import write_table
from ..support.arrays import Index
from ..support.memory import require_polars
from .model import STATISTICS, Row

KEYS = ("mesh", "region", "column", "statistic")


def write_statistics(folder: str, rows: Sequence[Row]) -> None:
    """Write `statistics.csv` and `.parquet`, whole or not at all; equal rows give equal bytes.

    Columns: mesh, region (null for the whole surface), column (also the key of a total), statistic, value. Undefined
    values are null. Meshes without a result have no row.
    Errors: OutputError for a folder that cannot be written.
    """
    table = long_table(rows)
    require_polars(64 * len(table["value"]))
    paths = [os.path.join(folder, name) for name in STATISTICS]
    with Outputs(paths, force=True) as outputs:
        for path in paths:
            with outputs.open(path) as stream:
                write_table(stream, table, os.path.splitext(path)[1])


def long_table(rows: Sequence[Row]) -> dict[str, Any]:
    """The rows as columns of a table."""
    names: dict[str, dict[str, int]] = {key: {} for key in KEYS}
    codes: dict[str, list[int]] = {key: [] for key in KEYS}
    values: list[float] = []
    for row in rows:
        for part in row.statistics:
            for column, statistics in part.columns.items():
                for statistic, value in statistics.items():
                    for key, name in zip(KEYS, (row.path, part.region, column, statistic), strict=True):
                        codes[key].append(-1 if name is None else names[key].setdefault(name, len(names[key])))
                    values.append(np.nan if value is None else float(value))
    table: dict[str, Any] = {key: Labels(_index(codes[key]), tuple(names[key])) for key in KEYS}
    return table | {"value": np.array(values, np.float64)}


def _index(codes: list[int]) -> Index:
    return np.array(codes, np.int32)
