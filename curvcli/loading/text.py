"""Text of mesh files: lines and numbers, read column by column instead of line by line.

A tidy text has single blanks between tokens and none at either end of a line. Most files are tidy; the others are
tidied once (`tidy`) after the fast reader has failed (`Untidy`).
"""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..support.blocks import slices
from ..support.forks import threads_lost
from ..support.memory import require_polars

if TYPE_CHECKING:
    import polars as pl

BLANK, NEWLINE = 32, 10
_BLANKS = bytes.maketrans(b"\0\t\v\f\x1c\x1d\x1e\x1f", b" " * 8)
_TOKEN_PER_LINE = bytes.maketrans(b" ", b"\n")
_BLOCK = 1 << 23
# NaN and infinity as Microsoft's C library writes them: the old forms, also cut to few digits, and the new ones.
_INFINITE = re.compile(rb"(?<![^ \n])([+-]?)1\.#INF0*(?=[ \n])")
_UNDEFINED = re.compile(rb"(?<![^ \n])[+-]?(?:1\.#(?:(?:IND|QNAN|SNAN)0*|J|IO|R|QO|QNB)|nan\((?:ind|snan)\))(?=[ \n])")
SMALL = 1 << 18
"""Texts up to this many bytes are read without polars: importing it would take longer than reading them."""


class Untidy(Exception):  # noqa: N818 - a signal between readers, not a failure
    """Failure of the fast reader on untidy text; in a tidy text `row` (from 0) is malformed."""

    def __init__(self, row: int = 0, token: bytes = b""):
        self.row, self.token = row, token
        super().__init__(row, token)


@dataclass(frozen=True)
class Records:
    """Rows of numbers: `columns` if all have the same size, else `values`, concatenated.

    sizes: numbers per row, one int for all or (rows,) int64.
    """

    sizes: int | NDArray[np.int64]
    columns: list[NDArray[Any]] | None = None
    values: NDArray[Any] | None = None

    def flat(self) -> NDArray[Any]:
        """All numbers, one row after the other."""
        if self.values is not None:
            return self.values
        assert self.columns is not None
        rows = np.empty((len(self.columns[0]), len(self.columns)), self.columns[0].dtype)
        for k, column in enumerate(self.columns):
            rows[:, k] = column
        return rows.reshape(-1)


def decode(text: bytes) -> str:
    """Decode UTF-8, or Latin-1 if the bytes are no UTF-8."""
    try:
        return text.decode("utf-8")
    except UnicodeDecodeError:
        return text.decode("latin-1")


def plain_lines(data: bytes) -> bytes:
    """Normalise a text: no byte-order mark, LF line ends (also at the end), blanks as the only white space.

    The NaN and infinity of a C library become `nan` and `inf`, since their `#` would begin a comment.
    """
    if data.startswith(b"\xef\xbb\xbf"):
        data = data[3:]
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n")
        data = data.replace(b"\r", b"\n") if b"\r" in data else data
    if any(byte in data for byte in (b"\t", b"\0", b"\v", b"\f")):
        data = data.translate(_BLANKS)
    data = data if data.endswith(b"\n") else data + b"\n"
    # The search for a byte is twenty times faster than for a word, and few files have these behind their head.
    if data.find(b"1.#", 0, data.rfind(b"#") + 1) >= 0 or (b"(" in data and (b"(ind)" in data or b"(snan)" in data)):
        data = _UNDEFINED.sub(b"nan", _INFINITE.sub(rb"\1inf", data))
    return data


def tidy(data: bytes) -> bytes:
    """Reduce blanks to one between tokens and none at the ends of a line."""
    text = np.frombuffer(data, np.uint8)
    blocks: list[memoryview] = []
    last = NEWLINE
    for begin in range(0, len(text), _BLOCK):
        block, following = text[begin : begin + _BLOCK], text[begin + 1 : begin + _BLOCK + 1]
        keep = block != BLANK
        keep[: len(following)] |= ~separates(following)
        block = block[keep]
        if not len(block):
            continue
        indent = block == BLANK
        indent[1:] &= block[:-1] == NEWLINE
        indent[0] &= last == NEWLINE
        last = int(block[-1])
        blocks.append((block[~indent] if indent.any() else block).data)
    return b"".join(blocks)


def without_comments(data: bytes, *, but_in: bytes = b"") -> bytes:
    """Replace comments by blanks: from a `#` at the start of a word, or anywhere in a record of numbers.

    but_in: first letters of lines without comments.
    """
    text = np.frombuffer(data, np.uint8).copy()
    starts = line_starts(text)
    marks = np.flatnonzero(text == ord("#"))
    line = np.searchsorted(starts, marks, side="right") - 1
    in_numbers = np.isin(text[starts[line]], np.frombuffer(b"vfl", np.uint8))
    begins = (text[np.maximum(marks, 1) - 1] <= BLANK) | (marks == 0) | in_numbers
    begins &= ~np.isin(text[starts[line]], np.frombuffer(but_in, np.uint8))
    line, which = np.unique(line[begins], return_index=True)
    inside = np.zeros(len(text), np.int8)
    inside[marks[begins][which]] = 1
    inside[starts[line + 1] - 1] -= 1
    text[np.cumsum(inside, dtype=np.int8).view(np.bool_)] = BLANK
    return bytes(text)


def drop_empty_lines(data: bytes) -> tuple[bytes, NDArray[np.int64]]:
    """The nonempty lines of a tidy text, and the former number (from 0) of each."""
    text = np.frombuffer(data, np.uint8)
    empty = text == NEWLINE
    ends = np.flatnonzero(empty)
    empty[1:] &= text[:-1] == NEWLINE
    return bytes(text[~empty]), np.flatnonzero(~empty[ends])


def separates(text: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Mask of the bytes that separate tokens in a tidy text."""
    ends: NDArray[np.bool_] = text == BLANK
    ends |= text == NEWLINE
    return ends


def _occurrences(text: NDArray[np.uint8], byte: int) -> int:
    return sum(int(np.count_nonzero(text[block] == byte)) for block in slices(len(text), _BLOCK))


def line_starts(text: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Offset of each line, and of the end of the text."""
    ends = (np.flatnonzero(text[block] == NEWLINE) + block.start for block in slices(len(text), _BLOCK))
    return np.concatenate([np.zeros(1, np.int64), *(end + 1 for end in ends)])


def pick_lines(data: bytes, starts: NDArray[np.int64], wanted: NDArray[np.bool_]) -> bytes:
    """The wanted lines, concatenated, with their line ends."""
    edges = np.flatnonzero(np.diff(wanted.view(np.int8), prepend=0, append=0))
    if len(edges) == 2 and edges[0] == 0 and edges[1] == len(wanted):
        return data
    if len(edges) <= 2048:
        bounds = starts[edges].tolist()
        return b"".join(data[a:b] for a, b in zip(bounds[::2], bounds[1::2], strict=True))
    return bytes(np.frombuffer(data, np.uint8)[: starts[-1]][np.repeat(wanted, np.diff(starts))])


def read_columns(
    data: bytes, columns: int, dtype: type[np.generic], *, skip: int = 0
) -> list[NDArray[np.generic]] | None:
    """Read lines of `skip` words and then `columns` numbers; None if any line differs.

    Decimal fractions are rounded correctly. dtype: np.float64 or np.int32.
    """
    text = np.frombuffer(data, np.uint8)
    rows = _occurrences(text, NEWLINE)
    blanks = columns + skip - 1
    if rows == 0 or _occurrences(text, BLANK) != rows * blanks or data.count(b" ", 0, data.index(b"\n")) != blanks:
        return None
    if len(data) <= SMALL or threads_lost():
        numbers, known = read_tokens(data, dtype)
        known = known.reshape(rows, -1)[:, skip:]
        return list(np.ascontiguousarray(numbers.reshape(rows, -1)[:, skip:].T)) if known.all() else None
    require_polars(len(data))
    import polars as pl

    kind = pl.Float64 if dtype is np.float64 else pl.Int32
    schema: dict[str, type[pl.DataType]] = {f"skip{k}": pl.String for k in range(skip)}
    schema |= {f"{k}": kind for k in range(columns)}
    table = _read_csv(data, schema, " ", range(skip, skip + columns))
    if len(table) != rows or any(column.null_count() for column in table):
        return None
    return [column.to_numpy() for column in table]


def read_records(data: bytes, dtype: type[np.generic]) -> Records:
    """Read the numbers of lines that each begin with one word.

    Errors: Untidy for anything but numbers behind that word, or for an untidy text.
    """
    width = len(data[: data.index(b"\n")].split()) - 1
    if 0 < width <= 16 and b"/" not in data[: data.index(b"\n")]:
        columns = read_columns(data, width, dtype, skip=1)
        if columns is not None:
            return Records(width, columns)
    numbers, known = read_tokens(data, dtype)
    names = np.flatnonzero(~known)
    text = np.frombuffer(data, np.uint8)
    rows = np.count_nonzero(text == NEWLINE)
    if len(names) != rows:
        separators = np.flatnonzero(separates(text))
        if len(numbers) != len(separators):
            raise Untidy
        firsts = np.concatenate(([0], np.flatnonzero(text[separators] == NEWLINE)[:-1] + 1))
        known[firsts] = True
        wrong = np.flatnonzero(~known)
        begin = separators[wrong[0] - 1] + 1
        row = int(np.searchsorted(firsts, wrong[0], side="right")) - 1
        raise Untidy(row, bytes(data[begin : separators[wrong[0]]][:40]))
    return Records(np.diff(names, append=len(known)) - 1, values=numbers[known])


def read_tokens(data: bytes, dtype: type[np.generic]) -> tuple[NDArray[np.generic], NDArray[np.bool_]]:
    """Read every token of a tidy text as a number, with a mask of the numbers.

    The part of an integer token behind a `/` is ignored.

    dtype: np.float64 or np.int32; an integer too large for its type is no number.
    """
    if len(data) <= SMALL:
        return _read_tokens_slowly(data, dtype)
    require_polars(len(data))
    import polars as pl

    kind = pl.Float64 if dtype is np.float64 else pl.Int32
    lines = data.translate(_TOKEN_PER_LINE)
    if threads_lost():
        return _cast(lines, dtype)
    column = _read_csv(lines, {"number": kind}, " " if dtype is np.float64 else "/", range(1))["number"]
    known = np.ones(len(column), np.bool_) if column.null_count() == 0 else column.is_not_null().to_numpy()
    return column.fill_null(0).to_numpy(), known


_BEHIND_SLASH = re.compile(rb"/[^\n]*")


def _cast(lines: bytes, dtype: type[np.generic]) -> tuple[NDArray[np.generic], NDArray[np.bool_]]:
    """`read_tokens` without the threads of polars: a cast of a single column needs none."""
    import polars as pl

    tokens = (lines if dtype is np.float64 else _BEHIND_SLASH.sub(b"", lines))[:-1].decode("latin-1").split("\n")
    column = pl.Series(tokens, dtype=pl.String).cast(pl.Float64 if dtype is np.float64 else pl.Int32, strict=False)
    numbers = column.to_numpy()
    known = np.ones(len(tokens), np.bool_)
    if column.null_count():
        undefined = np.flatnonzero(np.isnan(numbers))
        known[undefined] = [tokens[k].lower().lstrip("+-") == "nan" for k in undefined.tolist()]
        numbers = np.where(known, numbers, 0).astype(dtype)
    return numbers, known


_NUMBER = re.compile(rb"[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|(?:nan|inf|infinity))", re.IGNORECASE)
_INTEGER = re.compile(rb"[+-]?\d{1,10}")


def _read_tokens_slowly(data: bytes, dtype: type[np.generic]) -> tuple[NDArray[np.generic], NDArray[np.bool_]]:
    tokens = data[:-1].translate(_TOKEN_PER_LINE).split(b"\n")
    numbers = np.zeros(len(tokens), dtype)
    known = np.zeros(len(tokens), np.bool_)
    pattern, convert = (_NUMBER, float) if dtype is np.float64 else (_INTEGER, int)
    for k, token in enumerate(tokens):
        head = token if dtype is np.float64 else token.partition(b"/")[0]
        if pattern.fullmatch(head):
            value = convert(head)
            if dtype is np.float64 or -(2**31) <= value < 2**31:
                numbers[k] = value
                known[k] = True
    return numbers, known


def _read_csv(data: bytes, schema: Mapping[str, type[pl.DataType]], separator: str, columns: range) -> pl.DataFrame:
    import polars as pl

    return pl.read_csv(
        io.BytesIO(data),
        has_header=False,
        schema=schema,
        columns=list(columns),
        separator=separator,
        quote_char=None,
        encoding="utf8-lossy",
        ignore_errors=True,
        truncate_ragged_lines=True,
    )
