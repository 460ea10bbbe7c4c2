"""Reader of vertex tables written by curvcli."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from ..support.forks import require_threads
from ..support.memory import require_polars
from ..support.words import unescape_cell
from .content import free_inflation, open_regular, read_limited, too_large
from .parquet import check_parquet

SUFFIXES = (".csv", ".tsv", ".parquet", ".jsonl")


def read_stored_table(path: str, *, max_bytes: int | None = None) -> dict[str, NDArray[Any]]:
    """Read a vertex table in one of the formats above: columns of float64 (NaN is null) or strings (None is null).

    Errors: InputError for a file that is missing, no table, or no vertex table of curvcli.
    """
    try:
        with open_regular(path, max_bytes) as file:
            data = read_limited(file, max_bytes, "a table")
        return _columns(data, os.path.splitext(path)[1].lower(), max_bytes)
    except InputError as error:
        error.path = path
        raise


def _columns(data: bytes, suffix: str, max_bytes: int | None) -> dict[str, NDArray[Any]]:
    require_threads()
    require_polars(len(data))
    import polars as pl
    from polars.exceptions import PolarsError

    limit = max_bytes if max_bytes is not None else free_inflation(len(data))
    hint = "`curvcli analyze MESH -o TABLE.csv` writes one"
    try:
        if suffix == ".parquet":
            check_parquet(data, limit)
            frame = pl.read_parquet(data)
        elif suffix == ".jsonl":
            _check_keys(data)
            frame = pl.read_ndjson(data, infer_schema_length=None)
        else:
            separator = "\t" if suffix == ".tsv" else ","
            _check_rows(data, separator.encode())
            frame = pl.read_csv(data, separator=separator, infer_schema_length=None)
    except (PolarsError, OSError) as error:
        reason = str(error).strip().partition("\n")[0]
        raise InputError(f"cannot be read as a table: {reason}", hint=hint) from None
    if "vertex" not in frame.columns:
        headers = ", ".join(frame.columns[:8])
        raise InputError(f"no column `vertex` found among {headers}; a vertex table expected", hint=hint)
    if not (frame["vertex"].dtype.is_integer() and (frame["vertex"] == np.arange(frame.height)).all()):
        raise InputError(
            "column `vertex` is not 0, 1, 2, …; a vertex table in the order of its file expected", hint=hint
        )
    found_columns: dict[str, NDArray[Any]] = {}
    for series in frame.drop("vertex").iter_columns():
        if series.dtype.is_numeric() or series.dtype in (pl.Boolean, pl.Null) or series.null_count() == len(series):
            found_columns[series.name] = series.cast(pl.Float64).fill_null(float("nan")).to_numpy()
        else:
            texts = series.cast(pl.String)
            if (size := int(texts.str.len_bytes().sum())) > limit:
                raise too_large(f"column `{series.name}` of {size} bytes", limit)
            if suffix in (".csv", ".tsv") and texts.str.starts_with("'").any():
                texts = pl.Series([None if word is None else unescape_cell(word) for word in texts], dtype=pl.String)
            found_columns[series.name] = texts.to_numpy()
    return found_columns


def _check_keys(data: bytes) -> None:
    """Raise InputError for rows with other keys than the first: null cells could outnumber the bytes of the file."""
    import msgspec

    try:
        first = msgspec.json.decode(data.partition(b"\n")[0], type=dict[str, float | str | bool | None])
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise InputError(f"no JSON object found ({error})", place="line 1") from None
    if data.count(b'":') > sum(data.count(msgspec.json.encode(key) + b":") for key in first):
        raise InputError("rows with other keys than the first found, the same in every row expected")


def _check_rows(data: bytes, separator: bytes) -> None:
    """Raise InputError for rows that mostly lack cells: null cells could outnumber the bytes of the file many times."""
    cells = data.count(separator)
    columns = data.partition(b"\n")[0].count(separator)
    rows = data.count(b"\n")
    if rows * columns > 2 * cells + len(data):
        raise InputError(f"{rows} rows of {columns + 1} columns, but only {cells} separators found", hint="whole rows")
