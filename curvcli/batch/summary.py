"""Summary: one row per mesh, in the order of the plan, without values that differ between equal runs."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import IO, Any, cast, get_type_hints

import polars as pl

from ..output.atomic import Outputs
from ..report.model import Topology
from ..support.forks import require_threads
from ..support.memory import require_polars
from ..support.words import escape_cell
from .model import CSV, PARQUET, Row


def write_summary(folder: str, rows: Sequence[Row]) -> None:
    """Write `summary.csv` and `summary.parquet`, whole or not at all; equal rows give equal bytes.

    Columns: path, status, exit_code, error, then topology, totals and checks under their names in the report.
    Errors: OutputError for a folder that cannot be written.
    """
    require_threads()
    require_polars(1024 * len(rows))
    table = frame(rows)
    paths = [os.path.join(folder, name) for name in (CSV, PARQUET)]
    with Outputs(paths, force=True) as outputs:
        with outputs.open(paths[0]) as stream:
            text_columns = [name for name, dtype in table.schema.items() if dtype == pl.String]
            safe = [
                pl.Series(name, [word and escape_cell(word) for word in table[name]], pl.String)
                for name in text_columns
            ]
            table.with_columns(safe).write_csv(cast("IO[bytes]", stream))
        with outputs.open(paths[1]) as stream:
            table.write_parquet(cast("IO[bytes]", stream))


def frame(rows: Sequence[Row]) -> pl.DataFrame:
    """Rows as a table; missing and undefined values are null."""
    columns: dict[str, pl.Series] = {
        name: pl.Series(name, [getattr(row, name) for row in rows], dtype)
        for name, dtype in (("path", pl.String), ("status", pl.String), ("exit_code", pl.Int64), ("error", pl.String))
    }
    for name, hint in get_type_hints(Topology).items():
        dtype = pl.Boolean if hint is bool else pl.Int64
        columns[f"topology.{name}"] = pl.Series([row.topology.get(name) for row in rows], dtype=dtype)
    flat = [_totals(row) for row in rows]
    for name in _names(flat):
        columns[f"totals.{name}"] = pl.Series([totals.get(name) for totals in flat], dtype=pl.Float64)
    for name in _names(row.checks for row in rows):
        each = [row.checks.get(name, {}) for row in rows]
        columns[f"checks.{name}.status"] = pl.Series([check.get("status") for check in each], dtype=pl.String)
        columns[f"checks.{name}.residual"] = pl.Series([check.get("residual") for check in each], dtype=pl.Float64)
    return pl.DataFrame([series.alias(name) for name, series in columns.items()])


def _totals(row: Row) -> dict[str, Any]:
    """Totals, vectors by their components."""
    totals: dict[str, Any] = {}
    for name, value in row.totals.items():
        if isinstance(value, list):
            totals |= {f"{name}_{axis}": part for axis, part in zip("xyz", value, strict=True)}
        else:
            totals[name] = value
    return totals


def _names(rows: Iterable[dict[str, Any]]) -> list[str]:
    """Every key, in the order of the rows."""
    return list(dict.fromkeys(name for row in rows for name in row))
