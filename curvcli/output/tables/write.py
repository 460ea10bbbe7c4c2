"""Table writers: text that reads back to the same doubles, empty cells for undefined values."""

from __future__ import annotations

import io
import os
import re
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from threading import Event
from typing import IO, Any, BinaryIO, TypeAlias, cast

import numpy as np
import polars as pl
from numpy.typing import NDArray
from polars.io.plugins import register_io_source

from ...errors import InputError, OutputError, UsageError
from ...mesh.file import Labels
from ...support.forks import require_threads, threads_lost
from ...support.words import escape_cell
from ..meshes.names import fitting
from ..meshes.text import joined
from ..registry import TableFormat, output_formats
from .columns import ROWS_IN_A_FRAME

Column: TypeAlias = NDArray[Any] | Labels

SHORTEST = "shortest"
# Limit on the characters of all names in a column of text, and of each row on average.
_NAMES, _NAME = 1 << 24, 256


def write_table(
    stream: BinaryIO,
    columns: Mapping[str, Column],
    suffix: str,
    *,
    precision: str | int = SHORTEST,
    stop: Event | None = None,
) -> None:
    """Write equally long columns to any binary stream, in the format of the suffix.

    columns: float64 (NaN is null), integers, booleans, masked integers (masked is null), or Labels (-1 is null).
    precision: of the text formats; `shortest` reads back to the same double, N rounds to N significant digits.
    stop: ends the writing of text and Parquet early once another thread has set it.
    Null is an empty cell in text, null in Parquet, and NaN in npz, where Labels become codes and `NAME_names`.
    Words that a spreadsheet would compute get an apostrophe in text, see `in_cell`.
    Errors: UsageError for a precision outside 1..17.
    """
    format = output_formats()[suffix]
    assert isinstance(format, TableFormat)
    format.write(stream, columns, precision, stop)


def write_text(
    stream: BinaryIO, columns: Mapping[str, Column], separator: str, precision: str | int, stop: Event | None
) -> None:
    """Write columns as text with this separator; see `write_table`."""
    digits = parse_precision(precision)
    with _relayed(stream, stop) as relay:
        _write_text(_regular(stream) or relay, columns, separator, digits, stop)


def write_parquet(stream: BinaryIO, columns: Mapping[str, Column], precision: str | int, stop: Event | None) -> None:
    """Write columns as Parquet; see `write_table`."""
    parse_precision(precision)
    with _relayed(stream, stop) as relay:
        _write_parquet(relay, columns)


def write_json_lines(stream: BinaryIO, columns: Mapping[str, Column], precision: str | int, stop: Event | None) -> None:
    """Write columns as JSON objects, one line each; see `write_table`."""
    digits = parse_precision(precision)
    require_threads()
    _check_names(columns)
    with _relayed(stream, stop) as relay:
        for frame in _frames(columns):
            if stop is not None and stop.is_set():
                raise InterruptedError("stopped")
            finite = frame.with_columns(pl.col(pl.Float64).replace([np.inf, -np.inf], None))
            rows = finite if digits is None else finite.with_columns(_rounded(finite, digits))
            rows.write_ndjson(cast("IO[bytes]", relay))


@contextmanager
def _relayed(stream: BinaryIO, stop: Event | None) -> Iterator[_Relay]:
    """A stream for polars. Errors: those of the stream or of the system, not those that polars makes of them."""
    relay = _Relay(stream, stop)
    try:
        yield relay
    except Exception as error:
        # polars rewords the error of a stream; the original error of the stream or the system says more.
        if relay.failure is not None:
            raise relay.failure from None
        number = re.search(r"\(os error (\d+)\)$", str(error))
        if number and os.name == "posix":  # on other systems the numbers are not errno
            raise OSError(int(number[1]), os.strerror(int(number[1]))) from None
        raise


def _regular(stream: BinaryIO) -> io.FileIO | None:
    """The regular file behind a stream, if there is one.

    polars writes to it without a copy in Python and without the interpreter lock, which the writer of a mesh needs at
    the same time.
    """
    raw = getattr(stream, "raw", None)
    if not isinstance(raw, io.FileIO) or not stat.S_ISREG(os.fstat(raw.fileno()).st_mode):
        return None
    stream.flush()
    return raw


def _write_text(
    to: io.RawIOBase, columns: Mapping[str, Column], separator: str, digits: int | None, stop: Event | None
) -> None:
    _check_names(columns)
    for number, frame in enumerate(_frames(_for_spreadsheets(columns))):
        if stop is not None and stop.is_set():
            raise InterruptedError("stopped")
        if threads_lost():
            to.write(_text(frame, separator, digits, header=not number))
            continue
        text = frame if digits is None else frame.with_columns(_rounded(frame, digits))
        text.write_csv(cast("IO[bytes]", to), separator=separator, include_header=not number)


def _for_spreadsheets(columns: Mapping[str, Column]) -> Mapping[str, Column]:
    """Columns with words and headers that no spreadsheet takes for formulas."""
    heads = fitting(columns, escape_cell)
    return {heads[name]: _in_cells(column) for name, column in columns.items()}


def _in_cells(column: Column) -> Column:
    return Labels(column.codes, tuple(map(escape_cell, column.names))) if isinstance(column, Labels) else column


def _text(frame: pl.DataFrame, separator: str, digits: int | None, header: bool) -> bytes:
    """Text of a frame as polars writes it, made without its threads."""
    special = re.compile(f'["\r\n{separator}]|^$')

    def quoted(word: str | None) -> str | None:
        return word if word is None or not special.search(word) else '"' + word.replace('"', '""') + '"'

    columns = dict(zip(frame.columns, frame.iter_columns(), strict=True))
    for name, series in columns.items():
        if series.dtype in (pl.String, pl.Enum):
            columns[name] = pl.Series([quoted(word) for word in series.to_list()], dtype=pl.String)
        elif series.dtype == pl.Float64 and digits is not None:
            near = [x if x is None else float(f"{x:.{digits - 1}e}") for x in series.to_list()]
            columns[name] = pl.Series([x if y is None or np.isinf(y) else y for x, y in zip(series, near, strict=True)])
    first = separator.join(str(quoted(name)) for name in columns) + "\n" if header else ""
    return first.encode() + joined(columns, separator, "\n")


def _check_names(columns: Mapping[str, Column]) -> None:
    """Errors: InputError for names so long that a text column of them is out of proportion to the mesh."""
    for name, column in columns.items():
        if isinstance(column, Labels) and column.names:
            lengths = np.array([len(word) for word in column.names])
            size = int(lengths[column.codes[column.codes >= 0]].sum())
            if size > _NAMES + _NAME * len(column.codes):
                raise InputError(
                    f"{name}: names of up to {lengths.max():,} characters make a column of {size:,}",
                    hint="shorter names, or a table in .parquet or .npz, which hold each once",
                )


def _write_parquet(relay: _Relay, columns: Mapping[str, Column]) -> None:
    require_threads()
    frames = _frames(columns)
    first = next(frames)
    if len(first) == _length(columns):
        first.write_parquet(cast("IO[bytes]", relay))
        return

    def source(*_: object) -> Iterator[pl.DataFrame]:
        yield first
        yield from frames

    lazily = register_io_source(source, schema=first.schema)
    lazily.sink_parquet(cast("IO[bytes]", relay), row_group_size=ROWS_IN_A_FRAME)


def _length(columns: Mapping[str, Column]) -> int:
    return max((len(column.codes if isinstance(column, Labels) else column) for column in columns.values()), default=0)


def _frames(columns: Mapping[str, Column]) -> Iterator[pl.DataFrame]:
    """Table in blocks, since polars copies its input; at least one, however short."""
    for start in range(0, max(_length(columns), 1), ROWS_IN_A_FRAME):
        rows = slice(start, start + ROWS_IN_A_FRAME)
        yield pl.DataFrame([_series(name, _rows(column, rows)) for name, column in columns.items()])


def _rows(column: Column, rows: slice) -> Column:
    return Labels(column.codes[rows], column.names) if isinstance(column, Labels) else column[rows]


def parse_precision(precision: str | int) -> int | None:
    """Number of significant digits of `--precision`, None for the shortest exact text."""
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
    """Pass bytes on and keep the error of the stream, which polars would reword."""

    def __init__(self, stream: BinaryIO, stop: Event | None):
        self.stream, self.stop = stream, stop
        self.failure: BaseException | None = None

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        try:
            if self.stop is not None and self.stop.is_set():
                raise InterruptedError("stopped")
            return self.stream.write(data)
        except BaseException as failure:
            self.failure = failure
            raise

    def flush(self) -> None:
        """Do nothing: the stream's owner flushes it."""


def _series(name: str, column: Column) -> pl.Series:
    """Column for polars; a mask beside the values marks nulls."""
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
    """Float columns at `digits` significant digits, rounded in decimal and so written without a long tail."""
    rounded = []
    for series in frame.iter_columns():
        if series.dtype != pl.Float64:
            continue
        text = io.BytesIO()
        full = series.fill_null(0.0).to_frame()
        full.write_csv(text, include_header=False, float_scientific=True, float_precision=digits - 1)
        near = pl.read_csv(text.getvalue(), has_header=False, schema={series.name: pl.Float64})[series.name]
        # The largest doubles may round to infinity; they stay unchanged.
        near = near.zip_with(near.is_finite(), full[series.name])
        rounded.append(near.set(series.is_null(), None))
    return rounded


def write_npz(stream: BinaryIO, columns: Mapping[str, Column]) -> None:
    """Write columns as arrays of numpy; see `write_table`."""
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
    """Names as one unicode array; an error where one long name would make all of them long."""
    longest = max(map(len, names), default=0)
    if longest * len(names) > 2**20 + 8 * sum(map(len, names)):
        raise OutputError(f"{column}: a name of {longest} characters does not fit an .npz table; write .parquet")
    return np.array(names, dtype=np.str_)
