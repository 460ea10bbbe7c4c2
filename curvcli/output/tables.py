"""Columns to a table file: text that reads back to the same doubles, empty cells where nothing is defined."""

from __future__ import annotations

import io
from collections.abc import Mapping
from threading import Event
from typing import IO, Any, BinaryIO, TypeAlias, cast

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ..errors import OutputError, UsageError
from ..loading.model import Labels

Column: TypeAlias = NDArray[Any] | Labels

SHORTEST = "shortest"
_SEPARATORS = {".csv": ",", ".tsv": "\t"}
# Rows that polars formats at a time: 4 times faster than its default of 1024, still small beside the table.
_ROWS_AT_A_TIME = 8192


def write_table(
    stream: BinaryIO,
    columns: Mapping[str, Column],
    suffix: str,
    *,
    precision: str | int = SHORTEST,
    stop: Event | None = None,
) -> None:
    """Write equally long columns as `.csv`, `.tsv`, `.parquet` or `.npz` to any binary stream.

    columns: float64 (NaN is null), integers, booleans, masked integers (masked is null), or Labels (-1 is null).
    precision: of the text formats; `shortest` reads back to the same double, N rounds to N significant digits.
    stop: ends the writing of text and Parquet half-way once another thread has set it.
    Null is an empty cell in text, null in Parquet, and NaN in npz, where Labels become codes and `NAME_names`.
    Errors: UsageError for a precision outside 1..17.
    """
    if suffix == ".npz":
        _write_npz(stream, columns)
        return
    digits = parse_precision(precision)
    frame = pl.DataFrame([_series(name, column) for name, column in columns.items()])
    relay = _Relay(stream, stop)
    try:
        if suffix == ".parquet":
            frame.write_parquet(cast("IO[bytes]", relay))
        else:
            text = frame if digits is None else frame.with_columns(_rounded(frame, digits))
            text.write_csv(cast("IO[bytes]", relay), separator=_SEPARATORS[suffix], batch_size=_ROWS_AT_A_TIME)
    except Exception:
        # polars words the failure of a stream in its own way; what the stream raised says more.
        if relay.failure is not None:
            raise relay.failure from None
        raise


def parse_precision(precision: str | int) -> int | None:
    """The number of significant digits meant by `--precision`, None for the shortest exact text."""
    if precision == SHORTEST:
        return None
    try:
        digits = int(precision)
    except ValueError:
        digits = 0
    if not 1 <= digits <= 17:
        raise UsageError(f"--precision {precision}: expected `{SHORTEST}` or a number of digits from 1 to 17")
    return digits


class _Relay(io.RawIOBase):
    """Hands bytes on and remembers what went wrong, which polars would turn into words of its own."""

    def __init__(self, stream: BinaryIO, stop: Event | None):
        self.stream, self.stop = stream, stop
        self.failure: BaseException | None = None

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        try:
            if self.stop is not None and self.stop.is_set():
                raise InterruptedError("told to stop")
            return self.stream.write(data)
        except BaseException as failure:
            self.failure = failure
            raise

    def flush(self) -> None:
        """The stream's owner flushes it."""


def _series(name: str, column: Column) -> pl.Series:
    """The column for polars without a copy: what is null is told by a mask beside the values."""
    if isinstance(column, Labels):
        unique = len(set(column.names)) == len(column.names)
        names = pl.Series(name, column.names, dtype=pl.Enum(column.names) if unique else pl.String)
        codes = pl.Series(np.ascontiguousarray(column.codes))
        return names.gather(codes.set(codes < 0, None))
    values = np.ascontiguousarray(np.ma.getdata(column))
    values = values.astype(values.dtype.newbyteorder("="), copy=False)
    series = pl.Series(name, values, nan_to_null=True)
    if isinstance(column, np.ma.MaskedArray):
        series = series.set(pl.Series(np.ma.getmaskarray(column)), None)
    return series


def _rounded(frame: pl.DataFrame, digits: int) -> list[pl.Series]:
    """The float columns at `digits` significant digits, rounded in decimal and so written without a long tail."""
    rounded = []
    for series in frame.iter_columns():
        if series.dtype != pl.Float64:
            continue
        text = io.BytesIO()
        full = series.fill_null(0.0).to_frame()
        full.write_csv(text, include_header=False, float_scientific=True, float_precision=digits - 1)
        near = pl.read_csv(text.getvalue(), has_header=False, schema={series.name: pl.Float64})[series.name]
        # The largest doubles may round past the range; they stay as they are.
        near = near.zip_with(near.is_finite(), full[series.name])
        rounded.append(near.set(series.is_null(), None))
    return rounded


def _write_npz(stream: BinaryIO, columns: Mapping[str, Column]) -> None:
    arrays: dict[str, NDArray[Any]] = {}
    for name, column in columns.items():
        if isinstance(column, Labels):
            arrays[name] = column.codes
            arrays[f"{name}_names"] = _names(name, column.names)
        elif isinstance(column, np.ma.MaskedArray):
            arrays[name] = np.where(np.ma.getmaskarray(column), np.nan, np.ma.getdata(column))
        else:
            arrays[name] = np.asarray(column)
    np.savez(stream, allow_pickle=False, **arrays)


def _names(column: str, names: tuple[str, ...]) -> NDArray[np.str_]:
    """The names as one unicode array, refused where one long name would make all of them long."""
    longest = max(map(len, names), default=0)
    if longest * len(names) > 2**20 + 8 * sum(map(len, names)):
        raise OutputError(f"{column}: a name of {longest} characters does not fit an .npz table; .parquet holds it")
    return np.array(names, dtype=np.str_)
